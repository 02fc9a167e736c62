#pragma once
// Rasters in files.
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/geometry/raster.hpp"

namespace talus {

/// Reads the first band of a raster in a format of docs/reference/terrain_files.md.  `crs` and `unit` are empty if not in the file; no-data
/// is NaN.  Only properties that a Raster cannot have, such as rotated axes, are refused.  Throws EnvironmentError with the name of the
/// file, SceneErrors for words among the numbers of an ESRI ASCII grid.  `passed_over`, if given, receives the ignored parts of the file,
/// one sentence each.
Raster read_raster(const std::filesystem::path& file, std::vector<std::string>* passed_over = nullptr);

/// Writes a raster in the format of the extension: .tif (GeoTIFF, float32, compressed), .asc (ESRI ASCII grid with square cells, and a .prj
/// if the coordinate system is known) or .csv (x, y of the centre, value; without cells that have no value).  The file is written
/// atomically.
void write_raster(const std::filesystem::path& file, const Raster& raster);

}  // namespace talus
