#pragma once
// Surfaces of rigid bodies for ParaView and pictures.
#include "app/observers/frame.hpp"

namespace talus {

/// Triangles of all rigid bodies where they are now: in 2-D they fill the bodies, in 3-D they are their surfaces.  Each corner has the
/// number of its body in the scene, and its velocity.
template <int D>
Frame::MeshFile rigid_of_frame(const RunView<D>& view, std::filesystem::path file);

}  // namespace talus
