#pragma once
// The number of threads of a run, if none is given, and the waiting of threads.
#include <cstdint>
#include <optional>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct Scene;

/// Particles per thread from which one more thread makes the run faster.  Measured: docs/development/speed.md.
inline constexpr Index particles_of_a_thread = 3000;

/// The number of threads for a number of particles: at least 1, at most `available`.
int threads_that_pay(Index particles, int available) noexcept;

/// Chooses the number of threads of each step.  The best number depends on the other work of the machine, so in intervals some steps are
/// made with half and with twice as many threads in turn, and the fastest number is kept.  Results do not depend on it.
class ThreadChoice {
 public:
  /// The present number of threads, constant.
  ThreadChoice();
  /// `first` at the beginning; at least `least`, at most `most`.
  ThreadChoice(int first, int least, int most);
  int chosen() const noexcept { return kept_; }
  /// The number for the next step.
  int next() const noexcept { return trying_ ? tried_[turn_ % tried_.size()] : kept_; }
  /// Records the duration of a step [s].
  void took(Real seconds);

 private:
  void begin_trial();
  void end_trial();

  int kept_, least_, most_;
  bool trying_ = false;
  std::int64_t since_ = 0;               // steps since the last trial
  std::size_t turn_ = 0;                 // step of the trial
  std::vector<int> tried_;               // kept_ first
  std::vector<std::vector<Real>> took_;  // durations by number of threads [s]
};

/// The threads of a run with this number of particles, over all ranks: at the beginning, those that pay on a machine with other work, among
/// the available ones.  A given number is constant: `asked` on the command line, `threads` of the scene, or OMP_NUM_THREADS.  It is
/// constant for several ranks too, as they wait for each other.
ThreadChoice fit_threads(std::optional<int> asked, const Scene& scene, Index particles);

/// Makes waiting threads sleep soon.  OpenMP's library by default lets them spin for milliseconds, which on a machine with other work takes
/// the processor from the threads that they wait for.  A thousand turns, some ten microseconds, avoid most sleeps where there is no other
/// work (docs/development/speed.md).  The library reads the environment when it is loaded, before main(): the program sets GOMP_SPINCOUNT
/// and restarts itself in the same process.  OMP_WAIT_POLICY and GOMP_SPINCOUNT of the user are respected.  To be called first in main();
/// returns if there is nothing to do, or if the program cannot be restarted.
void let_waiting_threads_sleep_soon(char** arguments) noexcept;

}  // namespace talus
