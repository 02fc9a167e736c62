#pragma once
// The ground of a mesh made from terrain, and the boundaries of its layers, for pictures and reports.
#include <array>
#include <optional>
#include <vector>

#include "mesh/geometry/outline.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// The rigid surfaces of a mesh made from terrain, and the outlines of its layers.
struct RigidGround {
  std::vector<Real> nodes;                      ///< 3 numbers per node [m]; only nodes that are used below
  std::vector<std::array<Index, 3>> triangles;  ///< 3-D: the rigid surface below the layers, and obstacles
  std::vector<Edge> lines;                      ///< 2-D: the rigid lines
  std::vector<Edge> layers;  ///< boundaries of layers: in 3-D the rim of the bottom of each, in 2-D the bottoms above the rigid line
};

/// Finds them by the names of groups in a mesh made from terrain (docs/guide/terrain.md): `base` and `obstacle:NAME` are rigid,
/// `layer:NAME:bottom` is the bottom of a layer.  Nothing for a mesh without the group `terrain` or without rigid surfaces.
template <int D>
std::optional<RigidGround> rigid_ground_of(const MeshData<D>& data);

}  // namespace talus
