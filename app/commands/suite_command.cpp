// The commands talus verify and talus tradeoff: finds the suite, which is written in Python, and replaces this process by it.
#include "app/commands/suite_command.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "app/commands/python_process.hpp"
#include "core/error.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// The folder of the suite's scripts: given by the environment, installed in PREFIX/libexec/talus/talus, or in the sources of
/// build/<preset>/talus.
fs::path suite_folder(const fs::path& self, const std::string& script)
{
  if (const char* given = std::getenv("TALUS_SUITE"); given != nullptr && *given != '\0') {
    if (!fs::exists(fs::path(given) / script))
      throw EnvironmentError(fmt::format("TALUS_SUITE is {}, where there is no {}", given, script));
    return given;
  }
  const fs::path above = self.parent_path().parent_path().parent_path(), installed = above / "share/talus/benchmarks",
                 source = above / "benchmarks";
  for (const fs::path& folder : {installed, source})
    if (fs::exists(folder / script))
      return folder;
  throw EnvironmentError(
      fmt::format("the verification suite is neither in {} nor in {}: set TALUS_SUITE to the folder benchmarks of the sources",
                  installed.string(), source.string()));
}

void add(const char* option, const std::optional<std::string>& word, std::vector<std::string>& words)
{
  if (word)
    words.insert(words.end(), {option, *word});
}

}  // namespace

void run_suite(const SuiteOptions& options)
{
  const fs::path self = fs::read_symlink("/proc/self/exe");
  const std::string script = options.suite + ".py";
  std::vector<std::string> words{(suite_folder(self, script) / script).string(), "--program", self.string()};
  const auto add_number = [&](const char* option, const std::optional<int>& number) {
    add(option, number ? std::optional(std::to_string(*number)) : std::nullopt, words);
  };
  add("--level", options.level, words);
  add("--kernel", options.kernel, words);
  add("--transfer", options.transfer, words);
  add("--out", options.out ? std::optional(options.out->string()) : std::nullopt, words);
  add_number("--jobs", options.jobs);
  add_number("--threads", options.threads);
  if (options.reuse)
    words.emplace_back("--reuse");
  if (options.regression)
    words.emplace_back("--regression");
  words.insert(words.end(), options.cases.begin(), options.cases.end());
  become_python(words);
}

}  // namespace talus
