#include "solver/step/resample_step.hpp"

#include "solver/particles/resample.hpp"

namespace talus {

template <int D>
void resample_particles(Model<D>& m)
{
  const std::int64_t step = m.state.clock.step;
  std::vector<std::optional<ResampleOptions>> due = m.problem.resampling;
  for (std::optional<ResampleOptions>& body : due)
    if (body && step % body->every != 0)
      body.reset();
  if (!any_resampled(due))
    return;
  Communicator& ranks = *m.problem.ranks;
  copy_to_columns(m);
  State<D>& state = m.state;
  const ResamplePlan<D> plan =
      plan_resampling<D>(m.problem.mesh, m.problem.locator, due, m.work.carriers, state.bodies, state.particles, m.work.order);
  if (ranks.sum(static_cast<std::int64_t>(plan.size())) == 0) {
    drop_copy(m);
    return;
  }
  end_sweeps(m);
  ExactSums<ResampleSums<D>> sums;
  resample(plan, state.resampling.splits, ranks, state.bodies, state.materials, state.particles, sums);
  ranks.sum(sums);
  const ResampleSums<D> done = sums.value();
  state.resampling.splits += static_cast<std::int64_t>(done.splits);
  state.resampling.merges += static_cast<std::int64_t>(done.merges);
  state.energy.resampled += done.kinetic;
  state.momentum.changes += done.momentum;
  update_rows(m);
}

template void resample_particles(Model<2>&);
template void resample_particles(Model<3>&);

}  // namespace talus
