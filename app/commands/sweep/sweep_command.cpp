// talus sweep
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <deque>
#include <map>
#include <numeric>

#include "app/commands/sweep/sweep_command.hpp"
#include "app/commands/sweep/sweep_findings.hpp"
#include "core/parallel/communicator.hpp"
#include "core/version.hpp"
#include "io/scene/reader.hpp"
#include "io/system/signals.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// runs/<name>, with the name of the file, or of the folder of a study.yaml.
fs::path default_sweep_folder(const fs::path& study)
{
  const fs::path folder = fs::absolute(study).lexically_normal().parent_path().filename();
  return fs::path("runs") / (study.filename() == "study.yaml" && !folder.empty() ? folder.string() + "_study" : study.stem().string());
}

/// Runs the cases.
class Sweep {
 public:
  Sweep(const SweepOptions& options, const SweepPlan& plan, const SideBySide& side, SweepTable& table)
      : options_(options), plan_(plan), jobs_(side.jobs), table_(table), runs_(options.launcher, side.threads, plan.quick)
  {}

  /// Runs until all have ended, or a signal asks for the end.
  void operator()(const std::vector<std::size_t>& chosen)
  {
    std::deque<std::size_t> waiting;
    std::ranges::copy_if(chosen, std::back_inserter(waiting), [&](std::size_t i) { return table_.status(i).state != CaseState::done; });
    const StopRequests requests;
    while (runs_.count() > 0 || (!waiting.empty() && StopRequests::received().empty())) {
      while (!waiting.empty() && runs_.count() < jobs_ && StopRequests::received().empty()) {
        start(waiting.front());
        waiting.pop_front();
      }
      if (!StopRequests::received().empty() && !std::exchange(told_to_end_, true))
        runs_.ask_to_end();
      look_after();
    }
    table_.update();
    signal_ = StopRequests::received();
  }

  const std::map<std::size_t, std::string>& failures() const noexcept { return failures_; }
  const std::string& signal() const noexcept { return signal_; }

 private:
  void say(std::size_t i, const std::string& what) const
  {
    if (options_.quiet)
      return;
    fmt::print("case {}: {}\n", plan_.cases[i].number, what);
    std::fflush(stdout);
  }

  void start(std::size_t i)
  {
    const SweepCase& one = plan_.cases[i];
    const CaseStatus status = status_of(one, plan_.quick);  // another process may have run it in the meantime
    if (status.state == CaseState::done)
      return say(i, "is done");
    if (status.state == CaseState::not_ended && is_at_work(one))
      return say(i, "another process is at work on it");
    runs_.start(i, scene_of(plan_.study), one, status);
    say(i, fmt::format("{} ({}{})", status.goes_on_from ? fmt::format("goes on after t = {:.6g} s", *status.goes_on_from) : "begins",
                       in_words(one), remark(status)));
  }
  /// The reason why existing results do not count.
  static std::string remark(const CaseStatus& status)
  {
    const bool without = !status.goes_on_from && (status.state == CaseState::stopped || status.state == CaseState::not_ended);
    if (without)
      return "; what is there has no checkpoint to go on from";
    return status.state == CaseState::to_run && !status.why.empty() ? "; " + status.why : "";
  }

  /// Waits a little; handles runs that have ended.
  void look_after()
  {
    for (const ChildRuns::Ended& ended : runs_.look()) {
      table_.update();
      end_of(ended.number, ended.code, ended.seconds);
    }
  }

  void end_of(std::size_t i, int code, Real seconds)
  {
    const CaseStatus& status = table_.status(i);
    if (code == 0 && status.state == CaseState::done)
      return say(i, fmt::format("done after {:.1f} s", seconds));
    const bool before_its_first_step = runs_.ended_before_its_first_step(code);
    if (code == run_was_stopped || before_its_first_step)
      return say(i, before_its_first_step ? "ended before its first step"
                                          : fmt::format("stopped at t = {:.6g} s", status.goes_on_from.value_or(0)));
    failures_[i] = runs_.why(plan_.cases[i], code, status);
    say(i, "FAILED, see below");
  }

  const SweepOptions& options_;
  const SweepPlan& plan_;
  std::size_t jobs_;
  SweepTable& table_;
  ChildRuns runs_;
  std::map<std::size_t, std::string> failures_;
  bool told_to_end_ = false;
  std::string signal_;
};

/// The cases selected by the options.
std::vector<std::size_t> chosen_cases(const SweepOptions& options, const SweepPlan& plan)
{
  const auto n = static_cast<int>(plan.cases.size());
  if (options.only && *options.only > n)
    throw Error(fmt::format("there is no case {}: {} has {}", *options.only, plan.study.file, n));
  std::vector<std::size_t> chosen(options.only ? 1 : plan.cases.size());
  std::iota(chosen.begin(), chosen.end(), options.only ? static_cast<std::size_t>(*options.only - 1) : 0);
  return chosen;
}

/// Prints remarks below the table.
void print_remarks(const SweepPlan& plan, const SweepTable& table)
{
  std::map<std::string, std::vector<int>> by_other_commit;
  for (std::size_t i = 0; i < plan.cases.size(); ++i)
    if (const CaseStatus& status = table.status(i); status.state == CaseState::done && status.summary.commit != version().commit)
      by_other_commit[status.summary.commit].push_back(plan.cases[i].number);
  for (const auto& [commit, numbers] : by_other_commit)
    fmt::print(stderr, "warning: this program is of commit {}; case {} by commit {}: remove their folders to run them again\n",
               version().commit, fmt::join(numbers, ", "), commit);
  for (const std::string& complaint : table.unknown_names())
    fmt::print(stderr, "warning: {}\n", complaint);
  std::error_code unreadable;
  for (const auto& entry : fs::directory_iterator(plan.folder, unreadable)) {
    const fs::path& place = entry.path();
    const bool of_case = std::ranges::any_of(plan.cases, [&](const SweepCase& one) { return one.folder == place; });
    if (!of_case && fs::is_directory(place, unreadable) && place.filename().string().starts_with("case_"))
      fmt::print(stderr, "warning: {} is of no case of this study\n", place.string());
  }
}

void list_cases(const SweepPlan& plan, const SweepTable& table)
{
  fmt::print("{}", table.print());
  for (std::size_t i = 0; i < plan.cases.size(); ++i) {
    const CaseStatus& status = table.status(i);
    const bool at_work = status.state == CaseState::not_ended && is_at_work(plan.cases[i]);
    if (at_work || !status.why.empty())
      fmt::print("case {}: {}\n", plan.cases[i].number, at_work ? "is running" : status.why);
  }
}

/// Throws RunError or Stopped unless all selected cases are done.
void conclude(const SweepPlan& plan, const Sweep& sweep, const SweepTable& table, const std::vector<std::size_t>& chosen)
{
  const auto count = [&](CaseState state) {
    return std::ranges::count_if(chosen, [&](std::size_t i) { return table.status(i).state == state; });
  };
  if (!sweep.signal().empty() && count(CaseState::done) < std::ssize(chosen))
    throw Stopped(fmt::format("stopped by {}: of {} cases {} done, {} stopped with a checkpoint; go on by running the sweep again",
                              sweep.signal(), chosen.size(), count(CaseState::done), count(CaseState::stopped)));
  if (!sweep.failures().empty()) {
    std::string text = fmt::format("{} of {} cases failed; running the sweep again repeats them", sweep.failures().size(), chosen.size());
    for (const auto& [i, message] : sweep.failures())
      text += fmt::format("\n  case {} ({}): {}", plan.cases[i].number, in_words(plan.cases[i]), message);
    throw RunError(text);
  }
  if (const auto stopped = count(CaseState::stopped); stopped > 0)
    throw Stopped(fmt::format("of {} cases {} done, {} stopped with a checkpoint; go on by running the sweep again", chosen.size(),
                              count(CaseState::done), stopped));
}

}  // namespace

void sweep(const SweepOptions& options)
{
  if (!world().alone())
    throw Error("talus sweep starts runs of its own and is started once: to have each on several ranks, --launcher \"mpirun -n 4\"");
  forget_launch();
  SweepPlan plan = plan_sweep(read_study(options.study), options.out.value_or(default_sweep_folder(options.study)), options.quick);
  if (fs::exists(plan.folder / "summary.json"))
    throw EnvironmentError(fmt::format("{} holds the results of a run: choose another folder with --out", plan.folder.string()));
  const std::vector<std::size_t> chosen = chosen_cases(options, plan);
  check_cases(plan, chosen, options.list ? CheckDepth::mesh : CheckDepth::all);
  SweepTable table(plan);
  if (!options.list || fs::exists(plan.folder))
    table.update();
  const auto find_out = [&](bool pictures) {
    std::vector<std::string> warnings;
    const std::string said = write_findings(plan, table, pictures, warnings);
    if (!options.quiet)
      fmt::print("{}", said);
    for (const std::string& warning : warnings)
      fmt::print(stderr, "warning: {}\n", warning);
  };
  if (options.list) {
    list_cases(plan, table);
    if (fs::exists(plan.folder))
      find_out(false);
    return print_remarks(plan, table);
  }
  const auto left = std::ranges::count_if(chosen, [&](std::size_t i) { return table.status(i).state != CaseState::done; });
  const SideBySide side =
      divide_cores(options.only ? 1 : options.jobs, options.threads, options.launcher.has_value(), static_cast<std::size_t>(left));
  if (!options.quiet)
    fmt::print("{}: {} of {} case{} of {} to be run in {}, {} at a time{}\n", plan.study.file, left, chosen.size(),
               chosen.size() == 1 ? "" : "s", scene_of(plan.study).string(), plan.folder.string(), side.jobs,
               side.threads ? fmt::format(" with {} thread{} each", *side.threads, *side.threads == 1 ? "" : "s") : "");
  Sweep all(options, plan, side, table);
  all(chosen);
  if (!options.quiet)
    fmt::print("{}table in {}\n", table.print(), (plan.folder / "sweep.csv").string());
  find_out(options.pictures && all.signal().empty());
  print_remarks(plan, table);
  conclude(plan, all, table, chosen);
}

}  // namespace talus
