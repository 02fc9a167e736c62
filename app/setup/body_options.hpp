#pragma once
// What bodies of a scene choose of the solver: reference configurations, and particles that are split and merged.
#include <string>
#include <vector>

#include "io/scene/scene.hpp"

namespace talus {

/// That of each body, in the order of the scene.  The shift does not count for a body that can touch nothing.
std::vector<ReferenceOptions> references_of(const Scene& scene);

/// How the particles of each body are split and merged, with all its numbers; nothing where they stay what they are.
std::vector<std::optional<ResampleOptions>> resampling_of(const Scene& scene);

/// When a body takes a new reference, in words.
std::string describe(const std::string& body, const ReferenceOptions& reference);
/// When particles of a body are split and merged, in words.
std::string describe(const std::string& body, const ResampleOptions& resample);

}  // namespace talus
