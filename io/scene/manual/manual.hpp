#pragma once
// The reference of scene files, generated from the field lists that also read them.
#include <string>

namespace talus {

/// Every key of a scene with type, unit, range, default and meaning, and every law, as Markdown (docs/reference/scene.md).
std::string scene_manual();

/// The entry for one key, law, kernel, type, output field, column, history variable or word, for a terminal: "friction_angle",
/// "materials.cohesion", "mohr_coulomb".  Throws Error if there is none.
std::string manual_of(const std::string& word);

/// The functions and constants of formulas in a scene, as Markdown.
std::string formula_manual();

/// The reference as JSON Schema (draft 7), for editors that complete keys and mark errors.
std::string scene_schema();

}  // namespace talus
