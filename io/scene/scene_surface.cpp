#include "io/scene/scene_surface.hpp"

namespace talus {

void SurfaceSpec::check(std::vector<std::string>& problems) const
{
  const int given = (file.empty() ? 0 : 1) + (elevation ? 1 : 0) + (depth ? 1 : 0) + (points.empty() ? 0 : 1);
  if (given != 1)
    problems.emplace_back("a surface is exactly one of file, elevation, depth and points");
}

}  // namespace talus
