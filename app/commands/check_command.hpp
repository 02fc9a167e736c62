#pragma once
// Command talus check.
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

/// Does everything except the run, writes nothing, and prints the cost of a run.
void check_scene(const std::filesystem::path& scene, const std::vector<std::string>& set);

}  // namespace talus
