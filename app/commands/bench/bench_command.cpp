// talus bench
#include "app/commands/bench/bench_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "app/commands/bench/bench_cases.hpp"
#include "app/commands/bench/bench_machine.hpp"
#include "app/commands/bench/bench_ranks.hpp"
#include "app/commands/bench/bench_table.hpp"
#include "app/commands/bench/bench_yardstick.hpp"
#include "core/parallel/threads.hpp"
#include "core/version.hpp"

namespace talus {

namespace {

/// Runs settings one by one and says so.
class Bench {
 public:
  explicit Bench(const BenchPlan& plan) : plan_(plan)
  {
    const Version v = version();
    report_.version = v.number, report_.commit = v.commit, report_.compiler = v.compiler, report_.build = v.build_type;
    report_.flags = v.flags;
    report_.processor = processor_name();
    report_.cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  }

  void measure_limits(std::vector<int> threads)
  {
    std::sort(threads.begin(), threads.end());
    threads.erase(std::unique(threads.begin(), threads.end()), threads.end());
    for (const int n : threads)
      report_.limits.push_back(measure_machine(n));
  }
  void add_yardstick(int dimension, int n_threads) { add(measure_yardstick(dimension, n_threads, plan_)); }
  void add_setting(const BenchSetting& setting) { add(measure(setting, plan_)); }
  const BenchReport& report() const noexcept { return report_; }

 private:
  void add(BenchResult result)
  {
    constexpr Real nano = 1e-9;
    const auto limit = std::find_if(report_.limits.begin(), report_.limits.end(),
                                    [&](const MachineLimit& l) { return l.threads == result.setting.threads; });
    const Real seconds = nano * result.ns.median;
    result.bandwidth_share = result.bytes_moved / (seconds * limit->triad);
    result.fma_room = limit->fma * seconds;
    for (const BenchResult& other : report_.results)
      if (other.is_yardstick() && other.setting.dimension == result.setting.dimension && other.setting.threads == result.setting.threads)
        result.over_yardstick = result.ns.median / other.ns.median;
    fmt::print(stderr, "{}: {:.1f} ns\n", describe(result.setting), result.ns.median);
    report_.results.push_back(std::move(result));
  }

  BenchPlan plan_;
  BenchReport report_;
};

BenchReport measured_report(const BenchOptions& options)
{
  const int all_threads = threads();
  const auto settings = options.options ? option_settings(options) : bench_settings(options, all_threads);
  Bench bench({options.particles, options.warm_up, options.repeats, options.steps});
  std::vector<int> used{1, all_threads};
  std::vector<std::pair<int, int>> yardsticks;
  for (const BenchSetting& s : settings) {
    used.push_back(s.threads);
    if (const std::pair wanted{s.dimension, s.threads}; std::find(yardsticks.begin(), yardsticks.end(), wanted) == yardsticks.end())
      yardsticks.push_back(wanted);
  }
  bench.measure_limits(used);
  if (!options.options)
    for (const auto& [dimension, n] : yardsticks)
      bench.add_yardstick(dimension, n);
  for (const BenchSetting& s : settings)
    bench.add_setting(s);
  return bench.report();
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
