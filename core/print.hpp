#pragma once
// Printing in the midst of a run, which a full disk below a log, or a pipe that nobody reads, must not end.
#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace talus {

/// As fmt::print(), but what cannot be written is lost: the error flag of the stream stays set, for a check at the end.
template <class... Args>
void say(std::FILE* to, fmt::format_string<Args...> format, Args&&... args)
{
  const std::string text = fmt::format(format, std::forward<Args>(args)...);
  std::fputs(text.c_str(), to);
}

}  // namespace talus
