#pragma once
// Stages, the loop over steps, and what stops it.
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "solver/model/model.hpp"
#include "solver/options/equilibrium_options.hpp"
#include "solver/stress/initial_stress.hpp"

namespace talus {

/// A phase of the analysis.
struct Stage {
  std::string name{};
  std::string kind = "run";  ///< or "geostatic", "static", "quasi_static"
  Real duration{};           ///< [s]
  Real damping{};
  Real ramp{};  ///< [s]
  RampShape ramp_shape = RampShape::linear;
  bool elastic = false;
  std::optional<EquilibriumOptions> equilibrium{};  ///< solved for in each of its steps, without inertia
  std::optional<Real> residual{};                   ///< geostatic: ends when the unbalanced force is below this share of the loads
  std::vector<StartStress> start_stress{};          ///< of each body; empty: they begin with the stress that they have
  std::vector<Index> start_stress_bodies{};         ///< that begin with it, by their numbers; none: all
  bool reset_displacement = false;
  bool holds_pore_pressure = false;
  SourceLocation where;
  /// Whether it ends in equilibrium, or is damped.
  bool seeks_rest() const noexcept { return residual || equilibrium || damping > 0; }
  /// Whether absorbing boundaries hold.
  bool is_at_rest() const noexcept { return residual || equilibrium; }
  /// Whether water flows through pores; else it keeps its pressures.
  bool lets_water_flow() const noexcept { return !is_at_rest() && !holds_pore_pressure; }
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
  SolveLedger solve;                  ///< of a stage that solves for equilibrium
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
                      saved("first_residual", &StageResult::first_residual),
                      saved("solve", &StageResult::solve)};
  }
};

/// What the loop tells whoever watches; the watcher may look at the model and not touch it.  Before a step all is told of the one before:
/// what is kept of the model then is all that the steps to come depend on.  So it is where the run gives up, unless a step itself failed.
enum class RunEvent : std::uint8_t { stage_begins, step_begins, step_done, stage_done, given_up };

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

/// Called before and after each step, at the beginning and at the end of a stage.
template <int D>
struct Watch {
  std::function<void(const Model<D>&, RunEvent)> see;
  /// Whether `see` copies the particles into their columns itself where it reads them, see copy_to_columns().  Otherwise they are there.
  bool copies_particles = false;

  template <class F>
  Watch(F f, bool copies = false)  // NOLINT(google-explicit-constructor): any function that watches
      : see(std::move(f)), copies_particles(copies)
  {}
};

/// Sets the model up for the stage of that number.
template <int D>
void begin_stage(Model<D>& m, const Stage& stage, Index number);

/// The longest step that is stable [s], and in which loads alone move nothing by more than a share of a cell.
template <int D>
Real wanted_step(const Model<D>& m, const StepLimits& limits);

template <int D>
RestConditions rest_conditions(const Model<D>& m, const Stage& stage);
/// Which of the conditions kept a stage from its end, `balanced` being the steps in a row at its end in which all were met.
std::string why_not_at_rest(const RestConditions& state, int balanced, int wanted);

/// Runs the stage that has begun to its end.  RunError naming step, time, particle, body, scene line and place if the state is not valid.
template <int D>
StageResult finish_stage(Model<D>& m, const Stage& stage, const StepLimits& limits, const std::type_identity_t<Watch<D>>& watch);

/// Begins a stage and runs it.
template <int D>
StageResult run_stage(Model<D>& m, const Stage& stage, const StepLimits& limits, const std::type_identity_t<Watch<D>>& watch,
                      Index number = 0);

}  // namespace talus
