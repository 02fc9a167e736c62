#pragma once
// Wall time of the phases of a step.
#include <chrono>

#include "core/types.hpp"

namespace talus {

/// Adds the time since the last call to a phase.
class StopWatch {
 public:
  void lap(Real& phase) noexcept
  {
    const auto now = Clock::now();
    phase += std::chrono::duration<Real>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace talus
