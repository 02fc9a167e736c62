// talus converge
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

#include "app/commands/converge/converge_command.hpp"
#include "app/commands/converge/converge_numbers.hpp"
#include "app/commands/queue/run_queue.hpp"
#include "app/observers/results.hpp"
#include "core/parallel/communicator.hpp"
#include "core/version.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// Runs the levels that are not done; returns their states.  Throws RunError, Stopped, EnvironmentError.
std::vector<CaseStatus> run_levels(const ConvergeOptions& options, const ConvergePlan& plan)
{
  std::vector<CaseStatus> states;
  std::vector<QueuedRun> queued;
  std::deque<std::size_t> waiting;
  for (const ConvergeLevel& level : plan.levels) {
    states.push_back(status_of(level, plan.quick));
    queued.push_back({level.folder.filename().string(), &level});
  }
  for (std::size_t i = 0; i < states.size(); ++i)
    if (states[i].state != CaseState::done)
      waiting.push_back(i);
  // The finest level takes most of the time: one after the other, each with all cores, is quicker than side by side.
  const SideBySide side = options.jobs ? divide_cores(options.jobs, options.threads, options.launcher.has_value(), waiting.size())
                                       : SideBySide{1, options.threads};
  RunQueue queue({plan.scene, options.launcher, side, plan.quick, options.quiet || options.json}, std::move(queued),
                 [&](std::size_t i) -> const CaseStatus& { return states[i] = status_of(plan.levels[i], plan.quick); });
  queue(std::move(waiting));
  for (std::size_t i = 0; i < states.size(); ++i)
    states[i] = status_of(plan.levels[i], plan.quick);
  std::vector<std::size_t> all(states.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  queue.conclude(all, [&](std::size_t i) -> const CaseStatus& { return states[i]; }, {"levels", "giving the command again"});
  for (std::size_t i = 0; i < states.size(); ++i)
    if (states[i].state != CaseState::done)
      throw EnvironmentError(fmt::format("{} is not done: another process is at work on it", plan.levels[i].folder.string()));
  return states;
}

/// Warnings on the results as a whole.
std::vector<std::string> doubts(const ConvergePlan& plan, const std::vector<CaseStatus>& states)
{
  constexpr Real same_time = 1e-6;
  std::vector<std::string> all = plan.warnings;
  std::vector<std::string> others, times;
  std::vector<Real> ends;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (states[i].summary.commit != version().commit)
      others.push_back(fmt::format("{} by commit {}", plan.levels[i].folder.string(), states[i].summary.commit));
    if (const NamedValue* time = find_number(states[i].summary.numbers, "simulated_time")) {
      ends.push_back(time->value);
      times.push_back(fmt::format("{:.6g}", time->value));
    }
  }
  if (!others.empty())
    all.push_back(fmt::format("this program is of commit {}, but {}: remove these folders to run them again", version().commit,
                              fmt::join(others, ", ")));
  if (!ends.empty() && std::ranges::max(ends) > (1 + same_time) * std::ranges::min(ends))
    all.push_back(
        fmt::format("the levels end at different times, t = {} s: last values are not of the same moment", fmt::join(times, ", ")));
  return all;
}

/// Throws RunError with the numbers whose uncertainty is larger, or unknown.
void require_within(Real limit, const std::vector<ConvergeNumber>& numbers)
{
  std::vector<std::string> beyond;
  for (const ConvergeNumber& number : numbers) {
    const auto relative = number.relative();
    if (number.judged.uncertainty == 0 || (relative && *relative <= limit))
      continue;
    beyond.push_back(relative
                         ? fmt::format("{}: {:.3g} %", number.name, 100 * *relative)
                         : fmt::format("{}: {}", number.name, enum_names(Convergence{})[static_cast<std::size_t>(number.judged.verdict)]));
  }
  if (!beyond.empty())
    throw RunError(fmt::format("not within {:.6g} %: {}", 100 * limit, fmt::join(beyond, "; ")));
}

void warn(const std::vector<std::string>& warnings)
{
  for (const std::string& warning : warnings)
    fmt::print(stderr, "warning: {}\n", warning);
}

}  // namespace

void converge(const ConvergeOptions& options)
{
  if (!world().alone())
    throw Error("talus converge starts runs of its own and is started once: to have each on several ranks, --launcher \"mpirun -n 4\"");
  forget_launch();
  if (options.finer >= options.levels)
    throw Error(
        fmt::format("--finer {} must be below --levels {}: the scene as it is is one of the levels", options.finer, options.levels));
  const ConvergePlan plan = plan_convergence(options);
  if (fs::exists(plan.folder / "summary.json"))
    throw EnvironmentError(fmt::format("{} holds the results of a run: choose another folder with --out", plan.folder.string()));
  const bool tells = !options.quiet && !options.json;
  if (tells || options.list)
    fmt::print("{}: sizes of cells by a ratio of {:.6g}, in {}\n{}", plan.scene.string(), options.ratio, plan.folder.string(),
               print_levels(plan));
  if (options.list)
    return warn(plan.warnings);
  std::error_code said_by_the_lock;
  fs::create_directories(plan.folder, said_by_the_lock);
  const FolderLock lock(plan.folder);
  const std::vector<CaseStatus> states = run_levels(options, plan);
  if (plan.quick)
    return warn({"quick runs end after a number of steps, so at other times for other cells: their numbers are not compared"});
  const std::vector<ConvergeNumber> numbers = numbers_of(plan, options.collect);
  std::vector<std::string> warnings = doubts(plan, states);
  const std::vector<std::string> more = complaints(numbers);
  warnings.insert(warnings.end(), more.begin(), more.end());
  const std::string json = convergence_json(plan, options.ratio, numbers, warnings);
  write_whole(plan.folder / "convergence.csv", convergence_csv(plan, numbers));
  write_whole(plan.folder / "convergence.json", json);
  if (options.json)
    fmt::print("{}", json);
  if (tells)
    fmt::print("{}change: between the two finest levels; +-: grid convergence index; both over the finest value\ntable in {}\n",
               print_numbers(plan, numbers), (plan.folder / "convergence.csv").string());
  std::fflush(stdout);
  warn(warnings);
  if (!more.empty() && tells)
    fmt::print(stderr, "smaller cells may help: --finer {} goes on with the runs that are there\n", options.finer + 1);
  if (options.within)
    require_within(*options.within, numbers);
}

}  // namespace talus
