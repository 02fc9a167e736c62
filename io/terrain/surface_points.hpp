#pragma once
// Surfaces through points of the plan with elevations.
#include <array>
#include <string>
#include <vector>

#include "io/terrain/surface_file.hpp"

namespace talus {

MapBox extent_of(const std::vector<std::array<Real, 3>>& points);

/// Replaces several points at one position of the plan by one with their mean elevation.  Returns the number of removed points.
Index merge_places(std::vector<std::array<Real, 3>>& points);
/// A sentence with the number of removed points.
std::string merged_in_words(Index merged);

/// Linear interpolation over Delaunay triangles; nothing if the points lie on a line.
std::optional<SurfaceRead> over_triangles(std::vector<std::array<Real, 3>> points);

/// The surface through the points of a scene.
std::optional<SurfaceRead> read_given_points(const SurfaceSpec& spec, const MapPlan& plan, std::vector<SceneError>& problems,
                                             std::vector<std::string>& repairs);

}  // namespace talus
