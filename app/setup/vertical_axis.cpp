#include "app/setup/vertical_axis.hpp"

#include <algorithm>

namespace talus {

std::optional<Vec3> against_gravity(const Scene& scene)
{
  for (const LoadSpec& load : scene.loads)
    if (const auto* gravity = std::get_if<GravitySpec>(&load)) {
      Vec3 up = Vec3::Zero();
      for (std::size_t d = 0; d < std::min<std::size_t>(3, gravity->acceleration.size()); ++d)
        up[static_cast<Index>(d)] = 0 - gravity->acceleration[d];  // not -0
      if (up.norm() > 0)
        return up.normalized();
    }
  return std::nullopt;
}

Vec3 upright_of(const Scene& scene)
{
  return against_gravity(scene).value_or(scene.dimension == 2 ? Vec3(Vec3::UnitY()) : Vec3(Vec3::UnitZ()));
}

}  // namespace talus
