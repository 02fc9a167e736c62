// The command talus diff, which is written in Python.
#include "app/commands/diff_command.hpp"

#include "app/commands/python_process.hpp"

namespace talus {

void compare_results(const DiffOptions& options)
{
  std::vector<std::string> words{options.b.string()};
  words.insert(words.end(), options.words.begin(), options.words.end());
  become_command("diff", options.a.string(), words);
}

}  // namespace talus
