#pragma once
// The elastic stiffness of the filled part of cells, with linear shape functions: what the equations of equilibrium are preconditioned
// with.
#include <vector>

#include "solver/model/problem.hpp"
#include "solver/model/state.hpp"
#include "solver/statics/unknowns.hpp"

namespace talus {

template <int D>
class ElasticStiffness {
 public:
  ElasticStiffness() = default;
  /// Of the particles in the columns of a state.  Of the laws it knows the wave speed and the shear modulus at rest.
  ElasticStiffness(const Mesh<D>& mesh, const State<D>& state);

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

  /// Calls f(cell, a, b, K_ab) for the pairs of nodes of the cells with a stiffness, by their places in the cell.
  template <class F>
  void for_each_block(const Mesh<D>& mesh, F&& f) const
  {
    for (Index c = 0; c < mesh.n_cells(); ++c) {
      const Real wave = wave_[to_size(c)], shear = shear_[to_size(c)];
      const auto& g = mesh.gradients(c);
      if (wave > 0)
        for (std::size_t a = 0; a <= D; ++a)
          for (std::size_t b = 0; b <= D; ++b)
            f(c, a, b,
              Mat<D>((wave - 2 * shear) * g[a] * g[b].transpose() +
                     shear * (g[b] * g[a].transpose() + g[a].dot(g[b]) * Mat<D>::Identity())));
    }
  }

 private:
  std::vector<Real> filled_, wave_, shear_;  ///< wave_: volume times P-wave modulus [N m]
};

extern template class ElasticStiffness<2>;
extern template class ElasticStiffness<3>;

}  // namespace talus
