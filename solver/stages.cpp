#include "solver/stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/advance.hpp"
#include "solver/each_particle.hpp"
#include "solver/run_limits.hpp"
#include "solver/stable_step.hpp"
#include "solver/statics/static_stage.hpp"
#include "solver/step/resample_step.hpp"
#include "solver/step/step_parts.hpp"

namespace talus {

/// Steps in balance that end a stage: an oscillation passes through balance; this many steps in a row do not.
constexpr int steps_in_balance = 20;

/// The worst that particles report of themselves, in words.
template <int D>
std::string describe(const Model<D>& m, const ParticleErrors::Finding& finding)
{
  const auto at = std::find(m.state.particles.id.begin(), m.state.particles.id.end(), finding.id);
  if (at == m.state.particles.id.end())
    return {};  // another rank has it
  const auto row = static_cast<Index>(at - m.state.particles.id.begin());
  const std::string who = describe(m.state.particles, m.state.bodies, row);
  const Real J = m.state.particles.F[static_cast<std::size_t>(row)].determinant();
  switch (finding.trouble) {
    case Trouble::lost:
      return fmt::format("{} is outside the mesh; extend the mesh, close its boundary with a wall, or set on_exit: delete", who);
    case Trouble::inverted:
      return fmt::format("{} turned inside out, det F = {:.4g}; refine the mesh there, take more particles per cell or a smaller time.cfl",
                         who, J);
    case Trouble::no_answer: {
      const ConstitutiveLaw& law = m.state.materials[static_cast<std::size_t>(body_of(m.state.bodies, row))].law();
      if (const std::string complaint = law.complaint(finding.id); !complaint.empty())
        return fmt::format("law {}: {} ({})", law.name(), complaint, who);
      return fmt::format("the law {} of {} returned no finite stress, det F = {:.4g}", law.name(), who, J);
    }
    case Trouble::not_finite: break;
  }
  return fmt::format("{} has a position, velocity or deformation that is not finite; the step may be too long (time.cfl)", who);
}

/// RunError naming step, time, particle, body, scene line and place if the state is not sound, unless the scene would rather do without
/// the particles that failed in the step that is done.
template <int D>
void stop_if_invalid(Model<D>& m, bool step_is_done)
{
  const auto finding = m.work.errors.worst();
  if (!finding)
    return;
  end_sweeps(m);
  std::string what = m.problem.ranks->first(describe(m, *finding));
  const bool may_go = step_is_done && m.problem.limits.failed > 0;
  if (may_go) {
    ExactSums<RemovedParticles<D>> removed;
    remove_failed(m.problem.mesh, m.state.bodies, m.state.materials, m.state.particles, m.work.order, removed);
    m.problem.ranks->sum(removed);
    record_removed(removed.value(), m.state.mass, m.state.energy);
    m.work.errors.clear();
    m.state.monitor.failure = what;
    if (m.state.mass.failed <= m.problem.limits.failed * m.state.mass.start)
      return;
    what += fmt::format("; {} particles have failed and were deleted, {:.3g} of the mass, beyond watch.failed_mass = {:.3g}",
                        m.state.mass.failed_count, m.state.mass.failed / m.state.mass.start, m.problem.limits.failed);
  }
  throw RunError(fmt::format("step {}, t = {:.6g} s: {}", m.state.clock.step, m.state.clock.time, what));
}

/// Takes all motion away.
template <int D>
void set_to_rest(Model<D>& m)
{
  const Totals<D> now = totals(m);
  m.state.energy.set_to_rest = now.kinetic;
  m.state.momentum.rest += ForceAndMoment<D>::of(-now.momentum, -now.angular);
  stop_particles(m);
  m.state.clock.lag = 0;
  for (RigidState<D>& rigid : m.state.rigid)
    rigid.v.setZero(), rigid.spin.setZero();
}

/// The bodies, those without particles whose numbers are not among `chosen`, unless that is empty.
std::vector<Body> only_bodies(std::span<const Index> chosen, std::vector<Body> bodies)
{
  for (std::size_t b = 0; b < bodies.size() && !chosen.empty(); ++b)
    if (std::find(chosen.begin(), chosen.end(), static_cast<Index>(b)) == chosen.end())
      bodies[b].end = bodies[b].begin;
  return bodies;
}

template <int D>
void begin_stage(Model<D>& m, const Stage& stage, Index number)
{
  m.state.stage = {
      .number = number,
      .first_step = m.state.clock.step,
      .damping = stage.damping,
      .begin = m.state.clock.time,
      // The loads are complete where the short increments begin.
      .ramp_time = stage.ramp > 0 && stage.equilibrium
                       ? stage.ramp - time_of_short_increments(m, *stage.equilibrium, stage.duration / stage.equilibrium->increments)
                       : stage.ramp,
      .ramp_shape = stage.ramp_shape,
      .elastic = stage.elastic,
      .seeks_rest = stage.seeks_rest(),
      .flows = m.problem.flow.any() && stage.lets_water_flow()};
  m.state.solve = {};
  if (m.work.flow)
    m.work.flow->begin_stage();
  m.state.boundary.begin_stage(stage.is_at_rest(), m.state.clock.time);
  // Under a stress of the start all of gravity acts, however it grows afterwards.
  const Real time = m.state.clock.time, ramp = stage.start_stress.empty() ? m.state.stage.ramp(time) : 1;
  const auto follows_table = [&m](Index body) {
    return m.problem.water.drains(body) && !(m.problem.flow.flows(body) && m.state.flow.begun);
  };
  const auto stress_of = [&m](Index body, Real p) { return m.problem.flow.stress_of(body, p); };
  soak(m.problem.mesh, {m.problem.water, ramp * m.problem.loads.gravity.table(time)}, m.state.bodies, follows_table, stress_of,
       m.state.particles);
  if (!stage.start_stress.empty())
    set_start_stress(
        m.problem.mesh, m.problem.subdomain, *m.problem.ranks, m.problem.loads.gravity(time, ramp), std::span(stage.start_stress),
        m.work.order, only_bodies(stage.start_stress_bodies, m.state.bodies), m.state.materials, m.state.particles,
        [&](const Vec<D>& x) { return m.problem.flow.pond_pressure(x[D - 1], time, ramp * m.problem.loads.gravity.table(time)); });
  if (stage.equilibrium)
    set_to_rest(m);
  const Real kinetic = totals(m).kinetic;
  m.state.energy = {.loads = m.state.energy.loads_ahead,
                    .internal = m.state.energy.internal_ahead,
                    .kinetic_start = kinetic,
                    .plastic_start = plastic_work(view_of(m, stage)),
                    .largest_before = m.state.energy.largest_term(kinetic),
                    .largest_seen = std::max(m.state.energy.largest_seen, m.state.energy.largest_term(kinetic))};
  m.state.crossing = m.problem.ranks->min(shortest_crossing(m.problem.mesh, m.state.materials, m.state.particles));
  if (m.problem.columns.applied) {  // strips compute the forces
    begin_sweeps(m);
    end_sweeps(m);
  }
  m.state.stage.altitude = m.problem.ranks->min(least_altitude(m.problem.mesh, m.state.particles));
  m.state.stage.pull = m.problem.ranks->max(largest_pull(m.state.particles));
}

/// The longest step that is stable [s], and in which loads alone do not move anything by more than a share of a cell: waves know nothing of
/// the velocity that a strong load gives to a soft body at rest.  dt <= cfl sqrt(h / |a|), as in smoothed particle hydrodynamics [Monaghan
/// 1992]; it is the shorter one only where rho |a| h, what a cell weighs on its base, is more than its stiffness rho c^2.
template <int D>
Real wanted_step(const Model<D>& m, const StepLimits& limits)
{
  const Real time = m.state.clock.time, pull = m.problem.loads.gravity(time, m.state.stage.ramp(time)).norm() + m.state.stage.pull;
  const Real of_loads = pull > 0 ? std::sqrt(m.state.stage.altitude / pull) : std::numeric_limits<Real>::infinity();
  const Real rigid = fastest(m.problem.rigid, m.state.rigid);  // what it meets will move as fast
  const Real of_rigid = rigid > 0 ? m.state.stage.altitude / rigid : std::numeric_limits<Real>::infinity();
  return std::min(limits.cfl * std::min({m.state.crossing, of_loads, of_rigid}), limits.longest);
}

/// Calls `watch`, with the particles in their columns unless it copies them itself.
template <int D>
void show(Model<D>& m, const Watch<D>& watch, RunEvent event)
{
  if (!watch.copies_particles)
    end_sweeps(m);
  watch.see(m, event);
  drop_copy(m);
}

/// Why the pore pressure of the last step cannot be trusted, if so.
std::optional<std::string> pressure_not_found(const FlowLedger& flow)
{
  if (flow.found)
    return std::nullopt;
  return fmt::format(
      "the pore pressure of the last step was not found: {:.3g} of the right-hand side were left after {} iterations; the state "
      "has become unsound, or permeabilities differ too much",
      flow.residual, flow.iterations);
}

/// Why the run cannot take its next step, if so.
template <int D>
std::optional<std::string> reason_to_stop(Model<D>& m, const Stage& stage, const StepLimits& limits)
{
  if (const Real wanted = wanted_step(m, limits); !stage.equilibrium && !(wanted >= limits.shortest)) {
    end_sweeps(m);
    const std::string who = describe_least(m, slowest_particle(m.problem.mesh, m.state.materials, m.state.particles));
    return fmt::format("{} needs a step of {:.3g} s, below time.min_step = {:.3g} s", who.empty() ? "the run" : who, wanted,
                       limits.shortest);
  }
  if (m.problem.exits.policy == OnExit::stop)
    for (std::size_t r = 0; r < m.state.rigid.size(); ++r)
      if (const Vec<D>& x = m.state.rigid[r].x; m.problem.rigid.bodies[r].is_free() && ((x.array() < m.problem.mesh.low().array()).any() ||
                                                                                        (x.array() > m.problem.mesh.high().array()).any()))
        return fmt::format(
            "the rigid body \"{}\" has left the mesh at ({:.6g}): make the mesh larger, put a boundary condition where it "
            "leaves, or let it go with on_exit: delete",
            m.problem.rigid.bodies[r].name, fmt::join(x.begin(), x.end(), ", "));
  if (auto why = pressure_not_found(m.state.flow))
    return why;
  return exceeded_limit(m, Look::between_steps);
}

/// RunError naming step and time; before it the state, which is whole, is shown as it was `before` it was looked at: a run that goes on from
/// there looks again, and counts once what it sees.
template <int D>
[[noreturn]] void abort_run(Model<D>& m, const LimitMonitor& before, const Watch<D>& watch, const std::string& why)
{
  m.state.monitor = before;
  show(m, watch, RunEvent::given_up);
  throw RunError(fmt::format("step {}, t = {:.6g} s: {}", m.state.clock.step, m.state.clock.time, why));
}

template <int D>
RestConditions rest_conditions(const Model<D>& m, const Stage& stage)
{
  // Of the energy at the speed of 1e-6 of that of waves: a speed of 1e-12, which no stage that has worked at anything comes to.
  constexpr Real round_off = 1e-12;
  return {.asked = *stage.residual,
          .unbalanced = m.state.residual,
          .kinetic = totals(m).kinetic,
          .work = std::abs(m.state.energy.internal + m.state.energy.gravity + m.state.energy.loads),
          .ramp_over = m.state.clock.time >= m.state.stage.begin + stage.ramp,
          .round_off = round_off * m.problem.limits.least_energy};
}

std::string why_not_at_rest(const RestConditions& state, int balanced, int wanted)
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

/// Steps until the stage has ended.
template <int D>
void make_steps(Model<D>& m, const Stage& stage, const StepLimits& limits, const Watch<D>& watch)
{
  const Real begin = m.state.stage.begin, end = begin + stage.duration;
  while (m.state.clock.time < end * (1 - 1e-14) && m.state.stage.balanced < steps_in_balance) {
    show(m, watch, RunEvent::step_begins);
    const LimitMonitor before = m.state.monitor;
    if (const auto why = reason_to_stop(m, stage, limits))
      abort_run(m, before, watch, *why);
    const Real left = end - m.state.clock.time;
    const std::int64_t step = m.state.clock.step;
    if (stage.equilibrium) {
      if (const auto why = make_increment(m, *stage.equilibrium, stage.duration / stage.equilibrium->increments, left))
        abort_run(m, before, watch, *why);
    } else {
      const Real wanted = wanted_step(m, limits);
      make_step(m, left <= wanted ? left : left < 2 * wanted ? left / 2 : wanted);  // no sliver of a step at the end
    }
    stop_if_invalid(m, m.state.clock.step > step);
    if (!stage.equilibrium)
      resample_particles(m);
    if (step == m.state.stage.first_step)
      m.state.stage.first_residual = m.state.residual;
    // Energies of all particles are added up only where the rest is as it should be.
    const bool may_rest = stage.residual && m.state.clock.time >= begin + stage.ramp && m.state.residual < *stage.residual;
    m.state.stage.balanced = may_rest && rest_conditions(m, stage).met() ? m.state.stage.balanced + 1 : 0;
    show(m, watch, RunEvent::step_done);
  }
  end_sweeps(m);
}

template <int D>
StageResult finish_stage(Model<D>& m, const Stage& stage, const StepLimits& limits, const std::type_identity_t<Watch<D>>& watch)
{
  try {
    make_steps(m, stage, limits, watch);
  } catch (...) {
    end_sweeps(m);
    throw;
  }
  const Real begin = m.state.stage.begin;
  const LimitMonitor before = m.state.monitor;
  for (const auto& why : {pressure_not_found(m.state.flow), exceeded_limit(m, Look::at_end_of_stage)})
    if (why)
      abort_run(m, before, watch, *why);
  const Totals<D> now = totals(m);
  const StageResult result{stage.name,
                           stage.kind,
                           begin,
                           m.state.clock.time,
                           m.state.clock.step - m.state.stage.first_step,
                           m.state.residual,
                           m.state.energy.at_velocities(),
                           now.kinetic,
                           plastic_work(view_of(m, stage)),
                           m.state.stage.first_residual,
                           m.state.solve};
  if (stage.residual && m.state.stage.balanced < steps_in_balance)
    abort_run(m, before, watch,
              fmt::format("stage \"{}\"{} did not come to rest within {:.6g} s: {}; give it more duration or damping", stage.name,
                          stage.where.line > 0 ? fmt::format(" ({})", to_string(stage.where)) : "", stage.duration,
                          why_not_at_rest(rest_conditions(m, stage), m.state.stage.balanced, steps_in_balance)));
  if (stage.equilibrium && m.state.residual > stage.equilibrium->most_unbalanced.value_or(std::numeric_limits<Real>::infinity()))
    abort_run(m, before, watch,
              fmt::format("stage \"{}\"{} is not in equilibrium: unbalanced force {:.3g} of the loads, which only the solver holds, "
                          "allowed {:.3g} (unbalanced); take more increments or smaller cells; else the soil carries less than the loads",
                          stage.name, stage.where.line > 0 ? fmt::format(" ({})", to_string(stage.where)) : "", m.state.residual,
                          *stage.equilibrium->most_unbalanced));
  if (stage.residual)
    set_to_rest(m);
  if (stage.reset_displacement && !m.state.particles.x0.empty())
    m.state.particles.x0 = m.state.particles.x;
  m.state.stage.done = true;
  show(m, watch, RunEvent::stage_done);
  return result;
}

template <int D>
StageResult run_stage(Model<D>& m, const Stage& stage, const StepLimits& limits, const std::type_identity_t<Watch<D>>& watch, Index number)
{
  begin_stage(m, stage, number);
  show(m, watch, RunEvent::stage_begins);
  return finish_stage(m, stage, limits, watch);
}

template void begin_stage(Model<2>&, const Stage&, Index);
template void begin_stage(Model<3>&, const Stage&, Index);
template Real wanted_step(const Model<2>&, const StepLimits&);
template Real wanted_step(const Model<3>&, const StepLimits&);
template RestConditions rest_conditions(const Model<2>&, const Stage&);
template RestConditions rest_conditions(const Model<3>&, const Stage&);
template StageResult finish_stage(Model<2>&, const Stage&, const StepLimits&, const std::type_identity_t<Watch<2>>&);
template StageResult finish_stage(Model<3>&, const Stage&, const StepLimits&, const std::type_identity_t<Watch<3>>&);
template StageResult run_stage(Model<2>&, const Stage&, const StepLimits&, const std::type_identity_t<Watch<2>>&, Index);
template StageResult run_stage(Model<3>&, const Stage&, const StepLimits&, const std::type_identity_t<Watch<3>>&, Index);

}  // namespace talus
