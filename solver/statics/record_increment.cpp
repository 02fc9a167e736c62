// How a solved increment becomes the state, with its balances.
#include "solver/state/integrate.hpp"
#include "solver/statics/load_increment.hpp"
#include "solver/statics/without_remap.hpp"
#include "solver/step/step_parts.hpp"

namespace talus {

/// What is out of balance at a node in the last trial [N], without forces of jumps that pass with it.  A boundary takes up a part of these by
/// its reaction.
template <int D>
Vec<D> LoadIncrement<D>::left_over(std::span<const Real> f, std::size_t k) const
{
  return -force_ * Eigen::Map<const Vec<D>>(f.data() + k * D) - free_[k] * passing_jump(unknowns_.node[k]);
}

/// Half of the work of loads, gravity and boundaries at the displacements, with forces as they are before these.  What is out of balance before
/// and behind an increment does work that nothing takes up; it counts as damping, also where friction took it up before.
template <int D>
void LoadIncrement<D>::record_work(std::span<const Real> x)
{
  const Real ramp = m_.state.stage.ramp(time_);
  const Vec<D> gravity = m_.problem.loads.gravity(time_, ramp);
  nodes().kick = dt_ / 2;
  add_work(m_.problem.loads, time_, ramp, m_.problem.own, nodes(), m_.work.sums.work_on_mesh);
  const std::vector<Vec<D>> jump_before = jump_forces_in_steps(At::start);
  for (std::size_t k = 0; k < unknowns_.node.size(); ++k) {
    const auto n = to_size(unknowns_.node[k]);
    NodeWork<D> of_node;
    const Vec<D> weight = nodes().sum[n].mass * gravity, u = displacement(x, k);
    of_node.gravity = weight.dot(u) / 2;
    const Vec<D> out_of_balance = nodes().sum[n].force + weight + jump_before[n], free = free_[k] * out_of_balance;
    of_node.damping = -free.dot(u) / 2;
    m_.work.sums.nodes.add(of_node);
    m_.work.sums.stress_at_nodes.add((jump_before[n] + jump_behind_[n]).dot(u) / 2);
    m_.work.sums.at_nodes.add({.moved = (free - out_of_balance).dot(u) / 2});
    if (!m_.problem.loads.on_surfaces.empty())
      m_.work.sums.work_on_mesh.add(surface_work(nodes(), unknowns_.node[k]));
  }
}

/// Loads on particles: their forces at the end, and their work by the mean of those at the beginning and at the end.
template <int D>
void LoadIncrement<D>::record_particle_loads()
{
  const ParticleStrips<D>& strips = *m_.work.strips;
  for (std::size_t key = 0; key < m_.work.load_sums.size(); ++key) {
    ParticleLoadSums<D> at_end;
    for (const Strip& strip : strips.strips(key)) {
      const StripColumns<D> columns = strips.columns(strip);
      at_end.add_forces(columns, to_size(strip.n));
      at_end.add_work(columns, to_size(strip.n));
    }
    at_end.work = (m_.work.load_sums[key].work + at_end.work) / 2;
    m_.work.load_sums[key] = at_end;
  }
}

/// The accelerations that the forces of the last trial would give, without those that move no particle and without forces of jumps that
/// pass with it.
template <int D>
void LoadIncrement<D>::find_net_acceleration(std::span<const Real> f)
{
  std::vector<Vec<D>>& felt = nodes().felt;
  felt.assign(nodes().sum.size(), Vec<D>::Zero());
  for (std::size_t k = 0; k < unknowns_.node.size(); ++k) {
    const auto n = to_size(unknowns_.node[k]);
    const Vec<D> net = left_over(f, k);
    if (nodes().sum[n].mass > 0)
      felt[n] = net / nodes().sum[n].mass;
  }
  m_.transfer->filter_acceleration(m_);
}

/// Makes a trial the state, with its balances.
template <int D>
void LoadIncrement<D>::accept(std::span<const Real> x)
{
  std::vector<Real> f(x.size());
  force_ = 1;
  find_residual(x, f);
  jump_behind_ = jump_forces_in_steps(At::behind);
  const std::vector<Mat<D>> free_before = free_;
  set_constraints();
  StepSums<D>& sums = m_.work.sums;
  BoundaryWork of_boundaries = sums.at_nodes.value();
  for (Real BoundaryWork::*const part : {&BoundaryWork::friction, &BoundaryWork::moved, &BoundaryWork::arrival})
    of_boundaries.*part /= 2;  // the other half is that of the reactions before
  const ExactSums<ForceAndMoment<D>> on_mesh = sums.on_mesh;
  const BoundaryConditions<D> boundary = m_.state.boundary;
  const Real end = time_ + dt_;
  const Vec<D> gravity = m_.problem.loads.gravity(end, m_.state.stage.ramp(end));
  find_net_acceleration(f);
  ExactSums<NodeWork<D>> at_end;
  ExactSums<Balance> balance;
  ExactSums<Real> work_on_mesh;
  for (std::size_t k = 0; k < unknowns_.node.size(); ++k) {
    const NodeSum<D>& sum = nodes().sum[to_size(unknowns_.node[k])];
    NodeWork<D> of_node;
    of_node.gravity = sum.mass * gravity.dot(displacement(x, k)) / 2;
    of_node.damping = -left_over(f, k).dot(displacement(x, k)) / 2;
    const Vec<D> held = force_ * Eigen::Map<const Vec<D>>(f.data() + k * D) + passing_jump(unknowns_.node[k]);
    of_node.damped = ForceAndMoment<D>::at(m_.problem.mesh.node(unknowns_.node[k]), dt_ * held);
    of_node.mass = sum.mass;
    of_node.first_moment = sum.mass * m_.problem.mesh.node(unknowns_.node[k]);
    at_end.add(of_node);
    balance.add({sum.mass * nodes().felt[to_size(unknowns_.node[k])].norm(), weight_[k].norm(), reaction_[k].norm()});
    nodes().motion[to_size(unknowns_.node[k])] = {.v = displacement(x, k) / dt_};
  }
  nodes().kick = dt_ / 2;
  add_work(m_.problem.loads, end, m_.state.stage.ramp(end), m_.problem.own, nodes(), work_on_mesh);
  if (!m_.problem.loads.on_surfaces.empty())
    for (const Index n : unknowns_.node)
      work_on_mesh.add(surface_work(nodes(), n));

  free_ = free_before;  // the work of the forces before
  move(x, Then::stay);
  record_particle_loads();
  m_.state.boundary = boundary;
  sums.at_nodes.add(of_boundaries);
  sums.on_mesh = on_mesh;
  sums.nodes.add(at_end), sums.work_on_mesh.add(work_on_mesh), sums.balance = balance;
  nodes().gravity = gravity, nodes().kick = dt_;
  record_particle_sums(m_);
  update_balances(m_);
  m_.state.energy.internal_ahead = m_.state.energy.loads_ahead = 0;
  {
    const WithoutRemap remap(m_.problem.transfer);
    end_sweeps(m_);
  }
  stop_particles(m_);
  m_.state.monitor.speed = 0;
  m_.state.clock = {.step = m_.state.clock.step + 1, .time = end, .dt = dt_, .lag = 0};
}

#define TALUS_INSTANTIATE(D)                                                             \
  template Vec<D> LoadIncrement<D>::left_over(std::span<const Real>, std::size_t) const; \
  template void LoadIncrement<D>::record_work(std::span<const Real>);                    \
  template void LoadIncrement<D>::record_particle_loads();                               \
  template void LoadIncrement<D>::find_net_acceleration(std::span<const Real>);          \
  template void LoadIncrement<D>::accept(std::span<const Real>);
TALUS_INSTANTIATE(2)
TALUS_INSTANTIATE(3)
#undef TALUS_INSTANTIATE

}  // namespace talus
