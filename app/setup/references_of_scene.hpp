#pragma once
// The reference configurations of the bodies of a scene.
#include <string>
#include <vector>

#include "io/scene/scene.hpp"

namespace talus {

/// That of each body, in the order of the scene.  The shift does not count for a body that can touch nothing.
std::vector<ReferenceOptions> references_of(const Scene& scene);

/// When a body takes a new reference, in words.
std::string describe(const std::string& body, const ReferenceOptions& reference);

}  // namespace talus
