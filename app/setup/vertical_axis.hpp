#pragma once
// Which way is up in a scene.
#include "io/scene/scene.hpp"

namespace talus {

/// A unit vector against gravity; nothing where the scene has none.
std::optional<Vec3> against_gravity(const Scene& scene);

/// The same; without gravity y in 2-D and z in 3-D.
Vec3 upright_of(const Scene& scene);

}  // namespace talus
