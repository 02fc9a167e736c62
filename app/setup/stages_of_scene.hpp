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

extern template void set_stages<2>(const Scene&, SceneErrorCollector&, Setup<2>&);
extern template void set_stages<3>(const Scene&, SceneErrorCollector&, Setup<3>&);
extern template void check_room<2>(const Scene&, const Mesh<2>&, const Setup<2>&, Communicator&, SceneErrorCollector&);
extern template void check_room<3>(const Scene&, const Mesh<3>&, const Setup<3>&, Communicator&, SceneErrorCollector&);
extern template void set_changes<2>(const Scene&, const Mesh<2>&, Communicator&, Setup<2>&);
extern template void set_changes<3>(const Scene&, const Mesh<3>&, Communicator&, Setup<3>&);

}  // namespace talus
