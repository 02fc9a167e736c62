#pragma once
// Rasters in files.
#include <filesystem>
#include <string>
#include <vector>

#include "mesh/geometry/raster.hpp"

namespace talus {

/// The first band of a raster of a format that is named in docs/reference/terrain_files.md.  `crs` and `unit` stay empty where the file says nothing;
/// no-data is NaN.  Nothing is judged but what a Raster cannot hold, such as rotated axes.  EnvironmentError names the file; SceneErrors: words
/// among the numbers of an ESRI ASCII grid.  `passed_over`, if given: what of the file has no place in the raster, one sentence each.
Raster read_raster(const std::filesystem::path& file, std::vector<std::string>* passed_over = nullptr);

/// By the extension: .tif (GeoTIFF, float32, compressed), .asc (ESRI ASCII grid, with a .prj beside it where the coordinate system is known;
/// its cells are squares) or .csv (x, y of the centre, value; cells without a value are left out).  The file is there as a whole or as it was.
void write_raster(const std::filesystem::path& file, const Raster& raster);

}  // namespace talus
