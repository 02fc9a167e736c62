#pragma once
// Value stencils of a node part: with which weights the hat of a node stands for the unknowns of its ring.
#include "mesh/mesh.hpp"

namespace talus {

/// S = I, for a kernel whose cell part has values of its own.
template <int D>
std::vector<Real> identity_values(const Mesh<D>& mesh);

/// The lumped L2 projection on hats, S_nv = int N_n N_v dx / V_n.  Positive everywhere; linear fields are exact only where the
/// star of the node is symmetric.
template <int D>
std::vector<Real> l2_values(const Mesh<D>& mesh);

/// Moving least squares at the node over its ring, with sample weight 1 for the node itself and `alpha` for its neighbours.  Linear
/// fields are exact everywhere; weights turn negative at the boundary of the mesh.
template <int D>
std::vector<Real> mls_values(const Mesh<D>& mesh, Real alpha);

/// Weights of largest entropy about the prior a (1 for the node itself, `alpha` for its neighbours) under sum S_nv (x_v - x_n) = 0
/// [Sukumar 2004; Arroyo & Ortiz 2006, doi 10.1002/nme.1534, here at nodes]: S_nv = a_v exp(lambda . (x_v - x_n)) / Z.  Positive, and
/// exact for linear fields at every interior node.
///
/// At the boundary of the mesh all neighbours lie on one side, and no positive weights but the node's own are exact along the normal.
/// There the condition holds along the wall only (in 3-D along a face or an edge; not at all in a corner), and neighbours inside get the
/// prior `wall_share` alpha: without any, a film on the wall would have mass at the wall's nodes alone and force beside them too.
/// Throws std::invalid_argument naming node and place where the iteration ends without the answer.
template <int D>
std::vector<Real> maxent_values(const Mesh<D>& mesh, Real alpha, Real wall_share);

}  // namespace talus
