// The command talus calibrate, which is written in Python.
#include "app/commands/calibrate_command.hpp"

#include <string>
#include <vector>

#include "app/commands/python_process.hpp"

namespace talus {

void calibrate(const CalibrateOptions& options)
{
  std::vector<std::string> words;
  if (options.out)
    words.insert(words.end(), {"--out", options.out->string()});
  if (options.jobs)
    words.insert(words.end(), {"--jobs", std::to_string(*options.jobs)});
  if (options.threads)
    words.insert(words.end(), {"--threads", std::to_string(*options.threads)});
  if (!options.pictures)
    words.emplace_back("--no-pictures");
  if (options.quiet)
    words.emplace_back("--quiet");
  become_command("calibrate", options.specification.string(), words);
}

}  // namespace talus
