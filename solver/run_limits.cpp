#include "solver/run_limits.hpp"

#include <fmt/format.h>

#include <limits>

namespace talus {

template <int D>
std::string describe(const Particles<D>& particles, const std::vector<Body>& bodies, Index row)
{
  const auto p = static_cast<std::size_t>(row);
  std::string body, place;
  for (const Body& b : bodies)
    if (b.begin <= row && row < b.end)
      body = fmt::format(" of \"{}\"{}", b.name, b.where.line > 0 ? fmt::format(" ({})", to_string(b.where)) : "");
  for (int d = 0; d < D; ++d)
    place += fmt::format("{}{:.6g}", d == 0 ? "" : ", ", particles.x[p][d]);
  return fmt::format("particle {}{} at ({})", particles.id[p], body, place);
}

template <int D>
std::string describe_least(const Model<D>& m, const Chosen& here)
{
  const bool mine = m.problem.ranks->min(here.value) == here.value && here.row != none;
  const std::int64_t id = mine ? m.state.particles.id[static_cast<std::size_t>(here.row)] : std::numeric_limits<std::int64_t>::max();
  return m.problem.ranks->first(m.problem.ranks->min(id) == id && mine ? describe(m.state.particles, m.state.bodies, here.row)
                                                                       : std::string());
}

template <int D>
Real energy_gain(const Model<D>& m, Real kinetic)
{
  const EnergyLedger e = m.state.energy.at_velocities();
  const Real work = e.gravity + e.loads + e.walls + e.arrival + e.friction + e.damping;
  const Real largest = std::max(m.problem.limits.least_energy, e.largest_term(kinetic));
  return largest > 0 ? (kinetic + e.gone() - e.kinetic_start + e.internal - work) / largest : 0;
}

template <int D>
std::optional<std::string> exceeded_limit(Model<D>& m, Look look)
{
  constexpr int steps_between_sums = 10;
  if (m.state.clock.step == m.state.stage.first_step)
    return std::nullopt;  // no step yet: it was looked at when the stage before ended
  const RunLimits& limit = m.problem.limits;
  LimitMonitor& seen = m.state.monitor;
  seen.fastest = std::max(seen.fastest, seen.speed);
  if (seen.speed > limit.speed) {
    ++seen.speeding;
    if (limit.speed_stops) {
      end_sweeps(m);
      return fmt::format("{} moves at {:.4g} m/s, beyond watch.speed = {:.4g} m/s", describe_least(m, fastest_particle(m.state.particles)),
                         seen.speed, limit.speed);
    }
  }
  if (look == Look::between_steps && m.state.clock.step % steps_between_sums != 0)
    return std::nullopt;

  const Totals<D> now = totals(m);
  m.state.energy.largest_seen = std::max(m.state.energy.largest_seen, m.state.energy.largest_term(now.kinetic));
  const Real there = m.state.mass.due();
  const Real lost =
      std::max(std::abs(now.mass - there), std::abs(m.state.mass.on_nodes - there)) / (m.state.mass.start + m.state.mass.placed);
  seen.mass = std::max(seen.mass, lost);
  if (lost > limit.mass)
    return fmt::format("the mass does not add up: {:.10g} kg should be there, particles have {:.10g} kg, nodes carried {:.10g} kg", there,
                       now.mass, m.state.mass.on_nodes);
  // In the first steps of a stage all terms are small, and the mean velocity of a step is not that of its stress power.
  if (m.state.clock.step < m.state.stage.first_step + 2 * steps_between_sums)
    return std::nullopt;
  const Real gain = energy_gain(m, now.kinetic);
  seen.gain = std::max(seen.gain, gain);
  if (gain > limit.gain) {
    ++seen.gaining;
    if (limit.gain_stops) {
      end_sweeps(m);
      return fmt::format(
          "the energy grows by what nothing did work for, {:.3g} of its largest term, beyond watch.energy_gain = {:.3g}; the fastest is {}",
          gain, limit.gain, describe_least(m, fastest_particle(m.state.particles)));
    }
  }
  return std::nullopt;
}

template std::string describe(const Particles<2>&, const std::vector<Body>&, Index);
template std::string describe(const Particles<3>&, const std::vector<Body>&, Index);
template std::string describe_least(const Model<2>&, const Chosen&);
template std::string describe_least(const Model<3>&, const Chosen&);
template Real energy_gain(const Model<2>&, Real);
template Real energy_gain(const Model<3>&, Real);
template std::optional<std::string> exceeded_limit(Model<2>&, Look);
template std::optional<std::string> exceeded_limit(Model<3>&, Look);

}  // namespace talus
