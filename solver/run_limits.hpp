#pragma once
// Watches a run for what no sound one does: particles faster than anything could make them, energy that nothing worked for, mass that
// nodes and particles do not agree on.  What a single particle can say of itself is in core/particle_errors.hpp.
#include <fmt/format.h>

#include "solver/model.hpp"
#include "solver/stable_step.hpp"

namespace talus {

/// Who, in words: `particle 3311 of "dam" (scenes/dam.yaml:31) at (4.2, 0.1)`.
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

/// Of the particles that the ranks have chosen the one with the least value, in words.  Every rank has to ask.
template <int D, Kernel<D> K>
std::string describe_least(const Model<D, K>& m, const Chosen& here)
{
  const bool mine = m.ranks->min(here.value) == here.value && here.row != none;
  const std::int64_t id = mine ? m.particles.id[static_cast<std::size_t>(here.row)] : std::numeric_limits<std::int64_t>::max();
  return m.ranks->first(m.ranks->min(id) == id && mine ? describe(m.particles, m.bodies, here.row) : std::string());
}

/// Kinetic and strain energy and what the laws dissipated, of deleted particles too, beyond all that was there or was put in, over the
/// largest of the terms. Those of the stages before count there: in a body that is at rest under its stress all terms of a stage are as
/// small as what the last step leaves open.
template <int D, Kernel<D> K>
Real energy_gain(const Model<D, K>& m, Real kinetic)
{
  const EnergyLedger e = m.energy.at_velocities();
  const Real insert_particles = e.gravity + e.loads + e.walls + e.arrival + e.friction + e.damping;
  const Real largest = std::max(m.guards.least_energy, e.largest_term(kinetic));
  return largest > 0 ? (kinetic + e.carried_away - e.kinetic_start + e.internal - insert_particles) / largest : 0;
}

enum class Look : std::uint8_t { between_steps, at_end_of_stage };

/// Looks at the state after a step and notes what it sees.  In words what no policy of the scene lets pass, nothing if all is well.
/// Sums over all particles are looked at every so many steps, since what goes wrong grows over tens of them, and at the end of a stage.
template <int D, Kernel<D> K>
std::optional<std::string> fault(Model<D, K>& m, Look look)
{
  constexpr int steps_between_sums = 10;
  if (m.clock.step == m.stage.first_step)
    return std::nullopt;  // no step yet: it was looked at when the stage before ended
  const RunLimits& limit = m.guards;
  LimitMonitor& seen = m.watched;
  seen.fastest = std::max(seen.fastest, seen.speed);
  if (seen.speed > limit.speed) {
    ++seen.speeding;
    if (limit.speed_stops)
      return fmt::format("{} moves at {:.4g} m/s, beyond watch.speed = {:.4g} m/s", describe_least(m, fastest_particle(m.particles)),
                         seen.speed, limit.speed);
  }
  if (look == Look::between_steps && m.clock.step % steps_between_sums != 0)
    return std::nullopt;

  const Totals<D> now = totals(m);
  m.energy.largest_seen = std::max(m.energy.largest_seen, m.energy.largest_term(now.kinetic));
  const Real there = m.mass.due();
  const Real lost = std::max(std::abs(now.mass - there), std::abs(m.mass.on_nodes - there)) / (m.mass.start + m.mass.placed);
  seen.mass = std::max(seen.mass, lost);
  if (lost > limit.mass)
    return fmt::format("the mass does not add up: {:.10g} kg should be there, particles have {:.10g} kg, nodes carried {:.10g} kg", there,
                       now.mass, m.mass.on_nodes);
  // In the first steps of a stage all terms are small, and the mean velocity of a step is not that of its stress power.
  if (m.clock.step < m.stage.first_step + 2 * steps_between_sums)
    return std::nullopt;
  const Real gain = energy_gain(m, now.kinetic);
  seen.gain = std::max(seen.gain, gain);
  if (gain > limit.gain) {
    ++seen.gaining;
    if (limit.gain_stops)
      return fmt::format(
          "the energy grows by what nothing did work for, {:.3g} of its largest term, beyond watch.energy_gain = {:.3g}; the fastest is {}",
          gain, limit.gain, describe_least(m, fastest_particle(m.particles)));
  }
  return std::nullopt;
}

}  // namespace talus
