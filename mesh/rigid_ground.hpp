#pragma once
// The ground of a mesh that was made of terrain, and where its layers end: for pictures and pages.
#include <array>
#include <optional>
#include <vector>

#include "mesh/geometry/outline.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// What is rigid in a mesh of terrain, and what lies on it.
struct RigidGround {
  std::vector<Real> nodes;                      ///< 3 numbers a node [m]; only nodes that are used below
  std::vector<std::array<Index, 3>> triangles;  ///< 3-D: the rigid surface below everything, and obstacles
  std::vector<Edge> lines;                      ///< 2-D: the same
  std::vector<Edge> layers;  ///< where layers end: in 3-D the rim of the bottom of each, in 2-D the bottoms above the rigid line
};

/// By the names that a mesh of terrain gives its groups (docs/guide/terrain.md): `base` and `obstacle:NAME` are rigid, `layer:NAME:bottom` is the
/// bottom of a layer.  Nothing for a mesh without the group `terrain`, or without anything rigid.
template <int D>
std::optional<RigidGround> rigid_ground_of(const MeshData<D>& data);

extern template std::optional<RigidGround> rigid_ground_of<2>(const MeshData<2>&);
extern template std::optional<RigidGround> rigid_ground_of<3>(const MeshData<3>&);

}  // namespace talus
