#pragma once
// The elastic stiffness of the filled part of cells, with linear shape functions: what the equations of equilibrium are preconditioned
// with.
#include <utility>
#include <vector>

#include "solver/model/problem.hpp"
#include "solver/model/state.hpp"
#include "solver/statics/unknowns.hpp"

namespace talus {

/// In the plane, where a body averages its volume and hardly changes it, the part of Lame's first constant is that of the dilatation
/// averaged around nodes, as in AveragedBodies: the energy of a displacement is sum_v Lambda_v theta_v^2 / 2, with
/// Lambda_v = sum_c Lambda_c / (D + 1) over the cells c around the node v, Lambda_c their filled volume V_c times the constant, and
///     theta_v = sum_c V_c div_c / sum_c V_c                                     where gradients are those of cells,
///     theta_v = sum_c V_c mean_c / sum_c V_c,  mean_c = sum_u (1 + [u = v]) div_u / (D + 2),   where they are averages at the nodes u.
/// The sums are over the cells of this rank.  The dilatation of single cells would lock: with Poisson's ratio 0.499 Cook's membrane takes six
/// times the iterations.
template <int D>
class ElasticStiffness {
 public:
  ElasticStiffness() = default;
  /// Of the particles in the columns of a state.  Of the laws it knows the wave speed and the shear modulus at rest.
  ElasticStiffness(const Mesh<D>& mesh, const State<D>& state, bool averages_gradients);

  /// Gives a cell at least that shear stiffness, volume times modulus [N m], with Poisson's ratio 0.  Cells that are empty or hardly filled
  /// need it: nodes beyond them have a stiffness by the kernel and by GradientJumps, and a cell that hangs at the others by one node would
  /// turn freely.  Unlike a stiffness of single nodes it leaves the body free to turn, as a beam does that bends.
  void support(Index cell, Real shear)
  {
    if (const Real missing = shear - shear_[to_size(cell)]; missing > 0)
      shear_[to_size(cell)] += missing, wave_[to_size(cell)] += 2 * missing;
  }

  /// By cell, of this rank: filled volume [m^D], and this times the shear modulus [N m].
  const std::vector<Real>& filled() const noexcept { return filled_; }
  const std::vector<Real>& shear() const noexcept { return shear_; }

  /// The mean diagonal of each node with unknowns [N/m], at least a small share of the largest, and what to add to that of the cells: all
  /// of it at a node without a cell that has a stiffness, else nothing.  Collective.
  struct OfNode {
    Real all, beyond;
  };
  std::vector<OfNode> of_nodes(const Problem<D>& problem, const Unknowns<D>& unknowns) const;

  /// Calls f(i, j, K_ij) for pairs of nodes; a pair may come more than once.
  template <class F>
  void for_each_block(const Mesh<D>& mesh, F&& f) const
  {
    for (Index c = 0; c < mesh.n_cells(); ++c) {
      const Real wave = wave_[to_size(c)], shear = shear_[to_size(c)];
      const auto& g = mesh.gradients(c);
      if (wave > 0)
        for (std::size_t a = 0; a <= D; ++a)
          for (std::size_t b = 0; b <= D; ++b)
            f(mesh.cell(c)[a], mesh.cell(c)[b],
              Mat<D>((wave - 2 * shear) * g[a] * g[b].transpose() +
                     shear * (g[b] * g[a].transpose() + g[a].dot(g[b]) * Mat<D>::Identity())));
    }
    std::vector<std::pair<Index, Vec<D>>> dilatation;  // derivatives of theta_v
    for (Index v = 0; v < mesh.n_nodes(); ++v)
      if (const Real stiffness = dilatation_around(mesh, v, dilatation); stiffness > 0)
        for (const auto& [i, at_i] : dilatation)
          for (const auto& [j, at_j] : dilatation)
            f(i, j, Mat<D>(stiffness * at_i * at_j.transpose()));
  }

 private:
  /// Sets the derivatives of theta_v [1/m] by the displacements of the nodes around v; returns Lambda_v [N m].
  Real dilatation_around(const Mesh<D>& mesh, Index v, std::vector<std::pair<Index, Vec<D>>>& derivatives) const;

  std::vector<Real> filled_, wave_, shear_;  ///< wave_: volume times P-wave modulus, less what is in averaged_ [N m]
  std::vector<Real> averaged_;               ///< Lambda_c [N m]
  std::vector<Vec<D>> gradients_;  ///< averaged_gradients() [1/m]; empty where gradients are those of cells, or nothing is averaged
};

extern template class ElasticStiffness<2>;
extern template class ElasticStiffness<3>;

}  // namespace talus
