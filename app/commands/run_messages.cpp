#include "app/commands/run_messages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>

#include "core/parallel/communicator.hpp"
#include "core/print.hpp"

namespace talus {

std::vector<std::string> tell_changes(Real time, std::string_view stage, const StageReport& news, bool quiet,
                                      std::vector<std::string>& warnings)
{
  const std::string when = fmt::format("t = {:.6g} s, stage \"{}\": ", time, stage);
  std::vector<std::string> lines;
  for (const std::string& what : news.told)
    lines.push_back(when + what);
  for (const std::string& what : news.warnings)
    warnings.push_back(when + what);
  if (!world().is_root())
    return lines;
  for (const std::string& what : news.warnings)
    say(stderr, "warning: {}{}\n", when, what);
  for (const std::string& line : lines)
    if (!quiet)
      say(stdout, "{}\n", line);
  std::fflush(stdout);
  return lines;
}

std::string tell_set_aside(const std::filesystem::path& taken, const std::vector<std::filesystem::path>& aside)
{
  std::vector<std::string> names;
  for (const std::filesystem::path& file : aside)
    names.push_back(file.filename().string());
  return fmt::format("newer checkpoints than {} are of another way of the run, or damaged, and were renamed: {}", taken.filename().string(),
                     fmt::join(names, ", "));
}

void say_rebalanced(const Rebalanced& by)
{
  if (!world().is_root())
    return;
  say(stdout, "step {}, t = {:.6g} s: shared out anew in {:.2g} s, the busiest rank has {:.3g} times the mean of the work, before {:.3g}\n",
      by.clock.step, by.clock.time, by.seconds, by.after, by.before);
  std::fflush(stdout);
}

}  // namespace talus
