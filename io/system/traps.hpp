#pragma once
// The end of the program at the first operation without a finite result, in builds that look for such (preset traps).

namespace talus {

/// While this lives, an operation that is invalid, divides by zero or overflows ends the process by SIGFPE, on every thread, after saying which and
/// where.  Does nothing in a build without TALUS_TRAPS.
class FloatingPointTraps {
 public:
  FloatingPointTraps();
  ~FloatingPointTraps();
  FloatingPointTraps(const FloatingPointTraps&) = delete;
  FloatingPointTraps& operator=(const FloatingPointTraps&) = delete;
};

/// While this lives, nothing ends the process on this thread: for libraries that compare with NaN and mean it.
class TrapsPaused {
 public:
  TrapsPaused();
  ~TrapsPaused();
  TrapsPaused(const TrapsPaused&) = delete;
  TrapsPaused& operator=(const TrapsPaused&) = delete;

 private:
  int were_ = 0;  // exceptions that are signals otherwise
};

}  // namespace talus
