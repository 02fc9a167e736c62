#pragma once
// The scene of a run that goes on, and what may be changed of it then.
#include <string>
#include <vector>

#include "app/observers/checkpoints.hpp"
#include "io/scene/scene.hpp"

namespace talus {

/// The scene of a run that goes on, with what is changed on the way.  SceneErrors: that cannot be changed any more.
Scene read_again(const RunIdentity& run, const std::vector<std::string>& changes);

/// SceneErrors: a change of how long stages take comes too late for them.
void check_durations(const CheckpointList& from, const std::vector<Stage>& stages, const std::vector<std::string>& changes);

}  // namespace talus
