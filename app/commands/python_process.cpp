#include "app/commands/python_process.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "core/error.hpp"

namespace talus {

void become_python(const std::vector<std::string>& words)
{
  const std::string python = ::access("/usr/bin/python3", X_OK) == 0 ? "/usr/bin/python3" : "python3";
  std::vector<std::string> all{python, "-B"};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& word : all)
    pointers.push_back(word.data());
  pointers.push_back(nullptr);
  std::fflush(nullptr);
  ::execvp(python.c_str(), pointers.data());
  throw EnvironmentError(fmt::format("cannot start {}: {}", python, std::strerror(errno)));
}

}  // namespace talus
