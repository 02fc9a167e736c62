#include "app/run/cost_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/stop_watch.hpp"

namespace talus {

namespace {

/// Number of steps at the beginning of a stage that are not measured: they put particles in strips and touch memory for the first time.
constexpr std::int64_t trial_warm_up = 3;
/// Increments of a stage without inertia that are measured.
constexpr int increments_of_trial = 2;
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
    if (stage.equilibrium) {
      const int increments = std::min(stage.equilibrium->increments, increments_of_trial);
      stage.duration *= static_cast<Real>(increments) / static_cast<Real>(stage.equilibrium->increments);
      stage.equilibrium->increments = increments;
      stage.equilibrium->most_unbalanced.reset();
    } else {
      stage.duration = std::min(stage.duration, static_cast<Real>(wanted) * dt);
    }
    stage.residual.reset();  // all steps are made, in equilibrium or not
  }
  std::vector<Timed> timed(whole.size());
  StopWatch watch;
  RunCallbacks<D> callbacks{[&](const RunView<D>& view, RunEvent event) {
                              if (event != RunEvent::step_done && event != RunEvent::step_begins)
                                return;
                              Real seconds = 0;
                              watch.lap(seconds);
                              const auto number = static_cast<std::size_t>(view.state.stage.number);
                              const bool counts =
                                  whole[number].equilibrium || view.state.clock.step - view.state.stage.first_step > trial_warm_up;
                              if (event == RunEvent::step_begins || !counts)
                                return;
                              Timed& stage = timed[number];
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

template <int D>
Real passage_time(const Setup<D>& setup, const Vec<D>& up)
{
  Real low = std::numeric_limits<Real>::infinity(), high = -low, volume = 0, slowness = 0;
  for (std::size_t b = 0; b < setup.state.bodies.size(); ++b) {
    const Body& body = setup.state.bodies[b];
    Real of_body = 0;
    for (Index row = body.begin; row < body.end; ++row) {
      const auto p = static_cast<std::size_t>(row);
      const Real at = up.dot(setup.state.particles.x[p]);
      low = std::min(low, at), high = std::max(high, at);
      of_body += setup.state.particles.volume0[p];
    }
    volume += of_body;
    slowness += of_body > 0 ? of_body / setup.state.materials[b].law().wave_speed(Mat3::Identity()) : 0;
  }
  return volume > 0 ? (high - low) * slowness / volume : 0;
}

RestTime time_to_rest(const Stage& stage, Real passage)
{
  if (!stage.residual)
    return {stage.duration, stage.duration};
  // Of the usual time, measured: 0.36, 0.40, 0.48, 0.67 (slopes under K0, gravity at once above a tunnel), 0.57 (a column), 0.11 (a wide layer),
  // 1.75 (a water table that falls).
  constexpr Real quickest = 0.1, slowest = 2, passages_of_a_swing = 4;
  if (!(stage.damping > 0))
    return {std::min(stage.ramp, stage.duration), stage.duration};
  const Real swings = std::max(Real{1}, -std::log(*stage.residual) / (2 * stage.damping));
  const Real usual = swings * passages_of_a_swing * passage;
  return {std::min(stage.ramp + quickest * usual, stage.duration), std::min(stage.ramp + slowest * usual, stage.duration)};
}

template Real passage_time<2>(const Setup<2>&, const Vec<2>&);
template Real passage_time<3>(const Setup<3>&, const Vec<3>&);

}  // namespace talus
