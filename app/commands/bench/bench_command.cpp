// talus bench
#include "app/commands/bench/bench_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "app/commands/bench/bench_block.hpp"
#include "app/commands/bench/bench_measure.hpp"
#include "app/commands/bench/bench_table.hpp"
#include "core/parallel/threads.hpp"
#include "core/version.hpp"
#include "core/word_match.hpp"
#include "io/scene/scene_rules.hpp"
#include "materials/interface/any_law.hpp"
#include "mesh/quadrature.hpp"

namespace talus {

std::string processor_name()
{
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name"))
      if (const auto colon = line.find(": "); colon != std::string::npos)
        return line.substr(colon + 2);
  return "unknown";
}

namespace {

/// Runs settings one by one and says so.
BenchReport measured_report(const BenchOptions& options)
{
  const auto settings = options.options ? option_settings(options) : bench_settings(options, threads());
  const Version v = version();
  BenchReport report;
  report.version = v.number, report.commit = v.commit, report.compiler = v.compiler, report.build = v.build_type;
  report.flags = v.flags;
  report.processor = processor_name();
  report.cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  for (const BenchSetting& setting : settings) {
    report.results.push_back(measure(setting, {options.particles, options.warm_up, options.repeats, options.steps}));
    fmt::print(stderr, "{}: {:.1f} ns\n", describe(setting), report.results.back().ns.median);
  }
  return report;
}

}  // namespace

void bench(const BenchOptions& options)
{
  if (options.ranks)
    return bench_ranks(options);
  const auto then = options.compare ? std::optional(read_bench(*options.compare)) : std::nullopt;
  const BenchReport report = options.from ? read_bench(*options.from) : measured_report(options);
  const bool of_options = std::ranges::any_of(report.results, [](const BenchResult& r) { return !r.setting.option.empty(); });
  fmt::print("{}\n{}", heading(report), of_options ? option_table(report.results) : table(report.results));
  if (then)
    fmt::print("\n{}", comparison(report, *then));
  if (options.json)
    write_bench(*options.json, report);
}

namespace {

template <class Choice>
std::vector<std::string> names_of(Choice choice)
{
  const auto names = enum_names(choice);
  return {names.begin(), names.end()};
}

std::vector<std::string> law_names()
{
  std::vector<std::string> names;
  for (const LawDescription* law : known_laws())
    names.emplace_back(law->name);
  return names;
}

/// The words given, or else `usual`.  Adds a problem for each that is not known.
std::vector<std::string> chosen(const std::string& option, const std::vector<std::string>& given, const std::vector<std::string>& usual,
                                const std::vector<std::string>& known, std::vector<SceneError>& problems)
{
  for (const std::string& word : given)
    if (std::find(known.begin(), known.end(), word) == known.end())
      problems.push_back({{option, 0, 0, ""}, fmt::format("there is no \"{}\"{}", word, suggestion(word, known)), ""});
  return given.empty() ? usual : given;
}

/// The words on the command line as values of each axis.
struct Axes {
  std::vector<std::string> kernels, transfers, laws;
  std::vector<int> dimensions, threads, per_cell;  ///< per_cell empty: the usual ones of each dimension
};

Axes axes_of(const BenchOptions& o, int all_threads)
{
  std::vector<SceneError> problems;
  const bool all = o.all;
  Axes axes;
  axes.kernels = chosen("--kernel", o.kernels, all ? kernel_names() : std::vector<std::string>{"projected", "umls", "linear"},
                        kernel_names(), problems);
  const auto transfers = names_of(Scheme{});
  axes.transfers = chosen("--transfer", o.transfers, all ? transfers : std::vector<std::string>{"tpic", "aflip"}, transfers, problems);
  axes.laws = chosen("--law", o.laws, all ? law_names() : std::vector<std::string>{"neo_hookean"}, law_names(), problems);
  axes.dimensions = !o.dimensions.empty() ? o.dimensions : all ? std::vector{3, 2} : std::vector{3};
  axes.threads = !o.threads.empty() ? o.threads : all && all_threads > 1 ? std::vector{1, all_threads} : std::vector{1};
  axes.per_cell = o.per_cell;
  for (const int n : o.per_cell)
    for (const int d : axes.dimensions)
      if (const int most = d == 2 ? seeding_counts<2>().back() : seeding_counts<3>().back(); n > most)
        problems.push_back({{"--per-cell", 0, 0, ""}, fmt::format("a cell takes at most {} particles in {}-D, not {}", most, d, n), ""});
  if (!problems.empty())
    throw SceneErrors(problems);
  return axes;
}

std::vector<int> usual_per_cell(int dimension, bool all)
{
  if (dimension == 2)
    return {4};
  return all ? std::vector{8, 2} : std::vector{8};
}

std::vector<BenchSetting> product(const Axes& axes, bool all)
{
  std::vector<BenchSetting> list;
  for (const int dimension : axes.dimensions)
    for (const int per_cell : axes.per_cell.empty() ? usual_per_cell(dimension, all) : axes.per_cell)
      for (const std::string& law : axes.laws)
        for (const std::string& kernel : axes.kernels)
          for (const std::string& transfer : axes.transfers)
            for (const int n : axes.threads)
              list.push_back({kernel, transfer, law, dimension, per_cell, n});
  return list;
}

}  // namespace

std::vector<BenchSetting> bench_settings(const BenchOptions& o, int all_threads)
{
  const Axes axes = axes_of(o, all_threads);
  const bool any_word =
      !o.kernels.empty() || !o.transfers.empty() || !o.laws.empty() || !o.dimensions.empty() || !o.threads.empty() || !o.per_cell.empty();
  auto list = product(axes, o.all);
  if (any_word || o.all)
    return list;
  Axes plane = axes;
  plane.dimensions = {2};
  const auto more = product(plane, false);
  list.insert(list.end(), more.begin(), more.end());
  for (const char* law : {"drucker_prager", "johnson_cook"})
    list.push_back({"projected", "aflip", law, 3, 8, 1});
  for (const char* transfer : {"tpic", "aflip"})
    list.push_back({"projected", transfer, "neo_hookean", 3, 2, 1});
  if (all_threads > 1)
    list.push_back({"projected", "aflip", "neo_hookean", 3, 8, all_threads});
  return list;
}

BenchSetting one_setting(const BenchOptions& o)
{
  BenchSetting setting = product(axes_of(o, 1), false).front();
  if (o.transfers.empty())
    setting.transfer = "aflip";
  return setting;
}

std::vector<BenchSetting> option_settings(const BenchOptions& o)
{
  const BenchSetting base = one_setting(o);
  std::vector<BenchSetting> list;
  for (const std::string_view option : bench_options::each)
    list.push_back(base), list.back().option = option;
  return list;
}

std::string describe(const BenchSetting& s)
{
  return fmt::format("{} {} {} {}-D {} a cell {} thread{}{}{}", s.kernel, s.transfer, s.law, s.dimension, s.per_cell, s.threads,
                     s.threads == 1 ? "" : "s", s.option.empty() ? "" : " + ", s.option);
}

}  // namespace talus
