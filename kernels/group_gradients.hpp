#pragma once
// Averaged gradients of the bodies of one material at a node whose cells hold several materials.
#include <span>
#include <vector>

#include "mesh/mesh.hpp"

namespace talus {

/// The shares phi_cb of the groups of particles b in the cells c around one node n, by proportional fitting [Deming & Stephan 1940], from
/// w_cb = sum N_n V_p over the particles of group b in cell c [m^D]:
///
///     sum_b phi_cb = 1 in each cell with particles          sum_c phi_cb |c| / (D + 1) proportional to sum_c w_cb over these cells
///
/// The first holds exactly, so that a uniform gradient is that of all groups together; the second, up to what the sweeps leave, makes a
/// uniform stress pull at no node.  Cells without particles have phi = 1 for all groups, as a free surface has.
///
/// `w` has the groups of a cell side by side, cell by cell in the order of mesh.cells_of_node(), and becomes phi.
template <int D>
void fit_shares(const Mesh<D>& mesh, Index node, std::size_t groups, std::span<Real> w);

/// Gradients [1/m] of the linear shape functions averaged over what a group fills around node n, on the entries of mesh.ring_of_node():
///
///     D^b_nv = sum_c phi_cb |c| grad N_v / sum_c phi_cb |c|
///
/// The row of each group sums to zero and gives the slope of linear fields exactly.  With a single group it is averaged_gradients().  At a
/// boundary of cells between two materials it is one-sided, as beside a wall of the mesh.  Rows of groups without particles are not to be used.
/// `rows` has the entries of the ring side by side, group by group.
template <int D>
void group_gradients(const Mesh<D>& mesh, Index node, std::size_t groups, std::span<const Real> shares, std::span<Vec<D>> rows);

}  // namespace talus
