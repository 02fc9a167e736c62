// talus fos
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <deque>

#include "app/commands/fos/fos_command.hpp"
#include "app/commands/fos/fos_pictures.hpp"
#include "app/commands/fos/fos_trials.hpp"
#include "app/observers/results.hpp"
#include "core/parallel/communicator.hpp"
#include "core/version.hpp"
#include "io/files/atomic_file.hpp"
#include "io/output/csv.hpp"
#include "io/output/fos_json.hpp"
#include "io/system/signals.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// A trial without a clear verdict is repeated with its duration multiplied by this factor.
constexpr int longest_trial = 2;

/// Default limit of simultaneous trials: n trials divide the bracket by n + 1, so more of them save little time.
constexpr std::size_t most_at_a_time = 4;

/// The search in its folder: runs, verdicts, files.
class FosSearch {
 public:
  FosSearch(const FosOptions& options, const FosPlan& plan)
      : options_(options),
        plan_(plan),
        side_(divide_cores(options.jobs, options.threads, options.launcher.has_value(), most_at_a_time)),
        runs_(options.launcher, side_.threads, plan.quick),
        broken_off_(broken_off(plan.folder / "fos.json"))
  {}

  /// Runs the search.  Throws RunError, Stopped, EnvironmentError.
  void operator()()
  {
    find_rest();
    look_for_trials();
    const StopRequests requests;
    std::vector<Real> next = next_factors(trials_, options_.range, side_.jobs);
    while (!next.empty()) {
      try_factors(next);
      write_files();
      next = next_factors(trials_, options_.range, side_.jobs);
    }
  }

  const std::vector<FosTrial>& trials() const noexcept { return trials_; }
  Bracket bracket() const { return bracket_of(trials_); }

  std::string table() const
  {
    std::string text =
        fmt::format("{:>10}  {:<8} {:>9} {:>13} {:>11} {:>9}\n", "factor", "verdict", "growth", second_measure(), "moved [m]", "time [s]");
    for (const FosTrial& trial : trials_) {
      text += fmt::format("{:>10.6g}  {:<8} ", trial.factor, word_of(trial));
      text += trial.motion ? fmt::format("{:>9.3g} {:>13} {:>11.4g} {:>9.4g}", trial.motion->growth, second_of(*trial.motion),
                                         trial.motion->moved, trial.motion->duration)
                           : fmt::format("{:>9} {:>13} {:>11} {:>9}", "-", "-", "-", "-");
      if (trial.by_growth_alone)
        text += "  by growth alone: the measures contradict each other";
      if (!trial.message.empty())
        text += "  the run broke off: " + trial.message.substr(0, trial.message.find('\n'));
      text += '\n';
    }
    return text;
  }

  void write_files() const
  {
    const auto [low, high, out_of_order] = bracket();
    FosRecord record{.scene = plan_.scene.string(),
                     .commit = std::string(version().commit),
                     .factor = {},
                     .low = low,
                     .high = high,
                     .out_of_order = out_of_order,
                     .width = options_.range.width,
                     .growth_limit = plan_.criterion.growth,
                     .liveliness_limit = plan_.criterion.liveliness,
                     .steadiness_limit = plan_.criterion.steadiness,
                     .settlement = plan_.before.settlement(),
                     .height = plan_.before.height,
                     .bodies = plan_.bodies,
                     .trials = {}};
    if (is_narrow())
      record.factor = (*low + *high) / 2;
    std::string csv = "factor,verdict,moved [m],growth,kinetic_over_peak,duration [s],by_growth_alone,steadiness,message\n";
    for (const FosTrial& trial : trials_) {
      const Planned& planned = planned_of(trial);
      FosTrialRecord row{.factor = trial.factor,
                         .verdict = std::string(word_of(trial)),
                         .message = trial.message,
                         .moved = {},
                         .growth = {},
                         .liveliness = {},
                         .steadiness = {},
                         .duration = {},
                         .by_growth_alone = trial.by_growth_alone,
                         .folder = planned.run.folder.filename().string(),
                         .command = command_of(plan_.scene, planned.run, plan_.quick),
                         .scene_digest = planned.run.scene_digest};
      if (trial.motion) {
        row.moved = trial.motion->moved, row.growth = trial.motion->growth;
        row.liveliness = trial.motion->liveliness, row.steadiness = trial.motion->steadiness, row.duration = trial.motion->duration;
      }
      const auto cell = [](const std::optional<Real>& value) { return value ? fmt::format("{}", *value) : std::string(); };
      csv += fmt::format("{},{},{},{},{},{},{},{},{}\n", trial.factor, row.verdict, cell(row.moved), cell(row.growth), cell(row.liveliness),
                         cell(row.duration), trial.by_growth_alone ? 1 : 0, cell(row.steadiness), csv_cell(trial.message));
      record.trials.push_back(std::move(row));
    }
    write_whole(plan_.folder / "fos.csv", csv);
    write_fos(plan_.folder / "fos.json", record);
  }

  bool is_narrow() const
  {
    const auto [low, high, out_of_order] = bracket();
    return low && high && *high - *low <= options_.range.width * (1 + 1e-9);
  }

 private:
  /// A factor to run, and its duration relative to the usual one.
  struct Planned {
    Real factor;
    int times;
    PlannedRun run;
  };

  static std::string_view word_of(const FosTrial& trial) { return enum_names(Verdict{})[static_cast<std::size_t>(trial.verdict)]; }

  const char* second_measure() const { return plan_.trials == TrialKind::equilibrium ? "steadiness" : "kinetic/peak"; }
  static std::string second_of(const Motion& motion)
  {
    return motion.liveliness ? fmt::format("{:.2e}", *motion.liveliness) : fmt::format("{:.3g}", motion.steadiness.value_or(0));
  }

  void say(const std::string& what) const
  {
    if (options_.quiet)
      return;
    fmt::print("{}\n", what);
    std::fflush(stdout);
  }

  const Planned& planned_of(const FosTrial& trial) const { return *std::ranges::find(made_, trial.factor, &Planned::factor); }

  [[noreturn]] void stopped() const
  {
    throw Stopped(
        fmt::format("stopped by {}: {} trials are judged; go on by giving the command again", StopRequests::received(), trials_.size()));
  }

  /// Waits for the runs in progress; calls end(number, code, seconds) for each.
  template <class F>
  void wait(F&& end)
  {
    bool told = false;
    while (runs_.count() > 0) {
      if (!StopRequests::received().empty() && !std::exchange(told, true))
        runs_.ask_to_end();
      for (const ChildRuns::Ended& ended : runs_.look())
        end(ended);
    }
    if (!StopRequests::received().empty())
      stopped();
  }

  void find_rest()
  {
    const StopRequests requests;
    const CaseStatus status = status_of(plan_.at_rest, plan_.quick);
    if (status.state == CaseState::done)
      return say(fmt::format("at rest: done before, in {}", plan_.at_rest.folder.string()));
    say(fmt::format("at rest: {} in {}", status.goes_on_from ? "goes on" : "begins", plan_.at_rest.folder.string()));
    // Alone, so with all cores.
    ChildRuns alone(options_.launcher, options_.threads, plan_.quick);
    std::swap(alone, runs_);
    runs_.start(0, plan_.scene, plan_.at_rest, status);
    wait([&](const ChildRuns::Ended& ended) {
      const CaseStatus now = status_of(plan_.at_rest, plan_.quick);
      if (ended.code == 0 && now.state == CaseState::done)
        return say(fmt::format("at rest: done after {:.1f} s", ended.seconds));
      refuse_stopped(ended.code);
      throw_why(ended.code, fmt::format("the state at rest was not found: {}", runs_.why(plan_.at_rest, ended.code, now)));
    });
    std::swap(alone, runs_);
  }

  static void refuse_stopped(int code)
  {
    if (code == run_was_stopped && StopRequests::received().empty())
      throw Stopped("a run was told to stop; go on by giving the command again");
  }
  /// Throws the error of a run, except for runs that were told to end.
  static void throw_why(int code, const std::string& message)
  {
    if (!StopRequests::received().empty())
      return;
    if (code == run_failed)
      throw RunError(message);
    throw EnvironmentError(message);
  }

  /// Reads the trials of an earlier search.
  void look_for_trials()
  {
    std::vector<Real> factors;
    std::error_code unreadable;
    for (const auto& entry : fs::directory_iterator(plan_.folder, unreadable)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("trial_") && fs::exists(entry.path() / "summary.json", unreadable))
        try {
          factors.push_back(std::stod(name.substr(std::string_view("trial_").size())));
        } catch (const std::logic_error&) {  // a folder that is not one of this search
        }
    }
    std::ranges::sort(factors);
    for (const Real factor : factors)
      for (int times = longest_trial; times > 0; times /= 2)
        if (judge_run({factor, times, trial_of(plan_, factor, times)}, times == longest_trial))
          break;
    if (!trials_.empty())
      say(fmt::format("{} trial{} judged before", trials_.size(), trials_.size() == 1 ? "" : "s"));
  }

  /// Judges an existing run; returns whether it has a verdict, which is added to the trials.
  bool judge_run(const Planned& planned, bool is_last)
  {
    const CaseStatus status = status_of(planned.run, plan_.quick);
    FosTrial trial{.factor = planned.factor, .verdict = Verdict::unclear, .motion = {}, .by_growth_alone = false, .message = {}};
    if (status.state == CaseState::failed && std::ranges::find(broken_off_, planned.run.scene_digest) != broken_off_.end()) {
      trial.verdict = Verdict::fails;
      trial.message = status.why;
    } else if (status.state == CaseState::done) {
      trial.motion = motion_of(read_history(planned.run.folder / "history.csv"), plan_.columns, plan_.before);
      if (!trial.motion)
        return false;
      trial.verdict = judge(*trial.motion, plan_.criterion);
      if (trial.verdict == Verdict::unclear && (is_last || plan_.quick)) {
        trial.by_growth_alone = true;
        trial.verdict = trial.motion->growth > plan_.criterion.growth ? Verdict::fails : Verdict::holds;
      }
    }
    if (trial.verdict == Verdict::unclear)
      return false;
    made_.push_back(planned);
    trials_.push_back(std::move(trial));
    std::ranges::sort(trials_, [](const FosTrial& a, const FosTrial& b) { return a.factor < b.factor; });
    return true;
  }

  void try_factors(const std::vector<Real>& factors)
  {
    std::deque<Planned> waiting;
    for (const Real factor : factors)
      waiting.push_back({factor, 1, trial_of(plan_, factor, 1)});
    std::vector<Planned> started;
    const auto start_some = [&] {
      while (!waiting.empty() && runs_.count() < side_.jobs && StopRequests::received().empty()) {
        Planned one = std::move(waiting.front());
        waiting.pop_front();
        const CaseStatus status = status_of(one.run, plan_.quick);
        runs_.start(started.size(), plan_.scene, one.run, status);
        say(fmt::format("{:.6g}: {} ({})", one.factor, status.goes_on_from ? "goes on" : "begins",
                        one.factor == 1 ? "as it is" : fmt::format("{}", fmt::join(divided(plan_, one.factor), ", "))));
        started.push_back(std::move(one));
      }
    };
    start_some();
    wait([&](const ChildRuns::Ended& ended) {
      see_end(started[ended.number], ended, waiting);
      start_some();
    });
  }

  /// Handles the end of a run: adds a verdict, or the same run with twice the duration.
  void see_end(const Planned& one, const ChildRuns::Ended& ended, std::deque<Planned>& waiting)
  {
    if (!StopRequests::received().empty() && ended.code != 0)
      return;
    refuse_stopped(ended.code);
    const CaseStatus status = status_of(one.run, plan_.quick);
    if (ended.code == run_failed && status.state == CaseState::failed)
      broken_off_.push_back(one.run.scene_digest);
    else if (ended.code != 0)
      throw EnvironmentError(fmt::format("the trial of {:.6g} did not run: {}", one.factor, runs_.why(one.run, ended.code, status)));
    if (judge_run(one, one.times == longest_trial)) {
      const FosTrial& trial = *std::ranges::find(trials_, one.factor, &FosTrial::factor);
      say(fmt::format(
          "{:.6g}: {} after {:.1f} s{}", one.factor, word_of(trial), ended.seconds,
          trial.motion ? fmt::format(" (growth {:.3g}, {} {})", trial.motion->growth, second_measure(), second_of(*trial.motion)) : ""));
      return;
    }
    if (status.state != CaseState::done || one.times == longest_trial)
      throw EnvironmentError(fmt::format("the trial of {:.6g} left no history to judge it by in {}", one.factor, one.run.folder.string()));
    say(fmt::format("{:.6g}: unclear, the measures contradict each other; begins anew, {} s long", one.factor,
                    2 * one.times * plan_.duration));
    waiting.push_back({one.factor, 2 * one.times, trial_of(plan_, one.factor, 2 * one.times)});
  }

  const FosOptions& options_;
  const FosPlan& plan_;
  SideBySide side_;
  ChildRuns runs_;
  std::vector<std::string> broken_off_;  ///< digests of trials that failed by their physics
  std::vector<FosTrial> trials_;         ///< in the order of their factors
  std::vector<Planned> made_;
};

std::string criterion_in_words(const FosPlan& plan)
{
  if (plan.trials == TrialKind::equilibrium)
    return fmt::format("{} equilibria each; fails: growth above {} and steadiness above {}, or no equilibrium", plan.duration,
                       plan.criterion.growth, plan.criterion.steadiness);
  return fmt::format("trials of {} s, {}; fails: growth above {} and kinetic energy above {} of its peak", plan.duration,
                     plan.stage.substr(plan.stage.find("damping")), plan.criterion.growth, plan.criterion.liveliness);
}

}  // namespace

void find_fos(const FosOptions& options)
{
  if (!world().alone())
    throw Error("talus fos starts runs of its own and is started once: to have each on several ranks, --launcher \"mpirun -n 4\"");
  forget_launch();
  if (!(options.range.from < options.range.to))
    throw Error(fmt::format("--from {} must be below --to {}", options.range.from, options.range.to));
  const FosPlan plan = plan_fos(options);
  if (fs::exists(plan.folder / "summary.json"))
    throw EnvironmentError(fmt::format("{} holds the results of a run: choose another folder with --out", plan.folder.string()));
  std::error_code said_by_the_lock;
  fs::create_directories(plan.folder, said_by_the_lock);
  const FolderLock lock(plan.folder);
  if (!options.quiet)
    fmt::print("{}: strength of {} divided; {}\n", plan.scene.string(), fmt::join(plan.bodies, ", "), criterion_in_words(plan));
  FosSearch search(options, plan);
  search();
  search.write_files();
  const auto [low, high, out_of_order] = search.bracket();
  if (!options.quiet)
    fmt::print("{}", search.table());
  for (const Real factor : out_of_order)
    fmt::print(stderr, "warning: holds at {:.6g}, above {:.6g}, which fails: verdicts are not in order; look at both trials\n", factor,
               *high);
  fmt::print("factor of safety {:.6g}: holds at {:.6g}, fails at {:.6g}\n", (*low + *high) / 2, *low, *high);
  fmt::print("table in {}\n", (plan.folder / "fos.csv").string());
  if (options.pictures)
    try {
      draw_fos(plan, search.trials(), search.bracket());
    } catch (const Error& e) {
      fmt::print(stderr, "warning: not drawn: {}\n", e.what());
    }
}

}  // namespace talus
