#pragma once
// Forces against displacements that averaged gradients do not see, in the trials of an increment.
#include <vector>

#include "solver/halo/halo_exchange.hpp"
#include "solver/model/problem.hpp"
#include "solver/statics/elastic_stiffness.hpp"
#include "solver/stress/jump_stress.hpp"

namespace talus {

/// Particles have a stress q [Pa] that acts on the jumps J_c of their cell, see GradientJumps.  In an increment with the displacements u
///
///     q <- rho R ( q + k mu J_c(u) ) R^T,     rho = min(1, |s| / |s_0 + 2 mu e|),
///
/// with the shear modulus mu, the rotation R and the deviatoric strain e = dev(U - 1) of the polar decomposition R U of the mean
/// deformation of the particles of the cell, and their mean deviatoric stress s_0 before, s after.  So it is elastic where the material is,
/// and where this yields it relaxes as the deviatoric stress does.  The least rho of the cells with which a cell has a node is its own: beside
/// soil that yields, stronger material would else hold it.  Empty cells beside the surface have such a stress as well, with the stiffness of
/// the material around them and the rotation of their own gradient.  It supports nodes beyond the surface, so it is elastic in the balance
/// of an increment, and relaxes behind it: where soil at the surface yields, Newton's method would else find no equilibrium.
///
/// Where q is not kept, it begins with zero in each increment, and rho is the mean around the cell of the share of the shear stiffness that
/// the material has left in it, twice |change of s| / (2 mu |e|), from 1/4 to 1.
template <int D>
class JumpForces {
 public:
  /// Takes filled cells and their stiffness, and whether q is kept from one increment to the next.  Collective.
  void set_stiffness(const Problem<D>& problem, const ElasticStiffness<D>& elastic, bool keeps_stress);

  /// Calls f(cell, volume times stiffness [N m]) for the cells that have one, all as if they were full.
  template <class F>
  void for_each_cell(const Mesh<D>& mesh, F&& f) const
  {
    for (const auto& one : jumps_.cells())
      f(one.cell, mesh.volume(one.cell) * one.modulus);
  }
  /// Takes the stress of the particles in strips and of empty cells as that with which the increment begins.
  void take_start(const Problem<D>& problem, const ParticleStrips<D>& strips, const EmptyCellStress<D>& of_empty);
  /// Takes the displacements of all nodes [m].
  void take_displacements(const Mesh<D>& mesh, const std::vector<Vec<D>>& u) { jumps_.find(mesh, u); }
  /// Takes the stress that the particles in strips have by these displacements, still in the cells in which they were at the beginning.
  /// Collective.
  void take_stress(const Problem<D>& problem, const ParticleStrips<D>& strips);
  /// Gives the particles, in the cells in which they were at the beginning, and empty cells the stress q at the end.  Collective.
  void store(const Problem<D>& problem, ParticleStrips<D>& strips, EmptyCellStress<D>& of_empty);

  /// Forces at all nodes [N]: of q at the beginning of the increment; at its end, in the balance; and behind it.  Collective.
  enum class At : std::uint8_t { start, end, behind };
  std::vector<Vec<D>> find(const Problem<D>& problem, At at);

 private:
  void find_left(Index c);
  void take_left_of_neighbours(const Problem<D>& problem);
  bool is_empty(Index cell) const noexcept { return !(before_.volume[to_size(cell)] > 0); }
  Mat<D> stress_in(const Mesh<D>& mesh, Index cell, At at) const;
  void exchange(const Problem<D>& problem, std::vector<Mat<D>>& by_cell);

  GradientJumps<D> jumps_;
  std::vector<Real> shear_;  ///< by cell: volume times shear modulus of its particles at the beginning [N m]
  JumpSums<D> before_, now_;
  std::vector<Mat<D>> of_empty_;  ///< by cell without particles: q at the beginning [Pa]
  std::vector<Real> left_;        ///< by cell: rho
  std::vector<Mat<D>> turned_;    ///< by cell: R
  std::vector<Mat<D>> of_jump_;   ///< by cell: k mu J [Pa]
  bool keeps_stress_ = true;
  HaloExchange cells_;
};

extern template class JumpForces<2>;
extern template class JumpForces<3>;

}  // namespace talus
