#include "app/observers/scene_copy.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/manifest.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// The text of a file; nothing if it does not exist.
std::optional<std::string> text_of(const fs::path& file)
{
  if (std::error_code unknown; !fs::is_regular_file(file, unknown))
    return std::nullopt;
  return read_whole(file);
}

}  // namespace

std::string with_changes(const std::string& text, const std::vector<std::string>& changes)
{
  std::string all = text;
  if (!changes.empty())
    all += "\n# Run with changes:\n";
  for (const std::string& change : changes) {
    all += "#   --set '";
    for (const char c : change) {
      all += c;
      if (c == '\n' || c == '\r')
        all += "#   ";  // a new line, which must be a comment too
    }
    all += "'\n";
  }
  return all;
}

void update_scene_copy(const fs::path& folder, const Scene& scene)
{
  const fs::path file = folder / scene_copy_file;
  const auto manifest = Manifest::of(folder);
  const std::string wanted = with_changes(scene.text, scene.overrides);
  const auto there = text_of(file);
  if (!there || (*there != wanted && manifest && manifest->proves(scene_copy_file)))
    write_whole(file, wanted);
}

std::vector<std::string> find_edits(const fs::path& scene_file, const std::optional<fs::path>& folder, const std::string& text,
                                    const std::vector<std::string>& changes)
{
  std::vector<std::string> edits;
  const auto warn = [&](const fs::path& file) {
    edits.push_back(
        fmt::format("{} was edited since the run began: that is ignored, the run goes on with the scene that it began with; --set "
                    "changes what may change, and the edited scene is a run of its own (talus run {} --out DIR)",
                    file.string(), file.string()));
  };
  if (const auto now = text_of(scene_file); now && *now != text)
    warn(scene_file);
  std::error_code not_there;
  if (!folder || fs::equivalent(scene_file, *folder / scene_copy_file, not_there))
    return edits;
  if (const auto copy = text_of(*folder / scene_copy_file); copy && *copy != text && *copy != with_changes(text, changes))
    warn(*folder / scene_copy_file);
  return edits;
}

}  // namespace talus
