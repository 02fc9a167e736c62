#pragma once
// A check of the text of an ESRI ASCII grid before GDAL reads it: GDAL reads a word as the elevation 0 and ignores superfluous values.
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

/// Whether the file begins with a key of an ESRI ASCII grid, by the same test as GDAL's; the name does not matter.  False if it cannot be
/// opened.
bool is_ascii_grid(const std::filesystem::path& file);

/// The ignored parts of the file, one sentence each, such as values after the last row.  Throws SceneErrors with line and column for words
/// that are not numbers.  "nan" and "inf" are cells without a value.
std::vector<std::string> check_ascii_grid(const std::filesystem::path& file);

}  // namespace talus
