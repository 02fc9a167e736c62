#pragma once
// Stages, the loop over steps, and what stops it.
#include <fmt/format.h>

#include "solver/instances.hpp"
#include "solver/run_limits.hpp"
#include "solver/stress/initial_stress.hpp"

namespace talus {

/// A phase of the analysis.
struct Stage {
  std::string name{};
  std::string kind = "run";  ///< or "geostatic"
  Real duration{};           ///< [s]
  Real damping{};
  Real ramp{};  ///< [s]
  RampShape ramp_shape = RampShape::linear;
  bool elastic = false;
  std::optional<Real> residual{};            ///< geostatic: ends when the unbalanced force is below this share of the loads
  std::vector<StartStress> start_stress{};   ///< of each body; empty: they begin with the stress that they have
  std::vector<Index> start_stress_bodies{};  ///< that begin with it, by their numbers; none: all
  bool reset_displacement = false;
  SourceLocation where;
};

struct StepLimits {
  Real cfl = 0.4;
  Real longest = std::numeric_limits<Real>::infinity();  ///< [s]
  Real shortest = 1e-12;                                 ///< [s]
};

/// How a stage went.
struct StageResult {
  std::string name, kind;
  Real start{}, end{};  ///< [s]
  std::int64_t steps{};
  Real residual{};  ///< at its end
  EnergyLedger energy;
  Real kinetic_end{}, plastic_end{};  ///< [J]
  Real first_residual{};              ///< of its first step: how far the state that it began with was from balance
  static constexpr auto fields()
  {
    return std::tuple{saved("name", &StageResult::name),
                      saved("kind", &StageResult::kind),
                      saved("start", &StageResult::start),
                      saved("end", &StageResult::end),
                      saved("steps", &StageResult::steps),
                      saved("residual", &StageResult::residual),
                      saved("energy", &StageResult::energy),
                      saved("kinetic_end", &StageResult::kinetic_end),
                      saved("plastic_end", &StageResult::plastic_end),
                      saved("first_residual", &StageResult::first_residual)};
  }
};

/// What the loop tells whoever watches; the watcher may look at the model and not touch it.  Before a step all is told of the one before:
/// what is kept of the model then is all that the steps to come depend on.  So it is where the run gives up, unless a step itself failed.
enum class RunEvent : std::uint8_t { stage_begins, step_begins, step_done, stage_done, given_up };

/// The worst that particles report of themselves, in words.
template <int D, Kernel<D> K>
std::string describe(const Model<D, K>& m, const ParticleErrors::Finding& finding)
{
  const auto at = std::find(m.particles.id.begin(), m.particles.id.end(), finding.id);
  if (at == m.particles.id.end())
    return {};  // another rank has it
  const auto row = static_cast<Index>(at - m.particles.id.begin());
  const std::string who = describe(m.particles, m.bodies, row);
  const Real J = m.particles.F[static_cast<std::size_t>(row)].determinant();
  switch (finding.trouble) {
    case Trouble::lost:
      return fmt::format("{} is outside the mesh; extend the mesh, close its boundary with a wall, or set on_exit: delete", who);
    case Trouble::inverted:
      return fmt::format("{} turned inside out, det F = {:.4g}; refine the mesh there, take more particles per cell or a smaller time.cfl",
                         who, J);
    case Trouble::no_answer: return fmt::format("the law of {} returned no finite stress, det F = {:.4g}", who, J);
    case Trouble::not_finite: break;
  }
  return fmt::format("{} has a position, velocity or deformation that is not finite; the step may be too long (time.cfl)", who);
}

/// RunError naming step, time, particle, body, scene line and place if the state is not sound, unless the scene would rather do without
/// the particles that failed in the step that is done.
template <int D, Kernel<D> K>
void stop_if_unwell(Model<D, K>& m, bool step_is_done)
{
  const auto finding = m.health.worst();
  if (!finding)
    return;
  std::string what = m.ranks->first(describe(m, *finding));
  const bool may_go = step_is_done && m.guards.failed > 0;
  if (may_go) {
    ExactSums<RemovedParticles<D>> departed;
    remove_failed(m.mesh, m.bodies, m.materials, m.particles, m.order, departed);
    m.ranks->sum(departed);
    book(departed.value(), m.mass, m.energy);
    update_tracked_rows(m);
    m.health.clear();
    m.watched.failure = what;
    if (m.mass.failed <= m.guards.failed * m.mass.start)
      return;
    what += fmt::format("; {} particles have failed and were deleted, {:.3g} of the mass, beyond watch.failed_mass = {:.3g}",
                        m.mass.failed_count, m.mass.failed / m.mass.start, m.guards.failed);
  }
  throw RunError(fmt::format("step {}, t = {:.6g} s: {}", m.clock.step, m.clock.time, what));
}

/// The bodies, those without particles whose numbers are not among `chosen`, unless that is empty.
inline std::vector<Body> only_bodies(std::span<const Index> chosen, std::vector<Body> bodies)
{
  for (std::size_t b = 0; b < bodies.size() && !chosen.empty(); ++b)
    if (std::find(chosen.begin(), chosen.end(), static_cast<Index>(b)) == chosen.end())
      bodies[b].end = bodies[b].begin;
  return bodies;
}

/// Sets the model up for the stage of that number.
template <int D, Kernel<D> K>
void begin_stage(Model<D, K>& m, const Stage& stage, Index number)
{
  m.stage = {.number = number,
             .first_step = m.clock.step,
             .damping = stage.damping,
             .begin = m.clock.time,
             .ramp_time = stage.ramp,
             .ramp_shape = stage.ramp_shape,
             .elastic = stage.elastic,
             .seeks_rest = stage.residual || stage.damping > 0};
  m.walls.begin_stage(stage.residual.has_value(), m.clock.time);
  // Under a stress of the start all of gravity acts, however it grows afterwards.
  const Real time = m.clock.time, ramp = stage.start_stress.empty() ? m.stage.ramp(time) : 1;
  soak(m.mesh, {m.water, ramp * m.loads.gravity.table(time)}, m.bodies, m.particles);
  if (!stage.start_stress.empty())
    set_start_stress(m.mesh, m.share, *m.ranks, m.loads.gravity(time, ramp), std::span(stage.start_stress), m.order,
                     only_bodies(stage.start_stress_bodies, m.bodies), m.materials, m.particles);
  const Real kinetic = totals(m).kinetic;
  m.energy = {.loads = m.energy.loads_ahead,
              .internal = m.energy.internal_ahead,
              .kinetic_start = kinetic,
              .plastic_start = plastic_work(m),
              .largest_before = m.energy.largest_term(kinetic),
              .largest_seen = std::max(m.energy.largest_seen, m.energy.largest_term(kinetic))};
  m.crossing = m.ranks->min(shortest_crossing(m.mesh, m.materials, m.particles));
  ExactSums<ForceAndMoment<D>> total;
  apply(m.loads, time, m.stage.ramp(time), m.followed, m.order, m.particles, total);
  m.stage.altitude = m.ranks->min(least_altitude(m.mesh, m.particles));
  m.stage.pull = m.ranks->max(largest_pull(m.particles));
}

/// The longest step that is stable [s], and in which loads alone do not move anything by more than a share of a cell: waves know nothing of
/// the velocity that a strong load gives to a soft body at rest.  dt <= cfl sqrt(h / |a|), as in smoothed particle hydrodynamics [Monaghan
/// 1992]; it is the shorter one only where rho |a| h, what a cell weighs on its base, is more than its stiffness rho c^2.
template <int D, Kernel<D> K>
Real wanted_step(const Model<D, K>& m, const StepLimits& limits)
{
  const Real time = m.clock.time, pull = m.loads.gravity(time, m.stage.ramp(time)).norm() + m.stage.pull;
  const Real of_loads = pull > 0 ? std::sqrt(m.stage.altitude / pull) : std::numeric_limits<Real>::infinity();
  return std::min(limits.cfl * std::min(m.crossing, of_loads), limits.longest);
}

/// Why the run cannot take its next step, if so.
template <int D, Kernel<D> K>
std::optional<std::string> obstacle(Model<D, K>& m, const StepLimits& limits)
{
  if (const Real wanted = wanted_step(m, limits); !(wanted >= limits.shortest)) {
    const std::string who = describe_least(m, slowest_particle(m.mesh, m.materials, m.particles));
    return fmt::format("{} needs a step of {:.3g} s, below time.min_step = {:.3g} s", who.empty() ? "the run" : who, wanted,
                       limits.shortest);
  }
  return fault(m, Look::between_steps);
}

/// RunError naming step and time; before it the state, which is whole, is shown as it was `before` it was looked at: a run that goes on from
/// there looks again, and counts once what it sees.
template <int D, Kernel<D> K, class Watch>
[[noreturn]] void abort_run(Model<D, K>& m, const LimitMonitor& before, Watch&& watch, const std::string& why)
{
  m.watched = before;
  watch(m, RunEvent::given_up);
  throw RunError(fmt::format("step {}, t = {:.6g} s: {}", m.clock.step, m.clock.time, why));
}

/// What a stage that seeks rest asks of a state, and what the state has.
struct RestConditions {
  Real asked;       ///< of both
  Real unbalanced;  ///< force over the loads
  Real kinetic;     ///< energy [J]
  Real work;        ///< of stress, gravity and loads in the stage [J]
  bool ramp_over;
  Real round_off = 0;  ///< energy that means nothing [J]: where all was in balance from the beginning, the work is of that kind too
  bool forces_balance() const noexcept { return unbalanced < asked; }
  bool motion_has_ended() const noexcept { return kinetic <= std::max(asked * work, round_off); }
  bool met() const noexcept { return ramp_over && forces_balance() && motion_has_ended(); }
};

template <int D, Kernel<D> K>
RestConditions rest_conditions(const Model<D, K>& m, const Stage& stage)
{
  // Of the energy at the speed of 1e-6 of that of waves: a speed of 1e-12, which no stage that has worked at anything comes to.
  constexpr Real round_off = 1e-12;
  return {.asked = *stage.residual,
          .unbalanced = m.residual,
          .kinetic = totals(m).kinetic,
          .work = std::abs(m.energy.internal + m.energy.gravity + m.energy.loads),
          .ramp_over = m.clock.time >= m.stage.begin + stage.ramp,
          .round_off = round_off * m.guards.least_energy};
}

/// Which of the conditions kept a stage from its end, `balanced` being the steps in a row at its end in which all were met.
inline std::string why_not_at_rest(const RestConditions& state, int balanced, int wanted)
{
  const std::string force = fmt::format("unbalanced force {:.3g} of the loads", state.unbalanced);
  const std::string motion = state.work > 0 ? fmt::format("kinetic energy {:.3g} of the work done", state.kinetic / state.work)
                                            : fmt::format("kinetic energy {:.3g} J and no work done", state.kinetic);
  if (state.met())
    return fmt::format("{} and {} are below {:.3g}, but only in the last {} steps, asked are {} in a row", force, motion, state.asked,
                       balanced, wanted);
  if (!state.ramp_over)
    return "the loads were still growing (ramp)";
  if (state.forces_balance())
    return fmt::format("{}, asked {:.3g} ({}: that is reached)", motion, state.asked, force);
  if (state.motion_has_ended())
    return fmt::format("{}, asked {:.3g} ({}: that is reached)", force, state.asked, motion);
  return fmt::format("{} and {}, asked {:.3g} of both", force, motion, state.asked);
}

/// Runs the stage that has begun to its end.  `watch(model, moment)` is called before and after each step and at the end.
template <int D, Kernel<D> K, class Watch>
StageResult finish_stage(Model<D, K>& m, const Stage& stage, const StepLimits& limits, Watch&& watch)
{
  constexpr int steps_in_balance = 20;  // an oscillation passes through balance; this many steps in a row do not
  const Real begin = m.stage.begin, end = begin + stage.duration;
  while (m.clock.time < end * (1 - 1e-14) && m.stage.balanced < steps_in_balance) {
    watch(m, RunEvent::step_begins);
    const LimitMonitor before = m.watched;
    if (const auto why = obstacle(m, limits))
      abort_run(m, before, watch, *why);
    const Real wanted = wanted_step(m, limits), left = end - m.clock.time;
    const Real dt = left <= wanted ? left : left < 2 * wanted ? left / 2 : wanted;  // no sliver of a step at the end
    const std::int64_t step = m.clock.step;
    advance(m, dt);
    stop_if_unwell(m, m.clock.step > step);
    if (step == m.stage.first_step)
      m.stage.first_residual = m.residual;
    // Energies of all particles are added up only where the rest is as it should be.
    const bool may_rest = stage.residual && m.clock.time >= begin + stage.ramp && m.residual < *stage.residual;
    m.stage.balanced = may_rest && rest_conditions(m, stage).met() ? m.stage.balanced + 1 : 0;
    watch(m, RunEvent::step_done);
  }
  const LimitMonitor before = m.watched;
  if (const auto why = fault(m, Look::at_end_of_stage))
    abort_run(m, before, watch, *why);
  const Totals<D> now = totals(m);
  const StageResult result{stage.name,
                           stage.kind,
                           begin,
                           m.clock.time,
                           m.clock.step - m.stage.first_step,
                           m.residual,
                           m.energy.at_velocities(),
                           now.kinetic,
                           plastic_work(m),
                           m.stage.first_residual};
  if (stage.residual && m.stage.balanced < steps_in_balance)
    abort_run(m, before, watch,
              fmt::format("stage \"{}\"{} did not come to rest within {:.6g} s: {}; give it more duration or damping", stage.name,
                          stage.where.line > 0 ? fmt::format(" ({})", to_string(stage.where)) : "", stage.duration,
                          why_not_at_rest(rest_conditions(m, stage), m.stage.balanced, steps_in_balance)));
  if (stage.residual) {
    m.energy.set_to_rest = now.kinetic;
    m.momentum.rest += ForceAndMoment<D>::of(-now.momentum, -now.angular);
    m.particles.v.assign(m.particles.v.size(), Vec<D>::Zero());
    m.clock.lag = 0;
    for (auto* affine : {&m.particles.L, &m.particles.C})
      affine->assign(affine->size(), Mat<D>::Zero());
  }
  if (stage.reset_displacement && !m.particles.x0.empty())
    m.particles.x0 = m.particles.x;
  m.stage.done = true;
  watch(m, RunEvent::stage_done);
  return result;
}

/// Begins a stage and runs it; `watch` is called once it has begun as well.
template <int D, Kernel<D> K, class Watch>
StageResult run_stage(Model<D, K>& m, const Stage& stage, const StepLimits& limits, Watch&& watch, Index number = 0)
{
  begin_stage(m, stage, number);
  watch(m, RunEvent::stage_begins);
  return finish_stage(m, stage, limits, watch);
}

}  // namespace talus
