// POSIX signals.  A handler may do next to nothing: it stores the number.
#include "io/system/signals.hpp"

#include <array>
#include <csignal>

#include "io/system/law_crash.hpp"

namespace talus {

namespace {

constexpr std::array<int, 3> stop_signals{SIGTERM, SIGINT, SIGUSR1};
volatile std::sig_atomic_t noted = 0;

extern "C" void note(int number)
{
  if (number == SIGINT && noted == SIGINT) {
    write_law_at_work(SIGINT);
    std::signal(SIGINT, SIG_DFL);
    std::raise(SIGINT);
  }
  noted = number;
}

}  // namespace

StopRequests::StopRequests()
{
  noted = 0;
  for (const int number : stop_signals)
    std::signal(number, note);
}

StopRequests::~StopRequests()
{
  for (const int number : stop_signals)
    std::signal(number, noted != 0 ? SIG_IGN : SIG_DFL);  // a program that was told to stop is about to end
}

std::string StopRequests::received()
{
  switch (noted) {
    case 0: return "";
    case SIGTERM: return "SIGTERM";
    case SIGINT: return "SIGINT";
    default: return "SIGUSR1";
  }
}

}  // namespace talus
