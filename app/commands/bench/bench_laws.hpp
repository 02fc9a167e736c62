#pragma once
// Materials of `talus bench`: every law with parameters under which the block flows, if it can.
#include "io/scene/scene_bodies.hpp"

namespace talus {

/// `name` is one of bench_laws().
AnyLaw bench_law(std::string_view name);
std::vector<std::string> bench_laws();

}  // namespace talus
