#include "solver/step/resample_step.hpp"

#include "solver/particles/resample.hpp"

namespace talus {

/// Particles by whose ids loads act, on particles or near a side of a body.
template <int D>
TrackedIds loaded_particles(const Model<D>& m)
{
  std::vector<std::int64_t> ids;
  const Loads<D>& loads = m.problem.loads;
  if (!m.work.carriers.empty() || !loads.on_surfaces.empty())
    for (const std::int64_t id : m.state.particles.id)
      if (m.work.carriers.place(id) ||
          std::ranges::any_of(loads.on_surfaces, [&](const SurfaceLoad<D>& load) { return load.near.place(id).has_value(); }))
        ids.push_back(id);
  return TrackedIds(std::move(ids));
}

template <int D>
void resample_particles(Model<D>& m)
{
  if (!any_resampled(m.problem.resampling))
    return;
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
      plan_resampling<D>(m.problem.mesh, m.problem.locator, due, loaded_particles(m), state.bodies, state.particles, m.work.order);
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
