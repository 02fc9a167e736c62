#pragma once
// Points x, y, z in text files: surveys, digitised contours, terrain as a list.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mesh/geometry/raster.hpp"

namespace talus {

/// One point a line, the first three numbers of it, between them commas, semicolons, tabs or blanks; a first line of words is a heading, `#`
/// begins a comment.  SceneErrors name the lines that are none of these; what cannot be read at all is an EnvironmentError.
std::vector<std::array<Real, 3>> read_points(const std::filesystem::path& file);

/// What points on a grid of equal spacing are, as which terrain is often handed on; NaN where the grid has no point.  Nothing: they are not.
std::optional<Raster> as_raster(const std::vector<std::array<Real, 3>>& points);

}  // namespace talus
