#include "app/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace talus {

namespace {

constexpr std::chrono::milliseconds between_bars{200};
constexpr std::chrono::seconds between_lines{5};
constexpr int bar_width = 30;

std::string duration(Real seconds)
{
  const auto s = static_cast<std::int64_t>(std::lround(seconds));
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60) : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

}  // namespace

Progress::Progress(Real total, bool quiet) : total_(total), quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress()
{
  if (drawn_ && terminal_)
    fmt::print(stderr, "\n");
}

void Progress::step(Real done, Real time, std::int64_t steps, Real particle_steps)
{
  const auto now = Watch::now();
  const Real share = std::clamp(done / total_, Real{0}, Real{1});
  const bool last = share >= 1 && terminal_ && drawn_;  // so that the bar is full in the end
  if (quiet_ || (!last && now - last_ < (terminal_ ? Watch::duration(between_bars) : Watch::duration(between_lines))))
    return;
  last_ = now;
  drawn_ = true;
  const Real elapsed = std::chrono::duration<Real>(now - start_).count();
  const Real share_now = share - done_before_ / total_;  // what was done since this began
  const std::string left = share_now > 0 ? duration(elapsed * (1 - share) / share_now) : "?";
  const std::string numbers = fmt::format("{:3.0f} %  t = {:.5g} s  step {}  {:.3g} M particle-steps/s  {} left", 100 * share, time, steps,
                                          (particle_steps - particle_steps_before_) / elapsed / 1e6, left);
  if (!terminal_)
    return fmt::print(stderr, "{}\n", numbers);
  const auto full = static_cast<std::size_t>(share * bar_width);
  fmt::print(stderr, "\r[{}{}] {}\033[K", std::string(full, '#'), std::string(bar_width - full, ' '), numbers);
}

}  // namespace talus
