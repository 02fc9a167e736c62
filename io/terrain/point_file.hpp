#pragma once
// Points x, y, z in text files: surveys, digitised contours, terrain as a list.
#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "mesh/geometry/raster.hpp"

namespace talus {

/// Reads one point per line, its first three numbers, separated by commas, semicolons, tabs or blanks; a first line of words is a heading,
/// `#` begins a comment.  Throws SceneErrors with the lines that are none of these, EnvironmentError if the file cannot be read.
std::vector<std::array<Real, 3>> read_points(const std::filesystem::path& file);

/// The raster of points on a regular grid, a common form of terrain data; NaN where the grid has no point.  Nothing if the points are not
/// on such a grid.
std::optional<Raster> as_raster(const std::vector<std::array<Real, 3>>& points);

}  // namespace talus
