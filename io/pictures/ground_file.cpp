#include "io/pictures/ground_file.hpp"

#include <fstream>
#include <string>

#include "core/error.hpp"
#include "io/mesh/gmsh_read.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// Whether the names of the groups, at the beginning of the file, contain that of the ground.
bool names_terrain(const fs::path& file)
{
  std::ifstream text(file, std::ios::binary);
  constexpr int most_lines = 10'000;  // a mesh of terrain has fewer groups; the limit also ends the search in a file of numbers only
  std::string line;
  for (int i = 0; i < most_lines && std::getline(text, line) && !line.starts_with("$EndPhysicalNames"); ++i)
    if (line.ends_with(" \"terrain\""))
      return true;
  return false;
}

}  // namespace

std::optional<RigidGround> read_ground(const fs::path& folder, int dimension)
{
  const fs::path file = folder / "mesh.msh";
  if (!fs::exists(file) || !names_terrain(file))
    return std::nullopt;
  try {
    const SourceLocation asked_by{file.string(), 0, 0, ""};
    return dimension == 2 ? rigid_ground_of(read_msh<2>(file, asked_by)) : rigid_ground_of(read_msh<3>(file, asked_by));
  } catch (const SceneErrors& e) {
    throw EnvironmentError(e.what());
  }
}

}  // namespace talus
