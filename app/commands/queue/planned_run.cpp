#include "app/commands/queue/planned_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <sstream>
#include <thread>

#include "app/observers/checkpoints.hpp"
#include "app/observers/results.hpp"
#include "app/run/summary.hpp"
#include "core/display_text.hpp"
#include "core/parallel/threads.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/file_descriptor.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// The time of the newest checkpoint of this run [s]; nothing if there is none.
std::optional<Real> time_kept(const PlannedRun& run, bool quick)
{
  try {
    const CheckpointList saved(run.folder);
    const RunIdentity& identity = saved.identity();
    const bool same_mesh = run.mesh_digest.empty() || digest_text(static_cast<std::uint64_t>(identity.mesh)) == run.mesh_digest;
    if (identity.quick == quick && identity.set == run.changes && same_mesh)
      return saved.clock().time;
  } catch (const EnvironmentError&) {
  }
  return std::nullopt;
}

std::vector<std::string> split_at_blanks(const std::string& text)
{
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;)
    words.push_back(word);
  return words;
}

fs::path log_of(const PlannedRun& run) { return run.folder.string() + ".log"; }

/// The end of the output of a run.
std::string last_lines(const fs::path& log)
{
  constexpr std::ptrdiff_t most = 12;
  std::istringstream stream(read_whole(log));
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  if (std::ssize(lines) > most)
    lines.erase(lines.begin(), lines.end() - most);
  return fmt::format("{}", fmt::join(lines, "\n    "));
}

}  // namespace

CaseStatus status_of(const PlannedRun& run, bool quick)
{
  CaseStatus status;
  const fs::path file = run.folder / "summary.json";
  if (std::error_code unknown; !fs::exists(file, unknown))
    return status;
  try {
    status.summary = read_summary(file);
  } catch (const EnvironmentError& e) {
    status.why = e.what();
    return status;
  }
  const SummaryBack& summary = status.summary;
  const bool ended = summary.status == "done";
  const bool same_scene = summary.scene_digest == run.scene_digest;
  const bool same_mesh = run.mesh_digest.empty() || summary.mesh_digest == run.mesh_digest;
  if (!same_scene || !same_mesh || (ended && summary.quick != quick)) {
    status.why = !same_scene  ? "its results are of another scene or of other changes"
                 : !same_mesh ? "its results are of another mesh"
                 : quick      ? "its results are not of a quick run"
                              : "its results are of a quick run";
    status.summary = {};
    return status;
  }
  if (ended) {
    status.state = CaseState::done;
  } else if (summary.status == "stopped" || summary.message == message_before_the_end) {
    status.state = summary.status == "stopped" ? CaseState::stopped : CaseState::not_ended;
    status.goes_on_from = time_kept(run, quick);
  } else {
    status.state = CaseState::failed;
    status.why = summary.message;
  }
  return status;
}

bool is_at_work(const PlannedRun& run)
{
  try {
    const FolderLock mine(run.folder);
    return false;
  } catch (const EnvironmentError&) {
    return true;
  }
}

std::string in_words(const PlannedRun& run) { return fmt::format("{}", fmt::join(run.changes, ", ")); }

std::string command_of(const fs::path& scene, const PlannedRun& run, bool quick)
{
  std::string command = fmt::format("talus run {} --out {}{}", shell_word(scene), shell_word(run.folder), quick ? " --quick" : "");
  for (const std::string& change : run.changes)
    command += " --set " + shell_word(change);
  return command;
}

SideBySide divide_cores(std::optional<int> jobs, std::optional<int> threads, bool has_launcher, std::size_t n_runs)
{
  const int cores = std::max(1, talus::threads());
  const int side_by_side = jobs.value_or(std::max(1, std::min(static_cast<int>(n_runs), cores / threads.value_or(1))));
  SideBySide side{static_cast<std::size_t>(side_by_side), threads};
  if (!threads && !has_launcher)
    side.threads = std::max(1, cores / side_by_side);
  return side;
}

void ChildRuns::start(std::size_t number, const fs::path& scene, const PlannedRun& run, const CaseStatus& status)
{
  std::vector<std::string> words = split_at_blanks(launcher_.value_or(""));
  words.insert(words.end(), {fs::read_symlink("/proc/self/exe").string(), "run"});
  if (status.goes_on_from) {
    words.insert(words.end(), {"--resume", run.folder.string()});
  } else {
    words.insert(words.end(), {scene.string(), "--out", run.folder.string(), "--force"});
    for (const std::string& change : run.changes)
      words.insert(words.end(), {"--set", change});
    if (quick_)
      words.emplace_back("--quick");
  }
  words.emplace_back("--quiet");
  if (threads_)
    words.insert(words.end(), {"--threads", std::to_string(*threads_)});
  const FileDescriptor log(log_of(run), O_WRONLY | O_CREAT | O_TRUNC);
  if (!log.is_open())
    throw EnvironmentError(fmt::format("cannot write {}: {}", log_of(run).string(), std::strerror(errno)));
  running_.push_back({number, ChildProcess(std::move(words), log.number()), std::chrono::steady_clock::now()});
}

std::vector<ChildRuns::Ended> ChildRuns::look()
{
  constexpr std::chrono::milliseconds a_little{30};
  std::this_thread::sleep_for(a_little);
  std::vector<Ended> all;
  for (std::size_t k = 0; k < running_.size();) {
    const auto code = running_[k].process.ended();
    if (!code) {
      ++k;
      continue;
    }
    const auto seconds = std::chrono::duration<Real>(std::chrono::steady_clock::now() - running_[k].begun).count();
    all.push_back({running_[k].number, *code, seconds});
    running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(k));
  }
  return all;
}

void ChildRuns::ask_to_end()
{
  told_to_end_ = true;
  for (const Running& run : running_)
    run.process.ask_to_end();
}

bool ChildRuns::ended_before_its_first_step(int code) const noexcept
{
  return told_to_end_ && (code == ChildProcess::of_signal + SIGTERM || code == ChildProcess::of_signal + SIGINT);
}

std::string ChildRuns::why(const PlannedRun& run, int code, const CaseStatus& status) const
{
  if (code == 0)
    return fmt::format("it ran to its end, but {}: was the scene changed meanwhile?",
                       status.why.empty() ? "its summary says otherwise" : status.why);
  if (status.state == CaseState::failed)
    return status.why;
  if (code > ChildProcess::of_signal)
    return fmt::format("ended by signal {}{}{}", code - ChildProcess::of_signal,
                       code == ChildProcess::of_signal + SIGKILL ? " (where memory runs out the system kills; --jobs 1 needs less)" : "",
                       status.goes_on_from ? "; it goes on from its last checkpoint when the command is given again" : "");
  const std::string said = last_lines(log_of(run));
  if (code == ChildProcess::not_started)
    return fmt::format("cannot be started{}{}", launcher_ ? ": is there no " + *launcher_ + "?" : "", said.empty() ? "" : "\n    " + said);
  return said.empty() ? fmt::format("ended with {}", code) : said;
}

}  // namespace talus
