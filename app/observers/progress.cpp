#include "app/observers/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "core/display_text.hpp"
#include "core/error.hpp"
#include "core/print.hpp"
#include "io/files/manifest.hpp"

namespace talus {

namespace {

constexpr std::chrono::milliseconds between_bars{200};
constexpr std::chrono::seconds between_lines{5}, between_files{1};
constexpr int bar_width = 30;

/// Renames a file of the user before the first writing.
void make_way(const std::filesystem::path& file, const RunProgress& progress)
try {
  set_aside_unless_proved(file);
  write_progress(file, progress);
  note_result(file, file, Proof::begins);
} catch (const EnvironmentError&) {  // for example a full disk: the next write reports it
}

}  // namespace

Progress::Progress(bool quiet, std::filesystem::path file) : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1), file_(std::move(file))
{}

Progress::~Progress()
{
  if (drawn_ && terminal_)
    say(stderr, "\n");
  std::error_code gone;
  if (written_at_)
    std::filesystem::remove(file_, gone);
}

void Progress::step(Real done, Real total, const Clock& clock, std::string_view stage, Real particle_steps)
{
  const auto now = Watch::now();
  const bool last = done >= total && terminal_ && drawn_;  // so that the bar is full in the end
  const bool draws = !quiet_ && (last || now - drawn_at_ >= (terminal_ ? Watch::duration(between_bars) : Watch::duration(between_lines)));
  const bool writes = !file_.empty() && (!written_at_ || now - *written_at_ >= between_files);
  if (!draws && !writes)
    return;
  now_.done = done, now_.total = total, now_.time = clock.time, now_.dt = clock.dt, now_.step = clock.step;
  now_.stage = stage;
  now_.elapsed = std::chrono::duration<Real>(now - start_).count();
  now_.particle_steps_per_second = now_.elapsed > 0 ? (particle_steps - particle_steps_before_) / now_.elapsed : 0;
  if (writes) {
    if (!written_at_)
      make_way(file_, now_);
    write_progress(file_, now_);
    written_at_ = now;
  }
  if (draws) {
    drawn_at_ = now;
    draw(last);
  }
}

void Progress::draw(bool last)
{
  drawn_ = true;
  const auto left = now_.left();
  const Real share = last ? 1 : now_.share();
  const std::string numbers = fmt::format("{:3.0f} %  t = {:.5g} s  step {}  {:.3g} M particle-steps/s  {} left", 100 * share, now_.time,
                                          now_.step, now_.particle_steps_per_second / 1e6, left ? in_minutes(*left) : "?");
  if (!terminal_)
    return say(stderr, "{}\n", numbers);
  say(stderr, "\r[{}] {}\033[K", bar(share, bar_width), numbers);
}

}  // namespace talus
