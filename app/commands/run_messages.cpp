#include "app/commands/run_messages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>

#include "core/display_text.hpp"
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

std::string tell_way_back(const RunOptions& options, const std::filesystem::path& folder, bool quick, bool has_checkpoint,
                          std::int64_t sound)
{
  std::string command = fmt::format("talus run {} --out {}{}", shell_word(options.scene), shell_word(folder), quick ? " --quick" : "");
  if (options.resume)
    command = fmt::format("talus run --resume {} --out {}", shell_word(*options.resume), shell_word(folder));
  for (const std::string& change : options.set)
    command += " --set " + shell_word(change);
  if (has_checkpoint)  // the checkpoint contains the changes
    command = fmt::format("talus run --resume {}", shell_word(folder));
  return fmt::format("; the state before it: {} --until {}", command, sound);
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
