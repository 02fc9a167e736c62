#pragma once
// Command talus check.
#include <filesystem>
#include <string>
#include <vector>

namespace talus {

/// Does everything except the run, writes nothing, and prints the cost of a run.
void check_scene(const std::filesystem::path& scene, const std::vector<std::string>& set);

/// Checks the variants of a scene that a file names (io/output/variants_json.hpp), without writing anything, and prints what was found in
/// each.  Throws Error if the file is damaged.
void check_variants(const std::filesystem::path& scene, const std::filesystem::path& variants);

}  // namespace talus
