#pragma once
// The state of a run between two steps: all that the steps to come depend on and that the scene does not tell.
#include <cstdint>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "core/fields.hpp"
#include "core/member_count.hpp"
#include "core/particles.hpp"
#include "core/ramp.hpp"
#include "materials/interface/material.hpp"
#include "solver/boundary/boundary_conditions.hpp"
#include "solver/state/ledger.hpp"

namespace talus {

struct Clock {
  std::int64_t step = 0;  ///< steps done
  Real time = 0;          ///< of places, deformation and stress [s]
  Real dt = 0;            ///< of the last step [s]
  Real lag = 0;           ///< by how much velocities are behind `time` [s]: half a step, or nothing where they have just been given
  static constexpr auto fields()
  {
    return std::tuple{saved("step", &Clock::step), saved("time", &Clock::time), saved("dt", &Clock::dt), saved("lag", &Clock::lag)};
  }
};

/// What a stage sets for every step it makes, and how far it is.
struct StageState {
  Index number = 0;                                       ///< of the stage
  std::int64_t first_step = 0;                            ///< steps done when it began
  int balanced = 0;                                       ///< steps in balance, one after the other, up to now
  Real damping = 0;                                       ///< local, share of the unbalanced force
  Real first_residual = 0;                                ///< unbalanced force over the loads in its first step
  Real begin = 0, ramp_time = 0;                          ///< [s]; gravity and loads grow from 0 to 1 over [begin, begin + ramp_time]
  Real altitude = std::numeric_limits<Real>::infinity();  ///< least one of the cells that held particles when it began [m]
  Real pull = 0;                                          ///< largest acceleration by forces on particles then [m/s^2]
  RampShape ramp_shape = RampShape::linear;
  bool elastic = false;     ///< yielding suspended
  bool seeks_rest = false;  ///< ends at rest, or is damped
  bool done = false;        ///< it has ended
  Real ramp(Real time) const noexcept { return ramp_time > 0 ? ramp_at(ramp_shape, (time - begin) / ramp_time) : Real{1}; }
  static constexpr auto fields()
  {
    return std::tuple{saved("number", &StageState::number),
                      saved("first_step", &StageState::first_step),
                      saved("balanced", &StageState::balanced),
                      saved("damping", &StageState::damping),
                      saved("altitude", &StageState::altitude),
                      saved("pull", &StageState::pull),
                      saved("begin", &StageState::begin),
                      saved("ramp_time", &StageState::ramp_time),
                      saved("elastic", &StageState::elastic),
                      saved("seeks_rest", &StageState::seeks_rest),
                      saved("done", &StageState::done),
                      saved("first_residual", &StageState::first_residual),
                      saved("ramp_shape", &StageState::ramp_shape)};
  }
};

/// Time spent per phase of the step [s], and the work counted.
struct Timings {
  Real locate{}, scatter{}, nodes{}, gather{}, stress{}, output{};
  Real particle_steps{};
  static constexpr auto fields()
  {
    return std::tuple{saved("locate", &Timings::locate),
                      saved("scatter", &Timings::scatter),
                      saved("nodes", &Timings::nodes),
                      saved("gather", &Timings::gather),
                      saved("stress", &Timings::stress),
                      saved("output", &Timings::output),
                      saved("particle_steps", &Timings::particle_steps)};
  }
};

/// What the limits of the run were compared with since its start.
struct LimitMonitor {
  Real speed{};                        ///< of the fastest particle in the last step [m/s]
  Real fastest{};                      ///< the same, in any step
  Real gain{}, mass{};                 ///< largest, as in RunLimits
  std::int64_t speeding{}, gaining{};  ///< steps, and looks at the sums, beyond the limit
  std::string failure;                 ///< of particles that were deleted for it, the last one
  static constexpr auto fields()
  {
    return std::tuple{saved("speed", &LimitMonitor::speed),       saved("fastest", &LimitMonitor::fastest),
                      saved("gain", &LimitMonitor::gain),         saved("mass", &LimitMonitor::mass),
                      saved("speeding", &LimitMonitor::speeding), saved("gaining", &LimitMonitor::gaining),
                      saved("failure", &LimitMonitor::failure)};
  }
};

/// By value: a copy is a run at that time.  Whoever saves, sends or compares states does so part by part, by parts().
template <int D>
struct State {
  Clock clock;
  StageState stage;
  EnergyLedger energy;  ///< since the beginning of the stage
  MassLedger<D> mass;
  MomentumLedger<D> momentum;
  LimitMonitor watched;
  Timings timings;
  Real residual = 0;  ///< of the last step: unbalanced force of the nodes over the loads
  Real crossing = 0;  ///< shortest wave transit time of a cell with particles [s]; the stable step is a share of it
  BoundaryConditions<D> walls;
  std::vector<Body> bodies;
  std::vector<Material> materials;  ///< one for each body, of the same rows
  Particles<D> particles;

  static constexpr auto parts()
  {
    return std::tuple{saved("clock", &State::clock),        saved("stage", &State::stage),       saved("energy", &State::energy),
                      saved("mass", &State::mass),          saved("momentum", &State::momentum), saved("watched", &State::watched),
                      saved("timings", &State::timings),    saved("residual", &State::residual), saved("crossing", &State::crossing),
                      saved("walls", &State::walls),        saved("bodies", &State::bodies),     saved("laws", &State::materials),
                      saved("particles", &State::particles)};
  }
};

/// f(name, part) for each part of a state.
template <class S, class F>
void for_each_part(S& state, F&& f)
{
  constexpr auto parts = std::remove_const_t<S>::parts();
  static_assert(std::tuple_size_v<decltype(parts)> == member_count<std::remove_const_t<S>>(), "a member of State is missing in parts()");
  std::apply([&](const auto&... part) { (f(std::string(part.key), state.*part.member), ...); }, parts);
}

}  // namespace talus
