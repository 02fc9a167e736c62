#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace talus {

std::string to_string(const SourceLocation& where)
{
  if (where.line == 0)
    return where.file;
  if (where.column == 0)
    return fmt::format("{}:{}", where.file, where.line);
  return fmt::format("{}:{}:{}", where.file, where.line, where.column);
}

namespace {

std::string print(const std::vector<SceneError>& problems)
{
  std::string text;
  for (const auto& [where, message, source_line] : problems) {
    const std::string place = to_string(where);
    text += fmt::format("{}{}error: {}{}{}\n", place, place.empty() ? "" : ": ", where.path, where.path.empty() ? "" : ": ", message);
    if (!source_line.empty()) {
      text += fmt::format("{:5} | {}\n", where.line, source_line);
      if (where.column > 0)
        text += fmt::format("      | {:>{}}\n", "^", where.column);
    }
  }
  text += fmt::format("{} error{}, nothing was run.", problems.size(), problems.size() == 1 ? "" : "s");
  return text;
}

std::vector<SceneError> by_place(std::vector<SceneError> problems)
{
  std::stable_sort(problems.begin(), problems.end(), [](const SceneError& a, const SceneError& b) {
    return std::tie(a.where.file, a.where.line, a.where.column) < std::tie(b.where.file, b.where.line, b.where.column);
  });
  return problems;
}

}  // namespace

SceneErrors::SceneErrors(std::vector<SceneError> problems) : Error(print(by_place(problems))), problems_(by_place(std::move(problems))) {}

}  // namespace talus
