#pragma once
// Names and order of the checkpoint files in a results folder.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

/// The name of the checkpoint after `step` steps.
std::string name_of_checkpoint(std::int64_t step);

/// The checkpoints in a folder, the newest first.  Throws EnvironmentError if it exists and cannot be read.
std::vector<std::filesystem::path> checkpoints_in(const std::filesystem::path& folder);

}  // namespace talus
