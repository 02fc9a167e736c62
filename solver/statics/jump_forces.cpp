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
void JumpForces<D>::take_start(const Problem<D>& problem, const ParticleStrips<D>& strips, const EmptyCellStress<D>& of_empty)
{
  before_ = JumpSums<D>(problem.mesh, strips, true);
  of_empty_.assign(before_.volume.size(), Mat<D>::Zero());
  of_empty.for_each(problem.subdomain, [&](Index c, const Mat<D>& q) { of_empty_[to_size(c)] = q; });
}

template <int D>
void JumpForces<D>::take_stress(const Problem<D>& problem, const ParticleStrips<D>& strips)
{
  now_ = JumpSums<D>(problem.mesh, strips, true);
  left_.assign(now_.volume.size(), 1);
  turned_.assign(left_.size(), Mat<D>::Identity());
  of_jump_.assign(left_.size(), Mat<D>::Zero());
  for (const auto& one : jumps_.cells()) {
    if (!is_empty(one.cell)) {
      find_left(one.cell);
    } else {
      Mat3 f = Mat3::Identity();
      f.template topLeftCorner<D, D>() += one.gradient;
      turned_[to_size(one.cell)] = polar_rotation(f).template topLeftCorner<D, D>();
    }
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

/// Gives the cells of other ranks what these have found.
template <int D>
void JumpForces<D>::exchange(const Problem<D>& problem, std::vector<Mat<D>>& by_cell)
{
  if (problem.subdomain.alone())
    return;
  cells_.send(by_cell, Numbers{});
  cells_.take(by_cell, Numbers{});
}

template <int D>
void JumpForces<D>::store(const Problem<D>& problem, ParticleStrips<D>& strips, EmptyCellStress<D>& of_empty)
{
  const auto left = [&](std::size_t c, const Mat<D>& q) {
    return Mat<D>(left_[c] * turned_[c] * (q + of_jump_[c]) * turned_[c].transpose());
  };
  for_each_in_cells(strips, [&](Index cell, const StripColumns<D>& columns, std::size_t p) {
    columns.jump_stress.set(p, left(to_size(cell), columns.jump_stress.of(p)));
  });
  std::vector<Mat<D>> stress(left_.size(), Mat<D>::Zero());
  for (const auto& one : jumps_.cells())
    if (const auto c = to_size(one.cell); is_empty(one.cell))
      stress[c] = left(c, of_empty_[c]);
  exchange(problem, stress);
  of_empty.clear();
  for (Index c = 0; c < problem.mesh.n_cells(); ++c)
    if (!stress[to_size(c)].isZero(0))
      of_empty.add(problem.subdomain.alone() ? c : problem.subdomain.whole_cell(c), stress[to_size(c)]);
}

/// q of a cell, times its volume.
template <int D>
Mat<D> JumpForces<D>::stress_in(const Mesh<D>& mesh, Index cell, At at) const
{
  const auto c = to_size(cell);
  const Real empty = share_of_empty * mesh.volume(cell);
  if (at == At::start)
    return is_empty(cell) ? Mat<D>(empty * of_empty_[c]) : before_.in_cell(mesh, cell, before_.jump_stress[c]);
  const Real left = is_empty(cell) && keeps_stress_ && at == At::end ? 1 : left_[c];
  const Mat<D> q = is_empty(cell) ? Mat<D>(empty * (of_empty_[c] + of_jump_[c]))
                                  : now_.in_cell(mesh, cell, now_.jump_stress[c] + now_.volume[c] * of_jump_[c]);
  return left * turned_[c] * q * turned_[c].transpose();
}

template <int D>
std::vector<Vec<D>> JumpForces<D>::find(const Problem<D>& problem, At at)
{
  const Mesh<D>& mesh = problem.mesh;
  std::vector<Mat<D>> stress(to_size(mesh.n_cells()), Mat<D>::Zero());
  for (const auto& one : jumps_.cells())
    stress[to_size(one.cell)] = stress_in(mesh, one.cell, at);
  exchange(problem, stress);
  std::vector<Vec<D>> force(to_size(mesh.n_nodes()), Vec<D>::Zero());
  jumps_.add_forces(mesh, stress, force);
  return force;
}

template class JumpForces<2>;
template class JumpForces<3>;

}  // namespace talus
