#include "app/setup/checks/scene_error_collector.hpp"

#include "io/document/document.hpp"

namespace talus {

namespace {

/// Line `number` (from one) of a text, as messages show it.
std::string line_of(std::string_view text, int number)
{
  for (; number > 1; --number) {
    const auto end = text.find('\n');
    if (end == text.npos)
      return {};
    text.remove_prefix(end + 1);
  }
  return shown_line(text.substr(0, text.find('\n')));
}

}  // namespace

void SceneErrorCollector::add(SourceLocation where, std::string_view key, std::string message)
{
  if (!key.empty())
    where.path += where.path.empty() ? std::string(key) : fmt::format(".{}", key);
  std::string line = where.line > 0 && where.file == scene_->file ? line_of(scene_->text, where.line) : "";
  problems_.push_back({std::move(where), std::move(message), std::move(line)});
}

void SceneErrorCollector::add(const SourceLocation& where, std::string_view key, const SceneErrors& in_file)
{
  for (const SceneError& problem : in_file.problems()) {
    if (problem.where.line == 0)
      add(where, key, fmt::format("{}: {}", problem.where.file, problem.message));
    else
      problems_.push_back(problem);
  }
}

void SceneErrorCollector::unknown_group(const SourceLocation& where, std::string_view key, std::string_view kind, const std::string& name,
                                        std::vector<std::string> known)
{
  const std::string has =
      known.empty() ? fmt::format("; the mesh has no {} groups", kind) : fmt::format("; the mesh has {}", or_list(known));
  const auto near = closest_match(name, known);
  add(where, key, fmt::format("the mesh has no {} group \"{}\"{}", kind, name, near ? fmt::format(" — did you mean \"{}\"?", *near) : has));
}

void SceneErrorCollector::throw_if_any() const
{
  if (!problems_.empty())
    throw SceneErrors(problems_);
}

}  // namespace talus
