#include "solver/statics/jump_forces.hpp"

#include "materials/parts/logarithm.hpp"

namespace talus {

/// Of the shear stiffness, that against jumps (docs/theory/statics.md, benchmarks/equilibrium).
constexpr Real stiffness_of_jumps = 0.1;
/// Of this, what is left at least in an increment where the material yields, if the stress begins anew in each.
constexpr Real least_left = 0.25;

namespace {

Real size_of_deviator(const Mat3& of) { return (of - of.trace() / 3 * Mat3::Identity()).norm(); }

}  // namespace

template <int D>
void JumpForces<D>::set_stiffness(const Problem<D>& problem, const ElasticStiffness<D>& elastic, bool keeps_stress)
{
  keeps_stress_ = keeps_stress;
  const Mesh<D>& mesh = problem.mesh;
  shear_ = elastic.shear();
  std::vector<Real> filled = elastic.filled(), shear = shear_;
  if (!problem.subdomain.alone()) {
    cells_ = copies_of_cells(*problem.ranks, problem.subdomain, MessageTag::cells, mesh.n_cells());
    for (std::vector<Real>* const values : {&filled, &shear}) {
      cells_.send(*values, Numbers{});
      cells_.take(*values, Numbers{});
    }
  }
  for (Real& one : shear)
    one *= stiffness_of_jumps;
  jumps_ = GradientJumps<D>(mesh, filled, shear);
}

/// Finds R of a cell, and its rho by its own particles.
template <int D>
void JumpForces<D>::find_left(Index c)
{
  const auto i = to_size(c);
  if (!(before_.volume[i] > 0) || !(shear_[i] > 0))
    return;
  const Mat3 f = now_.F[i] * before_.F[i].inverse(), R = polar_rotation(f), stretch = R.transpose() * f - Mat3::Identity();
  const Mat3 before = unpack(before_.stress[i] / before_.volume[i]), now = unpack(now_.stress[i] / now_.volume[i]);
  const Real elastic = size_of_deviator(before + 2 * shear_[i] / before_.volume[i] * stretch), found = size_of_deviator(now);
  left_[i] = found < elastic ? found / elastic : 1;
  if (!keeps_stress_) {
    const Real change = size_of_deviator(R.transpose() * now * R - before),
               of_elastic = 2 * shear_[i] / before_.volume[i] * size_of_deviator(stretch);
    left_[i] = 2 * change < of_elastic ? std::max(2 * change / of_elastic, least_left) : 1;  // means over cells differ
  }
  turned_[i] = R.template topLeftCorner<D, D>();
}

template <int D>
void JumpForces<D>::take_stress(const Problem<D>& problem, const ParticleStrips<D>& strips)
{
  now_ = JumpSums<D>(problem.mesh, strips, true);
  left_.assign(now_.volume.size(), 1);
  turned_.assign(left_.size(), Mat<D>::Identity());
  of_jump_.assign(left_.size(), Mat<D>::Zero());
  for (const auto& one : jumps_.cells()) {
    find_left(one.cell);
    of_jump_[to_size(one.cell)] = one.modulus * one.jump;
  }
  take_left_of_neighbours(problem);
}

/// Gives each cell the least rho of the cells with which it has a node; where the stress begins anew, the mean.
template <int D>
void JumpForces<D>::take_left_of_neighbours(const Problem<D>& problem)
{
  const Mesh<D>& mesh = problem.mesh;
  if (!problem.subdomain.alone()) {
    cells_.send(left_, Numbers{});
    cells_.take(left_, Numbers{});
  }
  if (!keeps_stress_) {
    std::vector<Real> volume = now_.volume, around(left_.size(), 1);
    if (!problem.subdomain.alone())
      cells_.send(volume, Numbers{}), cells_.take(volume, Numbers{});
    for (const auto& one : jumps_.cells()) {
      Real all = 0, left = 0;
      for (const Index n : mesh.cell(one.cell))
        for (const Index c : mesh.cells_of_node()[n])
          all += volume[to_size(c)], left += volume[to_size(c)] * left_[to_size(c)];
      if (all > 0)
        around[to_size(one.cell)] = left / all;
    }
    left_ = around;
    return;
  }
  std::vector<Real> at_node(to_size(mesh.n_nodes()), 1);
  for (const auto& one : jumps_.cells())
    for (const Index n : mesh.cell(one.cell))
      at_node[to_size(n)] = std::min(at_node[to_size(n)], left_[to_size(one.cell)]);
  for (const auto& one : jumps_.cells())
    for (const Index n : mesh.cell(one.cell))
      left_[to_size(one.cell)] = std::min(left_[to_size(one.cell)], at_node[to_size(n)]);
}

template <int D>
void JumpForces<D>::store(ParticleStrips<D>& strips) const
{
  for_each_in_cells(strips, [&](Index cell, const StripColumns<D>& columns, std::size_t p) {
    if (const std::size_t c = to_size(cell); columns.jump_stress)
      columns.jump_stress.set(p, left_[c] * turned_[c] * (columns.jump_stress.of(p) + of_jump_[c]) * turned_[c].transpose());
  });
}

template <int D>
std::vector<Vec<D>> JumpForces<D>::find(const Problem<D>& problem, std::initializer_list<Part> parts)
{
  const Mesh<D>& mesh = problem.mesh;
  std::vector<Mat<D>> stress(to_size(mesh.n_cells()), Mat<D>::Zero());
  for (const Part part : parts)
    for (const auto& one : jumps_.cells()) {
      const auto c = to_size(one.cell);
      if (part == Part::start)
        stress[c] += before_.in_cell(mesh, one.cell, before_.jump_stress[c]);
      else if (part == Part::empty_cells && now_.volume[c] == 0)
        stress[c] += share_of_empty * mesh.volume(one.cell) * (keeps_stress_ ? 1 : left_[c]) * of_jump_[c];
      else if (part == Part::particles && now_.volume[c] > 0)
        stress[c] += now_.in_cell(mesh, one.cell,
                                  left_[c] * turned_[c] * (now_.jump_stress[c] + now_.volume[c] * of_jump_[c]) * turned_[c].transpose());
    }
  if (!problem.subdomain.alone()) {
    cells_.send(stress, Numbers{});
    cells_.take(stress, Numbers{});
  }
  std::vector<Vec<D>> force(to_size(mesh.n_nodes()), Vec<D>::Zero());
  jumps_.add_forces(mesh, stress, force);
  return force;
}

template class JumpForces<2>;
template class JumpForces<3>;

}  // namespace talus
