// The line of a scene that a warning concerns.
#include <charconv>
#include <filesystem>
#include <regex>

#include "app/commands/report/report.hpp"
#include "io/document/document.hpp"

namespace talus {

namespace {

/// The line in "slope.yaml:12:5: ...", here 12.
std::optional<int> line_named(const std::string& warning, const std::string& scene_file)
{
  const std::string name = std::filesystem::path(scene_file).filename().string() + ':';
  const auto at = warning.find(name);
  if (name == ":" || at == warning.npos)
    return std::nullopt;
  int line = 0;
  const char* const end = warning.data() + warning.size();
  const auto [after, failed] = std::from_chars(warning.data() + at + name.size(), end, line);
  return failed == std::errc{} && line > 0 ? std::optional(line) : std::nullopt;
}

/// Whether a line of YAML contains this key, in a block or in braces.
bool gives(std::string_view line, const std::string& key)
{
  for (auto at = line.find(key + ':'); at != line.npos; at = line.find(key + ':', at + 1))
    if (at == 0 || std::string_view(" \t{,-").find(line[at - 1]) != std::string_view::npos)
      return line.substr(0, at).find('#') == line.npos;
  return false;
}

/// The line of "watch.speed": the first one below `watch` that contains `speed`.
std::optional<int> line_of_key(const std::string& group, const std::string& key, const std::string& scene_text)
{
  int number = 0;
  bool inside = false;
  for (const std::string_view line : lines_of(scene_text)) {
    ++number;
    if (!line.empty() && line.front() != ' ' && line.front() != '#')
      inside = gives(line, group);
    if (inside && gives(line, key))
      return number;
  }
  return std::nullopt;
}

}  // namespace

std::optional<int> line_of_warning(const std::string& warning, const std::string& scene_file, const std::string& scene_text)
{
  if (const auto line = line_named(warning, scene_file))
    return line;
  static const std::regex path("\\b([a-z_]+)\\.([a-z_]+)\\b");
  for (std::sregex_iterator found(warning.begin(), warning.end(), path), end; found != end; ++found)
    if (const auto line = line_of_key((*found)[1], (*found)[2], scene_text))
      return line;
  return std::nullopt;
}

}  // namespace talus
