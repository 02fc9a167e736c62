#pragma once
// Surfaces through points of the plan, each with an elevation.
#include <array>
#include <string>
#include <vector>

#include "io/terrain/surface_file.hpp"

namespace talus {

MapBox extent_of(const std::vector<std::array<Real, 3>>& points);

/// Several points at one place of the plan become one, of their mean elevation.  How many went.
Index merge_places(std::vector<std::array<Real, 3>>& points);
/// A sentence on them.
std::string merged_in_words(Index merged);

/// Linear over Delaunay's triangles; nothing: the points lie on a line.
std::optional<SurfaceRead> over_triangles(std::vector<std::array<Real, 3>> points);

/// The surface of the points that a scene gives.
std::optional<SurfaceRead> read_given_points(const SurfaceSpec& spec, const MapPlan& plan, std::vector<SceneError>& problems,
                                             std::vector<std::string>& repairs);

}  // namespace talus
