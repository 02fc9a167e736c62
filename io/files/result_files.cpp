#include "io/files/result_files.hpp"

#include <algorithm>
#include <cctype>

namespace talus {

bool is_numbered(std::string_view name, std::string_view prefix, std::string_view suffix) noexcept
{
  if (!name.starts_with(prefix) || !name.ends_with(suffix) || name.size() <= prefix.size() + suffix.size())
    return false;
  const std::string_view number = name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
  return std::ranges::all_of(number, [](unsigned char c) { return std::isdigit(c) != 0; });
}

namespace {

bool is_map(std::string_view name) noexcept
{
  const std::string_view stem = name.substr(0, name.rfind('.'));
  return is_numbered(name, "thickness_", ".tif") || std::ranges::any_of(map_kinds, [&](const MapKind& kind) { return kind.name == stem; });
}

}  // namespace

bool is_written_by_runs(std::string_view name) noexcept
{
  static constexpr std::array<std::string_view, 10> names{"summary.json", "history.csv", "runout.csv", "particles.pvd", "mesh.pvd",
                                                          "rigid.pvd",    "mesh.msh",    "mesh.vtu",   "scene.yaml",    initial_file};
  const std::size_t slash = name.find('/');
  if (slash == std::string_view::npos)
    return std::ranges::find(names, name) != names.end() || is_numbered(name, "particles_", ".vtp") || is_numbered(name, "mesh_", ".vtu") ||
           is_numbered(name, "rigid_", ".vtu");
  const std::string_view folder = name.substr(0, slash), file = name.substr(slash + 1);
  return (folder == checkpoint_folder && is_numbered(file, "step_", ".h5")) || (folder == map_folder && is_map(file)) ||
         (folder == section_folder && file.ends_with(".csv"));
}

bool is_result(std::string_view name) noexcept
{
  const std::string_view folder = name.substr(0, name.find('/'));
  return is_written_by_runs(name) || name == report_file || name == progress_file ||
         (folder.size() < name.size() &&
          (folder == checkpoint_folder || folder == map_folder || folder == section_folder || folder == picture_folder));
}

}  // namespace talus
