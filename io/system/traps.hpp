#pragma once
// Ends the program at the first operation without a finite result, in builds for that purpose (preset traps).

namespace talus {

/// While it exists, an operation that is invalid, divides by zero or overflows ends the process by SIGFPE, on every thread, after a message
/// with kind and place.  Does nothing in a build without TALUS_TRAPS.
class FloatingPointTraps {
 public:
  FloatingPointTraps();
  ~FloatingPointTraps();
  FloatingPointTraps(const FloatingPointTraps&) = delete;
  FloatingPointTraps& operator=(const FloatingPointTraps&) = delete;
};

/// While it exists, no trap ends the process on this thread, for libraries that compute with NaN on purpose.
class TrapsPaused {
 public:
  TrapsPaused();
  ~TrapsPaused();
  TrapsPaused(const TrapsPaused&) = delete;
  TrapsPaused& operator=(const TrapsPaused&) = delete;

 private:
  int were_ = 0;  // exceptions that were enabled before
};

}  // namespace talus
