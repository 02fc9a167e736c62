// Floating-point traps of the C library.  Each thread has its own setting.
#include "io/system/traps.hpp"

#include <execinfo.h>
#include <unistd.h>

#include <array>
#include <cfenv>
#include <csignal>
#include <string_view>

#include "core/parallel/threads.hpp"

namespace talus {

namespace {

constexpr bool wanted = TALUS_TRAPS;
constexpr int trapped = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;

std::string_view words(int code) noexcept
{
  switch (code) {
    case FPE_FLTDIV: return "a division by zero";
    case FPE_FLTOVF: return "an overflow";
    case FPE_FLTINV: return "an invalid operation (0/0, inf - inf, the root of a negative number, a comparison with NaN)";
    default: return "an operation that cannot be done";
  }
}

void say(std::string_view text) noexcept { [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size()); }

// A handler may call very few functions: these write to the descriptor and allocate nothing.
extern "C" void tell_and_die(int, siginfo_t* signal, void*)
{
  say("floating-point trap: ");
  say(words(signal->si_code));
  say("; lines of the sources: addr2line -Cfipe PROGRAM ADDRESS\n");
  std::array<void*, 32> frames{};
  ::backtrace_symbols_fd(frames.data(), ::backtrace(frames.data(), static_cast<int>(frames.size())), STDERR_FILENO);
}

/// Calls f(i) on thread i.
template <class F>
void on_every_thread(F&& f)
{
  parallel_for(threads(), [&](Index) { f(); });
}

}  // namespace

FloatingPointTraps::FloatingPointTraps()
{
  if constexpr (wanted) {
    std::array<void*, 1> first_frame{};
    ::backtrace(first_frame.data(), 1);  // loads its library now, which the handler must not do
    struct sigaction action {};
    action.sa_sigaction = tell_and_die;
    action.sa_flags = SA_SIGINFO | static_cast<int>(SA_RESETHAND);  // the operation is repeated and then ends the process
    ::sigaction(SIGFPE, &action, nullptr);
    on_every_thread([] {
      std::feclearexcept(FE_ALL_EXCEPT);  // clears the exceptions raised so far
      ::feenableexcept(trapped);
    });
  }
}

FloatingPointTraps::~FloatingPointTraps()
{
  if constexpr (wanted)
    on_every_thread([] { ::fedisableexcept(trapped); });
}

TrapsPaused::TrapsPaused()
{
  if constexpr (wanted)
    were_ = ::fedisableexcept(trapped);
}

TrapsPaused::~TrapsPaused()
{
  if constexpr (wanted) {
    std::feclearexcept(FE_ALL_EXCEPT);
    ::feenableexcept(were_);
  }
}

}  // namespace talus
