#pragma once
// The velocity that a scene gives a body at the start.
#include "app/setup/checks/scene_error_collector.hpp"
#include "core/parallel/communicator.hpp"
#include "core/particles.hpp"
#include "io/scene/scene.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// Velocity and its gradient of the particles [begin, end): without the latter, affine schemes would begin with particles that do not turn.
/// Complains about formulas.  Every rank has to ask.
template <int D>
void set_velocity(const BodySpec& spec, const Mesh<D>& mesh, Communicator& ranks, Index begin, Index end, SceneErrorCollector& errors,
                  Particles<D>& particles);

}  // namespace talus
