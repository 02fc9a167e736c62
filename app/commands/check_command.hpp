#pragma once
// Command talus check.
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

/// Does everything except the run, writes nothing, and prints the cost of a run.
void check_scene(const std::filesystem::path& scene, const std::vector<std::string>& set);

/// Checks the same, and prints what the scene consists of as JSON (io/output/scene_facts_json.hpp).  With `keys_only`, only the keys are
/// checked: no mesh is made, and no other run is looked at from which the scene starts.
void check_as_json(const std::filesystem::path& scene, const std::vector<std::string>& set, bool keys_only);

}  // namespace talus
