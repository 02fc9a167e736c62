#pragma once
// The files of checkpoints in the folder of a run: their names and order.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

/// Of the checkpoint that is written after so many steps.
std::string name_of_checkpoint(std::int64_t step);

/// Those in a folder, the newest first.  EnvironmentError: it is there and cannot be read.
std::vector<std::filesystem::path> checkpoints_in(const std::filesystem::path& folder);

}  // namespace talus
