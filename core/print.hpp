#pragma once
// Printing during a run.  A full disk under a log file, or a pipe that is not read, must not end the run.
#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace talus {

/// As fmt::print(), but text that cannot be written is discarded: the error flag of the stream stays set and is checked at the end.
template <class... Args>
void say(std::FILE* to, fmt::format_string<Args...> format, Args&&... args)
{
  const std::string text = fmt::format(format, std::forward<Args>(args)...);
  std::fputs(text.c_str(), to);
}

}  // namespace talus
