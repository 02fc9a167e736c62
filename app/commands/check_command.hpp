#pragma once
// Command talus check.
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

/// Does everything but run, writes nothing, says what a run would cost.
void check_scene(const std::filesystem::path& scene, const std::vector<std::string>& set);

}  // namespace talus
