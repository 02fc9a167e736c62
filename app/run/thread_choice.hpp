#pragma once
// How many threads a run takes where no number is given, and how threads wait for one another.
#include <cstdint>
#include <optional>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct Scene;

/// Particles for each thread from which one more makes the run faster.  Measured: docs/development/speed.md.
inline constexpr Index particles_of_a_thread = 3000;

/// Threads for so many particles: at least 1, at most `available`.
int threads_that_pay(Index particles, int available) noexcept;

/// How many threads each step takes.  What pays depends on what else the machine does, so now and then some steps are made with half as many and
/// with twice as many in turn, and the number with which a step takes the least time is kept.  Results do not depend on it.
class ThreadChoice {
 public:
  /// As many as there are now, for good.
  ThreadChoice();
  /// `first` to begin with; at least `least`, at most `most`.
  ThreadChoice(int first, int least, int most);
  int saved() const noexcept { return kept_; }
  /// For the step that begins.
  int next() const noexcept { return trying_ ? tried_[turn_ % tried_.size()] : kept_; }
  /// How long it took [s].
  void took(Real seconds);

 private:
  void begin_trial();
  void end_trial();

  int kept_, least_, most_;
  bool trying_ = false;
  std::int64_t since_ = 0;               // steps since the last trial
  std::size_t turn_ = 0;                 // of the trial
  std::vector<int> tried_;               // kept_ first
  std::vector<std::vector<Real>> took_;  // by number tried [s]
};

/// The threads of a run of so many particles, on all ranks together: to begin with, those that pay on a machine with other work, of those that it
/// has.  A number that is named stays as it is: `asked` on the command line, `threads` of the scene, or OMP_NUM_THREADS.  So does that of ranks, which
/// wait for each other.
ThreadChoice fit_threads(std::optional<int> asked, const Scene& scene, Index particles);

/// Makes threads that wait for others sleep soon.  OpenMP's library lets them spin for milliseconds, which on a machine with other work takes the
/// processor from those that they wait for.  A thousand turns, some ten microseconds, spare most sleeps where there is no other work (docs/development/speed.md).
/// The library reads the environment when it is loaded, before main(): the program sets GOMP_SPINCOUNT and begins once more in the same process.
/// OMP_WAIT_POLICY and GOMP_SPINCOUNT of the user stay as they are.  To be called first in main(); returns where there is nothing to do, or where
/// the program cannot be begun again.
void let_waiting_threads_sleep_soon(char** arguments) noexcept;

}  // namespace talus
