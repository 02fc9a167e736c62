#pragma once
// How far a run is, on standard error: a bar on a terminal, a line every few seconds elsewhere.
#include <chrono>
#include <cstdint>

#include "core/types.hpp"

namespace talus {

class Progress {
 public:
  /// total: simulated time of all stages [s].
  Progress(Real total, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// A run that goes on has done this much already: rates and the time that is left count from here.
  void resume(Real done, Real particle_steps) noexcept { done_before_ = done, particle_steps_before_ = particle_steps; }
  /// After each step: simulated time that is done, out of the total; the clock of the run; particle steps so far.
  void step(Real done, Real time, std::int64_t steps, Real particle_steps);

 private:
  using Watch = std::chrono::steady_clock;
  Real total_;
  Real done_before_ = 0, particle_steps_before_ = 0;
  bool quiet_, terminal_;
  bool drawn_ = false;
  Watch::time_point start_ = Watch::now(), last_ = start_;
};

}  // namespace talus
