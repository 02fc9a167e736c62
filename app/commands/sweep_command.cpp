// The command talus sweep, which is written in Python.
#include "app/commands/sweep_command.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "app/commands/python_process.hpp"
#include "core/error.hpp"
#include "core/parallel/communicator.hpp"

namespace talus {

void sweep(const SweepOptions& options)
{
  if (!world().alone())
    throw Error("talus sweep starts runs of its own and is started once: to have each on several ranks, --launcher \"mpirun -n 4\"");
  forget_launch();
  std::vector<std::string> words;
  if (options.out)
    words.insert(words.end(), {"--out", options.out->string()});
  if (options.launcher)
    words.push_back(fmt::format("--launcher={}", *options.launcher));
  for (const auto& [name, number] :
       {std::pair("--jobs", options.jobs), std::pair("--threads", options.threads), std::pair("--case", options.only)})
    if (number)
      words.insert(words.end(), {name, std::to_string(*number)});
  for (const auto& [name, is_given] : {std::pair("--list", options.list), std::pair("--quick", options.quick),
                                       std::pair("--quiet", options.quiet), std::pair("--no-pictures", !options.pictures)})
    if (is_given)
      words.emplace_back(name);
  become_command("sweep", options.study.string(), words);
}

}  // namespace talus
