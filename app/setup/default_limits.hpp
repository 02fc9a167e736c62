#pragma once
// How fast particles may be, and how much energy may come from nowhere, before a run is taken for broken.
#include "app/setup/setup.hpp"

namespace talus {

/// As the scene says; without a word of it, limits that no sound run comes near.
/// Every rank has to ask.
template <int D>
RunLimits run_limits_of(const Scene& scene, const Mesh<D>& mesh, const Setup<D>& setup, Communicator& ranks);

extern template RunLimits run_limits_of<2>(const Scene&, const Mesh<2>&, const Setup<2>&, Communicator&);
extern template RunLimits run_limits_of<3>(const Scene&, const Mesh<3>&, const Setup<3>&, Communicator&);

}  // namespace talus
