#include "solver/statics/jump_forces.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

/// Of the shear stiffness, that of displacements that averaged gradients do not see.  With less they alternate, with more it carries a part
/// of a limit load (docs/theory/statics.md, benchmarks/equilibrium).
constexpr Real stiffness_of_jumps = 0.1;
/// Of this, what it has at least where the material yields.
constexpr Real least_left = 0.25;

template <int D>
void JumpForces<D>::set_stiffness(const Problem<D>& problem, const ElasticStiffness<D>& elastic)
{
  shear_ = elastic.shear();
  std::vector<Real> filled = elastic.filled(), shear = shear_;
  if (!problem.subdomain.alone()) {
    cells_ = copies_of_cells(*problem.ranks, problem.subdomain, MessageTag::cells, problem.mesh.n_cells());
    for (std::vector<Real>* const values : {&filled, &shear}) {
      cells_.send(*values, Numbers{});
      cells_.take(*values, Numbers{});
    }
  }
  for (Real& one : shear)
    one *= stiffness_of_jumps;
  jumps_ = GradientJumps<D>(problem.mesh, filled, shear);
}

/// Adds volume times stress of particles, by the cells in which a trial finds them.
template <int D>
void JumpForces<D>::add_stress(const ParticleStrips<D>& strips, std::vector<Sym3>& of_cell) const
{
  for (std::size_t key = 0; key < strips.keys(); ++key)
    for (std::size_t s = 0; s < strips.strips(key).size(); ++s) {
      const Strip& strip = strips.strips(key)[s];
      const StripColumns<D> columns = strips.columns(strip);
      std::size_t i = 0;
      for (Index k = 0; k < strip_cells; ++k)
        for (Index left = strip.count[to_size(k)]; left > 0; --left, ++i)
          of_cell[to_size(strips.first_cell(key, static_cast<Index>(s)) + k)] += columns.volume.of(i) * columns.stress.of(i);
    }
}

template <int D>
void JumpForces<D>::begin(const Mesh<D>& mesh, const ParticleStrips<D>& strips)
{
  stress_.assign(to_size(mesh.n_cells()), Sym3::Zero());
  add_stress(strips, stress_);
}

template <int D>
void JumpForces<D>::take(const Mesh<D>& mesh, const std::vector<Vec<D>>& u)
{
  jumps_.find_gradients(mesh, u);
}

template <int D>
void JumpForces<D>::find(const Problem<D>& problem, const ParticleStrips<D>& strips)
{
  const Mesh<D>& mesh = problem.mesh;
  std::vector<Sym3> stress(to_size(mesh.n_cells()), Sym3::Zero());
  add_stress(strips, stress);
  const auto size_of_deviator = [](Sym3 of) {
    of.template head<3>().array() -= of.template head<3>().sum() / 3;
    return std::sqrt(of.template head<3>().squaredNorm() + 2 * of.template tail<3>().squaredNorm());
  };
  left_.assign(stress.size(), 1);
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    const Real shear = shear_[to_size(c)];
    if (!(shear > 0))
      continue;
    Mat3 gradient = Mat3::Zero();
    gradient.template topLeftCorner<D, D>() = jumps_.seen_in(mesh, c);
    const Mat3 strain = (gradient + gradient.transpose()) / 2;
    const Real elastic = 2 * shear * (strain - strain.trace() / 3 * Mat3::Identity()).norm();
    const Real found = size_of_deviator(stress[to_size(c)] - stress_[to_size(c)]);
    if (2 * found < elastic)  // means over cells differ, also where it is elastic
      left_[to_size(c)] = std::max(2 * found / elastic, least_left);
  }
  if (!problem.subdomain.alone()) {
    cells_.send(left_, Numbers{});
    cells_.take(left_, Numbers{});
  }
  force_.assign(to_size(mesh.n_nodes()), Vec<D>::Zero());
  jumps_.add_forces(mesh, left_, force_);
}

template class JumpForces<2>;
template class JumpForces<3>;

}  // namespace talus
