#pragma once
// Value stencils of node operators: the weights of the unknowns of a ring in the linear shape function of its node.
#include "mesh/mesh.hpp"

namespace talus {

/// Rows of maximum entropy, and the nodes without such a row.
struct MaxentValues {
  std::vector<Real> S;  ///< rows on the entries of mesh.ring_of_node()
  /// Nodes whose row is the node itself, because no positive weights are exact for linear fields; treated as corners, ascending.
  std::vector<Index> as_corners;
};

/// Weights of maximum entropy relative to the prior a (1 for the node itself, `alpha` for its neighbours) under sum S_nv (x_v - x_n) = 0
/// [Sukumar 2004; Arroyo & Ortiz 2006, doi 10.1002/nme.1534, here at nodes]: S_nv = a_v exp(lambda . (x_v - x_n)) / Z.  Positive, and exact
/// for linear fields at every interior node.
///
/// At the boundary of the mesh all neighbours lie on one side, and the only positive weights that are exact along the normal are those of
/// nodes on the wall.  So the row of such a node contains nodes on the wall only: in its face, along its edge, or the node itself in a
/// corner.  With weights of interior nodes, values would be read and passed on at positions off the wall, which an affine transfer
/// amplifies from step to step (measured: by 1e8 in 500 steps where the side of the mesh is free).
///
/// On curved and creased boundaries the neighbours on the wall may all lie on one side of a node, and then there are no such weights.  This
/// node is treated as a corner: its row is the node itself, S_nn = 1, the plain linear shape function.  It is positive, sums to one and is
/// exact for linear fields, but does not average.
template <int D>
MaxentValues maxent_values(const Mesh<D>& mesh, Real alpha);

}  // namespace talus
