#include "app/commands/watch/watch_look.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/observers/results.hpp"
#include "core/display_text.hpp"
#include "core/error.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr int bar_letters = 40;
constexpr std::size_t shown_pictures = 3;

/// The PNG files of pictures/, the newest first.
std::vector<fs::path> pictures_in(const fs::path& folder)
{
  std::vector<std::pair<fs::file_time_type, fs::path>> found;
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator(folder / "pictures", gone))
    if (entry.path().extension() == ".png")
      found.emplace_back(entry.last_write_time(gone), entry.path());
  std::sort(found.rbegin(), found.rend());
  std::vector<fs::path> pictures;
  for (auto& [time, file] : found)
    pictures.push_back(std::move(file));
  return pictures;
}

std::string state_in_words(RunState state)
{
  switch (state) {
    case RunState::at_work: return "at work";
    case RunState::done: return "done";
    case RunState::failed: return "failed";
    case RunState::stopped: return "stopped";
    case RunState::killed: break;
  }
  return "killed";
}

/// The last value of a column, if it exists.
std::optional<Real> last_of(const HistoryTable& history, std::string_view column)
{
  const auto values = history[column];
  return values && !values->empty() ? std::optional(values->back()) : std::nullopt;
}

/// The progress of a run: from progress.json while it is at work, otherwise from its outputs.
std::string how_far(const RunLook& look)
{
  if (const auto& p = look.progress) {
    const auto left = p->left();
    return fmt::format("[{}] {:.0f} %  t = {:.5g} s, {:.5g} of {:.5g} s done{}", bar(p->share(), bar_letters), 100 * p->share(), p->time,
                       p->done, p->total, left && look.state == RunState::at_work ? fmt::format(", {} left", in_minutes(*left)) : "");
  }
  if (const auto time = last_of(look.history, "time"))
    return fmt::format("t = {:.6g} s", *time);
  if (!look.files.frames.empty())
    return fmt::format("t = {:.6g} s", look.files.frames.back().first);
  return "";
}

std::string pace(const RunLook& look)
{
  if (const auto& p = look.progress)
    return fmt::format("step {}, dt = {:.3g} s, {:.3g} M particle-steps/s, stage \"{}\", at it for {}", p->step, p->dt,
                       p->particle_steps_per_second / 1e6, p->stage, in_minutes(p->elapsed));
  if (const auto step = last_of(look.history, "step"))
    return fmt::format("step {:.0f}, dt = {:.3g} s", *step, last_of(look.history, "dt").value_or(0));
  return "";
}

/// The energy terms that are not zero, and the relative error of the balance.
std::string energies(const HistoryTable& history)
{
  std::string text;
  Real largest = 0;
  for (const char* term :
       {"kinetic", "strain", "plastic", "friction", "damping", "carried_away", "gravity_work", "load_work", "wall_work", "transfer_loss"})
    if (const auto value = last_of(history, term); value && *value != 0) {
      text += fmt::format("{}{} {:.4g}", text.empty() ? "" : ", ", term, *value);
      largest = std::max(largest, std::abs(*value));
    }
  if (const auto defect = last_of(history, "energy_defect"); defect && largest > 0)
    text += fmt::format("; defect {:.2g} of the largest", std::abs(*defect) / largest);
  return text;
}

std::string momentum(const HistoryTable& history)
{
  std::string text;
  for (const char* component : {"momentum_x", "momentum_y", "momentum_z"})
    if (const auto value = last_of(history, component))
      text += fmt::format("{}{:.4g}", text.empty() ? "" : ", ", *value);
  if (const auto mass = last_of(history, "mass"))
    text += fmt::format("; mass {:.6g} kg", *mass);
  return text;
}

std::string labelled(std::string_view label, const std::string& text) { return fmt::format("{:<19}{}", label, text); }

}  // namespace

RunLook look_at(const RunFolder& run, const RunLook& before)
{
  RunLook look;
  look.state = state_of_run(run.path, run.summary);
  look.progress = read_progress(run.path / progress_file);
  look.files.pictures = pictures_in(run.path);
  const std::string history = state_of(run.path / "history.csv"), frames = state_of(run.path / "particles.pvd");
  look.marks = history + ' ' + frames + ' ' + state_of(run.path / "summary.json");
  for (const fs::path& picture : look.files.pictures)
    look.marks += ' ' + state_of(picture);
  if (look.marks == before.marks) {
    look.history = before.history;
    look.files.frames = before.files.frames;
    look.left_out = before.left_out;
    return look;
  }
  const auto attempt = [&](auto&& read) {
    try {
      read();
    } catch (const EnvironmentError& damaged) {
      look.left_out.emplace_back(damaged.what());
    }
  };
  if (!history.empty())
    attempt([&] { look.history = read_history(run.path / "history.csv"); });
  if (!frames.empty())
    attempt([&] { look.files.frames = read_pvd(run.path / "particles.pvd"); });
  return look;
}

std::vector<std::string> described(const RunFolder& run, const RunLook& look)
{
  std::vector<std::string> lines{run.scene.title, labelled(state_in_words(look.state), how_far(look))};
  const auto add = [&](std::string_view label, const std::string& text) {
    if (!text.empty())
      lines.push_back(labelled(label, text));
  };
  if (look.state != RunState::at_work && look.state != RunState::killed)
    add("", run.summary.message);
  if (look.state == RunState::killed)
    add("", "its process has ended without a message");
  add("", pace(look));
  add("energy [J]", energies(look.history));
  add("momentum [kg m/s]", momentum(look.history));
  for (const std::string& warning : run.summary.warnings)
    add("warning", warning);
  for (const std::string& file : look.left_out)
    add("left out", file);
  if (const auto& frames = look.files.frames; !frames.empty())
    add("frames",
        fmt::format("{}, the last {} at t = {:.6g} s", frames.size(), frames.back().second.filename().string(), frames.back().first));
  for (std::size_t i = 0; i < std::min(shown_pictures, look.files.pictures.size()); ++i)
    add(i == 0 ? "pictures" : "", look.files.pictures[i].string());
  return lines;
}

std::string in_one_line(const RunFolder&, const RunLook& look)
{
  std::string text = state_in_words(look.state);
  if (const auto& p = look.progress)
    text += fmt::format("  {:3.0f} %  t = {:.5g} s  step {}  {:.3g} M particle-steps/s{}", 100 * p->share(), p->time, p->step,
                        p->particle_steps_per_second / 1e6, p->left() ? fmt::format("  {} left", in_minutes(*p->left())) : "");
  else
    text += "  " + how_far(look);
  if (!look.files.frames.empty())
    text += fmt::format("  {} frames", look.files.frames.size());
  return text;
}

}  // namespace talus
