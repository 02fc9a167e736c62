// talus sweep
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <deque>
#include <iterator>
#include <map>
#include <numeric>

#include "app/commands/sweep/run_queue.hpp"
#include "app/commands/sweep/sweep_command.hpp"
#include "app/commands/sweep/sweep_findings.hpp"
#include "core/parallel/communicator.hpp"
#include "core/version.hpp"
#include "io/scene/reader.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// runs/<name>, with the name of the file, or of the folder of a study.yaml.
fs::path default_sweep_folder(const fs::path& study)
{
  const fs::path folder = fs::absolute(study).lexically_normal().parent_path().filename();
  return fs::path("runs") / (study.filename() == "study.yaml" && !folder.empty() ? folder.string() + "_study" : study.stem().string());
}

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
  std::vector<QueuedRun> queued;
  for (const SweepCase& one : plan.cases)
    queued.push_back({fmt::format("case {}", one.number), &one});
  const auto status = [&](std::size_t i) -> const CaseStatus& { return table.status(i); };
  RunQueue all({scene_of(plan.study), options.launcher, side, plan.quick, options.quiet}, std::move(queued),
               [&](std::size_t i) -> const CaseStatus& {
                 table.update();
                 return table.status(i);
               });
  std::deque<std::size_t> waiting;
  std::ranges::copy_if(chosen, std::back_inserter(waiting), [&](std::size_t i) { return status(i).state != CaseState::done; });
  all(std::move(waiting));
  table.update();
  if (!options.quiet)
    fmt::print("{}table in {}\n", table.print(), (plan.folder / "sweep.csv").string());
  find_out(options.pictures && all.signal().empty());
  print_remarks(plan, table);
  all.conclude(chosen, status, {"cases", "running the sweep again"});
}

}  // namespace talus
