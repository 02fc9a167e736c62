#pragma once
// The state of a run between two steps: everything that later steps depend on and that the scene does not contain.
#include <cstdint>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "core/fields.hpp"
#include "core/member_count.hpp"
#include "core/particles.hpp"
#include "core/time_table.hpp"
#include "materials/interface/material.hpp"
#include "solver/boundary/boundary_conditions.hpp"
#include "solver/flow/flow.hpp"
#include "solver/rigid/rigid_body.hpp"
#include "solver/state/ledger.hpp"
#include "solver/stress/empty_cell_stress.hpp"

namespace talus {

struct Clock {
  std::int64_t step = 0;  ///< number of steps done
  Real time = 0;          ///< time of positions, deformation and stress [s]
  Real dt = 0;            ///< length of the last step [s]
  Real lag = 0;           ///< delay of velocities behind `time` [s]: half a step, or zero where they have just been set
  static constexpr auto fields()
  {
    return std::tuple{saved("step", &Clock::step), saved("time", &Clock::time), saved("dt", &Clock::dt), saved("lag", &Clock::lag)};
  }
};

/// The settings of a stage for each of its steps, and its progress.
struct StageState {
  Index number = 0;                                       ///< number of the stage
  std::int64_t first_step = 0;                            ///< steps done when it began
  int balanced = 0;                                       ///< consecutive steps in equilibrium up to now
  Real damping = 0;                                       ///< local damping, fraction of the unbalanced force [-]
  Real first_residual = 0;                                ///< unbalanced force over the loads in its first step [-]
  Real begin = 0, ramp_time = 0;                          ///< [s]; gravity and loads grow from 0 to 1 over [begin, begin + ramp_time]
  Real altitude = std::numeric_limits<Real>::infinity();  ///< least altitude of the cells that contained particles at its beginning [m]
  Real pull = 0;                                          ///< largest acceleration by forces on particles at its beginning [m/s^2]
  RampShape ramp_shape = RampShape::linear;
  bool elastic = false;     ///< whether plastic flow is suspended
  bool seeks_rest = false;  ///< whether it ends in equilibrium, or is damped
  bool flows = false;       ///< whether water flows through pores in it
  bool done = false;        ///< whether it has ended
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
                      saved("flows", &StageState::flows),
                      saved("done", &StageState::done),
                      saved("first_residual", &StageState::first_residual),
                      saved("ramp_shape", &StageState::ramp_shape)};
  }
};

/// How the equations of equilibrium were solved in a stage that solves for it.
struct SolveLedger {
  Real increment = 0;                                                   ///< length of the next increment [s]; 0: not yet known
  std::int64_t increments = 0, cuts = 0;                                ///< in this stage
  std::int64_t iterations = 0, linear_iterations = 0, evaluations = 0;  ///< in this stage: of Newton's method, of linear systems, of forces
  std::int64_t last_iterations = 0, last_linear_iterations = 0;         ///< of the last increment
  Real last_residual = 0;                                               ///< of the equations of the last increment, over the loads [-]
  static constexpr auto fields()
  {
    return std::tuple{saved("last_residual", &SolveLedger::last_residual),
                      saved("increment", &SolveLedger::increment),
                      saved("increments", &SolveLedger::increments),
                      saved("cuts", &SolveLedger::cuts),
                      saved("iterations", &SolveLedger::iterations),
                      saved("linear_iterations", &SolveLedger::linear_iterations),
                      saved("evaluations", &SolveLedger::evaluations),
                      saved("last_iterations", &SolveLedger::last_iterations),
                      saved("last_linear_iterations", &SolveLedger::last_linear_iterations)};
  }
};

/// Particles that were split and merged since the start of the run, see solver/particles/resample.hpp.
struct ResampleLedger {
  std::int64_t splits = 0, merges = 0;
  static constexpr auto fields() { return std::tuple{saved("splits", &ResampleLedger::splits), saved("merges", &ResampleLedger::merges)}; }
};

/// Time spent per phase of the step [s], and the number of particle-steps.
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

/// The quantities that are compared with the limits of the run.
struct LimitMonitor {
  Real speed{};                        ///< speed of the fastest particle in the last step [m/s]
  Real fastest{};                      ///< largest speed in any step [m/s]
  Real gain{}, mass{};                 ///< largest values, as in RunLimits
  std::int64_t speeding{}, gaining{};  ///< numbers of steps and of checks of the sums beyond the limit
  std::string failure;                 ///< reason of the last deletion of a failed particle
  static constexpr auto fields()
  {
    return std::tuple{saved("speed", &LimitMonitor::speed),       saved("fastest", &LimitMonitor::fastest),
                      saved("gain", &LimitMonitor::gain),         saved("mass", &LimitMonitor::mass),
                      saved("speeding", &LimitMonitor::speeding), saved("gaining", &LimitMonitor::gaining),
                      saved("failure", &LimitMonitor::failure)};
  }
};

/// The state of a run; a copy is the run at that time.  Saving, sending and comparing use parts().
template <int D>
struct State {
  Clock clock;
  StageState stage;
  EnergyLedger energy;  ///< balance since the beginning of the stage
  MassLedger<D> mass;
  MomentumLedger<D> momentum;
  FlowLedger flow;
  SolveLedger solve;
  ResampleLedger resampling;
  LimitMonitor monitor;
  Timings timings;
  Real residual = 0;  ///< unbalanced force of the nodes over the loads in the last step [-]
  Real crossing = 0;  ///< shortest wave transit time of a cell with particles [s]; the stable step is proportional to it
  BoundaryConditions<D> boundary;
  std::vector<ContactSums<D>> contacts;  ///< impulse and work of each law of contact, then of each cut, since the start of the run
  std::vector<RigidState<D>> rigid;      ///< of each rigid body
  EmptyCellStress<D> empty_cells;        ///< what stages without inertia have left there
  std::vector<Body> bodies;
  std::vector<Material> materials;  ///< one for each body, with the same rows
  Particles<D> particles;

  static constexpr auto parts()
  {
    return std::tuple{saved("clock", &State::clock),
                      saved("stage", &State::stage),
                      saved("energy", &State::energy),
                      saved("mass", &State::mass),
                      saved("momentum", &State::momentum),
                      saved("watched", &State::monitor),
                      saved("flow", &State::flow),
                      saved("solve", &State::solve),
                      saved("resampling", &State::resampling),
                      saved("timings", &State::timings),
                      saved("residual", &State::residual),
                      saved("crossing", &State::crossing),
                      saved("walls", &State::boundary),
                      saved("contacts", &State::contacts),
                      saved("rigid", &State::rigid),
                      saved("bodies", &State::bodies),
                      saved("laws", &State::materials),
                      saved("particles", &State::particles),
                      saved("empty_cells", &State::empty_cells)};
  }
};

/// Calls f(name, part) for each part of a state.
template <class S, class F>
void for_each_part(S& state, F&& f)
{
  constexpr auto parts = std::remove_const_t<S>::parts();
  static_assert(std::tuple_size_v<decltype(parts)> == member_count<std::remove_const_t<S>>(), "a member of State is missing in parts()");
  std::apply([&](const auto&... part) { (f(std::string(part.key), state.*part.member), ...); }, parts);
}

}  // namespace talus
