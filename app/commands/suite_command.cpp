// The commands talus verify and talus tradeoff: finds the suite, which is written in Python, and replaces this process by it.
#include "app/commands/suite_command.hpp"

#include "app/commands/python_process.hpp"

namespace talus {

namespace fs = std::filesystem;

namespace {

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
  const fs::path suite =
      find_scripts(self, {.what = "the verification suite", .variable = "TALUS_SUITE", .file = script, .folder = "benchmarks"});
  std::vector<std::string> words{(suite / script).string(), "--program", self.string()};
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
