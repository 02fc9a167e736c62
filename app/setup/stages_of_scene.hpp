#pragma once
// The block `stages` of a scene -> stages, and what they change.
#include "app/setup/checks/scene_error_collector.hpp"
#include "app/setup/setup.hpp"

namespace talus {

/// How long stages take, and how each begins.
template <int D>
void set_stages(const Scene& scene, SceneErrorCollector& errors, Setup<D>& setup);

/// Whether the laws of bodies can do what stages want of them.
void check_laws(const Scene& scene, SceneErrorCollector& errors);

/// Bodies that come are not where others are, as far as it is known where these will be.  Every rank has to ask.
template <int D>
void check_room(const Scene& scene, const Mesh<D>& mesh, const Setup<D>& setup, Communicator& ranks, SceneErrorCollector& errors);

/// What the stages change, the bodies being there that appear later: these are taken away.  SceneErrors: a wall that cannot act in a later stage.
/// The same.
template <int D>
void set_changes(const Scene& scene, const Mesh<D>& mesh, Communicator& ranks, Setup<D>& setup);

}  // namespace talus
