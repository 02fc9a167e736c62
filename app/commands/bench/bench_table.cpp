#include "app/commands/bench/bench_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/commands/bench/bench_command.hpp"

namespace talus {

namespace {

constexpr Real percent = 100;

/// Names of the phases of all results, each where it first stands; the rest comes last.
std::vector<std::string> phase_names(const std::vector<BenchResult>& results)
{
  std::vector<std::string> names;
  for (const BenchResult& result : results)
    for (const BenchPhase& phase : result.phases)
      if (std::find(names.begin(), names.end(), phase.name) == names.end())
        names.push_back(phase.name);
  std::stable_partition(names.begin(), names.end(), [](const std::string& name) { return name != "rest"; });
  return names;
}

std::string phase_entry(const BenchResult& result, const std::string& name)
{
  for (const BenchPhase& phase : result.phases)
    if (phase.name == name)
      return fmt::format("{:.1f}", phase.ns);
  return "-";
}

std::string spread_entry(const Measured& m) { return fmt::format("{:.0f}-{:.0f}", m.least, m.most); }

/// Kernel to threads, as they stand at the beginning of each line.
std::string setting_entry(const BenchSetting& s)
{
  return fmt::format("{:<15}{:<9}{:<16}{:>3}{:>5}{:>4}  ", s.kernel, s.transfer, s.law, s.dimension, s.per_cell, s.threads);
}

std::string setting_names() { return fmt::format("{:<15}{:<9}{:<16}{:>3}{:>5}{:>4}  ", "kernel", "transfer", "law", "D", "cell", "thr"); }

const BenchResult* find(const BenchReport& report, const BenchSetting& setting)
{
  const auto found = std::find_if(report.results.begin(), report.results.end(), [&](const BenchResult& r) { return r.setting == setting; });
  return found == report.results.end() ? nullptr : &*found;
}

}  // namespace

std::string heading(const BenchReport& r)
{
  return fmt::format("talus {} ({}), {}, {}: {}\n{}, {} core{}\n", r.version, r.commit, r.compiler, r.build, r.flags, r.processor, r.cores,
                     r.cores == 1 ? "" : "s");
}

std::string table(const std::vector<BenchResult>& results)
{
  const auto phases = phase_names(results);
  std::string text = setting_names() + fmt::format("{:>9}{:>8}{:>11}{:>8}", "M/s/core", "ns", "min-max", "cpu ns");
  for (const std::string& name : phases)
    text += fmt::format("{:>8}", name);
  text += fmt::format("{:>7}{:>7}\n", "B held", "moved");
  for (const BenchResult& r : results) {
    text +=
        setting_entry(r.setting) + fmt::format("{:>9.3f}{:>8.1f}{:>11}{:>8.1f}", r.rate(), r.ns.median, spread_entry(r.ns), r.cpu.median);
    for (const std::string& name : phases)
      text += fmt::format("{:>8}", phase_entry(r, name));
    text += fmt::format("{:>7.0f}{:>7.0f}\n", r.bytes_held, r.bytes_moved);
  }
  return text +
         "M/s/core: million particle-steps per second and core; ns: wall time of a particle-step, median of the repeats; cpu ns: processor "
         "time of all\n"
         "threads; then wall time by phase\n"
         "B held: columns of a particle; moved: the least that memory must carry per particle-step\n";
}

std::string option_table(const std::vector<BenchResult>& results)
{
  const BenchResult& base = results.front();
  std::string text = fmt::format("what options cost: {}\n{:<16}{:>8}{:>11}{:>9}{:>8}{:>8}{:>11}{:>9}{:>8}\n", describe(base.setting),
                                 "option", "ns", "min-max", "more ns", "more %", "cpu ns", "min-max", "more ns", "more %");
  const auto entry = [](const Measured& m, const Measured& of_base) {
    return fmt::format("{:>8.1f}{:>11}{:>+9.1f}{:>+8.1f}", m.median, spread_entry(m), m.median - of_base.median,
                       percent * (m.median / of_base.median - 1));
  };
  for (const BenchResult& r : results)
    text += fmt::format("{:<16}{}{}\n", r.setting.option.empty() ? "-" : r.setting.option, entry(r.ns, base.ns), entry(r.cpu, base.cpu));
  return text;
}

std::string comparison(const BenchReport& now, const BenchReport& then)
{
  std::string text =
      fmt::format("compared with {} ({}), {} on {}\n{}{:<17}{:>9}{:>9}{:>8}{:>8}{:>9}{:>9}{:>8}\n", then.version, then.commit,
                  then.compiler, then.processor, setting_names(), "option", "ns now", "then", "ratio", "", "cpu now", "then", "ratio");
  const auto entry = [](const Measured& m, const Measured& old) {
    const bool faster = m.most<old.least, slower = m.least> old.most;
    return fmt::format("{:>9.1f}{:>9.1f}{:>8.3f}{:>8}", m.median, old.median, m.median / old.median,
                       faster   ? "faster"
                       : slower ? "slower"
                                : "");
  };
  for (const BenchResult& r : now.results)
    if (const BenchResult* const old = find(then, r.setting))
      text += setting_entry(r.setting) +
              fmt::format("{:<17}{}{}{}\n", r.setting.option.empty() ? "-" : r.setting.option, entry(r.ns, old->ns), entry(r.cpu, old->cpu),
                          r.particles == old->particles ? "" : fmt::format("  (then {} particles)", old->particles));
    else
      text += fmt::format("only now: {}\n", describe(r.setting));
  for (const BenchResult& old : then.results)
    if (find(now, old.setting) == nullptr)
      text += fmt::format("only then: {}\n", describe(old.setting));
  return text + "faster, slower: no repeat of now reaches one of then\n";
}

}  // namespace talus
