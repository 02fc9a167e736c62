#pragma once
// Forces of displacements that averaged gradients do not see, in the trials of an increment.
#include <vector>

#include "solver/halo/halo_exchange.hpp"
#include "solver/model/problem.hpp"
#include "solver/statics/elastic_stiffness.hpp"
#include "solver/statics/gradient_jumps.hpp"
#include "solver/strips/particle_strips.hpp"

namespace talus {

/// Their stiffness is a share of that which the material has left in a trial, |change of the deviatoric stress| / (2 mu |deviatoric strain|):
/// what yields is not held by it.
template <int D>
class JumpForces {
 public:
  /// Takes filled cells and their stiffness.  Collective.
  void set_stiffness(const Problem<D>& problem, const ElasticStiffness<D>& elastic);

  /// As GradientJumps<D>::for_each_cell().
  template <class F>
  void for_each_cell(F&& f) const
  {
    jumps_.for_each_cell(f);
  }
  /// Takes the stress of the particles in strips as that with which the increment begins.
  void begin(const Mesh<D>& mesh, const ParticleStrips<D>& strips);
  /// Takes the displacements of all nodes [m].
  void take(const Mesh<D>& mesh, const std::vector<Vec<D>>& u);
  /// Finds the forces at the nodes [N] for the stress that the particles in strips have by these displacements.  Collective.
  void find(const Problem<D>& problem, const ParticleStrips<D>& strips);

  std::vector<Vec<D>>& of_nodes() noexcept { return force_; }
  const Vec<D>& at(Index n) const noexcept { return force_[to_size(n)]; }

 private:
  void add_stress(const ParticleStrips<D>& strips, std::vector<Sym3>& of_cell) const;

  GradientJumps<D> jumps_;
  std::vector<Vec<D>> force_;  ///< by node
  // By cell, of its particles on this rank: sums of volume times shear modulus and, at the beginning, times stress [N m]; and which share of
  // their shear stiffness is left in the last trial.
  std::vector<Real> shear_, left_;
  std::vector<Sym3> stress_;
  HaloExchange cells_;
};

extern template class JumpForces<2>;
extern template class JumpForces<3>;

}  // namespace talus
