#pragma once
// How fast particles may be, and how much energy may come from nowhere, before a run is taken for broken.
#include "app/setup/setup.hpp"

namespace talus {

/// As the scene says; without a word of it, limits that no sound run comes near.
/// Every rank has to ask.
template <int D>
RunLimits run_limits_of(const Scene& scene, const Mesh<D>& mesh, const Setup<D>& setup, Communicator& ranks);

}  // namespace talus
