#pragma once
// How many threads a run takes where no number is given, and how threads wait for one another.
#include <optional>

#include "core/types.hpp"

namespace talus {

struct Scene;

/// Particles for each thread from which one more makes the run faster.  Measured: docs/speed.md.
inline constexpr Index particles_of_a_thread = 3000;

/// Threads for so many particles: at least 1, at most `available`.
int threads_that_pay(Index particles, int available) noexcept;

/// Leaves to a run of so many particles, on all ranks together, the threads that pay, of those that it has.  A number that is named stays as it
/// is: `asked` on the command line, `threads` of the scene, or OMP_NUM_THREADS.
void fit_threads(std::optional<int> asked, const Scene& scene, Index particles);

/// Makes threads that wait for others sleep soon.  OpenMP's library lets them spin for milliseconds, which on a machine with other work takes the
/// processor from those that they wait for.  A thousand turns, some ten microseconds, spare most sleeps where there is no other work (docs/speed.md).
/// The library reads the environment when it is loaded, before main(): the program sets GOMP_SPINCOUNT and begins once more in the same process.
/// OMP_WAIT_POLICY and GOMP_SPINCOUNT of the user stay as they are.  To be called first in main(); returns where there is nothing to do, or where
/// the program cannot be begun again.
void let_waiting_threads_sleep_soon(char** arguments) noexcept;

}  // namespace talus
