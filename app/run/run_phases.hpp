#pragma once
// Wall time of a run by phase, for its summary.
#include <vector>

#include "core/stop_watch.hpp"
#include "io/output/run_summary.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// Wall times [s].  Those of the phases of a step are measured by the solver.
struct RunPhases {
  Real mesh{};            ///< reading or making the mesh, with its tables
  Real seeding{};         ///< particles, boundaries and loads from the scene
  Real kernel{};          ///< tables of the kernel
  Real build{};           ///< the rest of the set-up: checks, locator, memory, a checkpoint that is resumed
  Real first_files{};     ///< mesh, scene and first summary in the folder
  Real initial_stress{};  ///< changes by stages and the stress with which they begin, such as that of K0
  Real steps{};           ///< steps, including what the solver does between its phases
  Real observers{};       ///< output, checkpoints and monitoring
  Real script{};          ///< part of it: start(), step() and end() of the script of the scene
  Real rebalancing{};     ///< redistribution among ranks
  Real end{};             ///< after the last step

  Real total() const noexcept
  {
    return mesh + seeding + kernel + build + first_files + initial_stress + steps + observers + rebalancing + end;
  }
};

/// Adds the time from the last lap to its own end to a phase, also if that is an exception.
class LapAtEnd {
 public:
  LapAtEnd(StopWatch& watch, Real& phase) noexcept : watch_(watch), phase_(phase) {}
  ~LapAtEnd() { watch_.lap(phase_); }
  LapAtEnd(const LapAtEnd&) = delete;
  LapAtEnd& operator=(const LapAtEnd&) = delete;

 private:
  StopWatch& watch_;
  Real& phase_;
};

/// The phases by name.  `in_steps`: measured by the solver in this run; `output` and `checkpoints`: parts of the time of the observers [s].
/// What remains of the total is the work of the solver between its phases and the end of the run.
std::vector<NamedValue> wall_by_phase(const RunPhases& phases, const Timings& in_steps, Real output, Real checkpoints);

}  // namespace talus
