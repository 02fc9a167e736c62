#include "app/run/cost_estimate.hpp"
#include "core/stop_watch.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace talus {

namespace {

/// Number of steps at the beginning of a stage that are not measured: they sort particles and touch memory for the first time.
constexpr std::int64_t trial_warm_up = 3;
/// Particle-steps of a trial, which take some seconds on a core, and limits of its number of steps.
constexpr std::int64_t trial_particle_steps = 2'000'000, fewest_trial_steps = 8, most_trial_steps = 200;

struct Timed {
  std::vector<Real> seconds;  // durations of steps after the warm-up [s]
  Real time = 0;              // simulated time of these steps [s]
};

StageTrial trial_of(const Stage& stage, std::size_t number, Timed timed)
{
  std::vector<Real>& sorted = timed.seconds;
  std::sort(sorted.begin(), sorted.end());
  const auto at_share = [&](Real share) { return sorted[static_cast<std::size_t>(share * static_cast<Real>(sorted.size() - 1))]; };
  const auto made = static_cast<std::int64_t>(sorted.size());
  return {stage.name, number, timed.time / static_cast<Real>(made), at_share(0.25), at_share(0.5), at_share(0.75), made};
}

}  // namespace

template <int D>
std::vector<StageTrial> try_stages(const Scene& scene, Mesh<D> mesh, Setup<D> setup)
{
  const std::vector<Stage> whole = setup.stages;
  const std::int64_t wanted =
      trial_warm_up + std::clamp(trial_particle_steps / std::max<std::int64_t>(setup.n_particles, 1), fewest_trial_steps, most_trial_steps);
  const Real dt = first_step(mesh, setup);
  for (Stage& stage : setup.stages) {
    stage.duration = std::min(stage.duration, static_cast<Real>(wanted) * dt);
    stage.residual.reset();  // all steps are made, in equilibrium or not
  }
  std::vector<Timed> timed(whole.size());
  StopWatch watch;
  RunCallbacks<D> callbacks{[&](const RunView<D>& view, RunEvent event) {
                              if (event != RunEvent::step_done && event != RunEvent::step_begins)
                                return;
                              Real seconds = 0;
                              watch.lap(seconds);
                              const bool counts = view.state.clock.step - view.state.stage.first_step > trial_warm_up;
                              if (event == RunEvent::step_begins || !counts)
                                return;
                              Timed& stage = timed[static_cast<std::size_t>(view.state.stage.number)];
                              stage.seconds.push_back(seconds);
                              stage.time += view.state.clock.dt;
                            },
                            [](const RunView<D>&, const StageResult&) {}};
  std::optional<std::string> trouble;
  try {
    simulate(scene, std::move(mesh), std::move(setup), callbacks);
  } catch (const RunError& e) {
    trouble = e.what();
  }
  std::vector<StageTrial> trials;
  for (std::size_t s = 0; s < whole.size(); ++s)
    if (!timed[s].seconds.empty())
      trials.push_back(trial_of(whole[s], s, std::move(timed[s])));
  if (trials.empty() && trouble)
    throw RunError(*trouble);
  return trials;
}

template std::vector<StageTrial> try_stages<2>(const Scene&, Mesh<2>, Setup<2>);
template std::vector<StageTrial> try_stages<3>(const Scene&, Mesh<3>, Setup<3>);

}  // namespace talus
