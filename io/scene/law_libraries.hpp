#pragma once
// Opens the libraries of laws of the user.
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/scene/scene_rules.hpp"
#include "materials/interface/any_law.hpp"

namespace talus {

/// Opens the library that a law names, relative to the scene file, and gives it the parameters of the scene.  Does nothing for laws of the program.
/// Returns what is wrong; `path` is that of the mapping with the law, such as "materials[0]".  `others`: laws of the user in the same scene, with
/// which it may share history variables of the same form.
std::vector<Finding> open_library(const std::filesystem::path& scene_file, const std::string& path, AnyLaw& law,
                                  std::span<const LawDescription* const> others = {});

}  // namespace talus
