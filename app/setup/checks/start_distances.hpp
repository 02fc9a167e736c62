#pragma once
// Whether particles lie among the points of the table with which their body starts.
#include <optional>
#include <string>

#include "app/setup/checks/scene_error_collector.hpp"
#include "core/parallel/communicator.hpp"
#include "core/particles.hpp"
#include "mesh/geometry/linear_fit.hpp"

namespace talus {

/// The distance [m] of the particle of the body that is farthest from its nearest point.  Nothing, and an error, if particles are farther
/// than `reach` of the body or, without it, than that point looks for its own neighbours, or if all points lie on a line.  No plane is
/// fitted at a particle: far from the points there is none.  Every rank has to ask.
template <int D>
std::optional<Real> distance_from_points(const PointCloud<D>& cloud, const BodySpec& spec, const std::string& file, const Body& body,
                                         const Particles<D>& particles, Communicator& ranks, SceneErrorCollector& errors);

/// The position of the particle of the body with that number, "0.5, 1", on all ranks.  Every rank has to ask.
template <int D>
std::string place_of_particle(std::int64_t id, const Body& body, const Particles<D>& particles, Communicator& ranks);

}  // namespace talus
