// talus bench
#include "app/commands/bench/bench_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "app/commands/bench/bench_cases.hpp"
#include "app/commands/bench/bench_measure.hpp"
#include "app/commands/bench/bench_table.hpp"
#include "core/parallel/threads.hpp"
#include "core/version.hpp"

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
  const bool of_options =
      std::any_of(report.results.begin(), report.results.end(), [](const BenchResult& r) { return !r.setting.option.empty(); });
  fmt::print("{}\n{}", heading(report), of_options ? option_table(report.results) : table(report.results));
  if (then)
    fmt::print("\n{}", comparison(report, *then));
  if (options.json)
    write_bench(*options.json, report);
}

}  // namespace talus
