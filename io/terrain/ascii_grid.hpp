#pragma once
// The text of an ESRI ASCII grid, looked at before GDAL reads it: GDAL takes a word for the elevation 0 and passes over what it does not need.
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

/// Whether the file begins with a key of an ESRI ASCII grid, as GDAL finds out; the name does not matter.  False if it cannot be opened.
bool is_ascii_grid(const std::filesystem::path& file);

/// What is passed over in the file, one sentence each, such as values after the last row.  SceneErrors: what is no number, with line and
/// column.  "nan" and "inf" are numbers here: they are cells without a value.
std::vector<std::string> check_ascii_grid(const std::filesystem::path& file);

}  // namespace talus
