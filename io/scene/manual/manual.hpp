#pragma once
// The reference of scene files, written out of the field lists that also read them.
#include <string>

namespace talus {

/// Every key of a scene with type, unit, range, default and meaning, and every law, as Markdown (docs/reference/scene.md).
std::string scene_manual();

/// The same of one key, law, kernel, type, output field, column, history variable or word, for a terminal: "friction_angle", "materials.cohesion", "mohr_coulomb".
/// Error: there is none.
std::string manual_of(const std::string& word);

/// What formulas in a scene may use, in Markdown.
std::string formula_manual();

/// The same as JSON Schema (draft 7), for editors that complete keys and mark mistakes while one writes.
std::string scene_schema();

}  // namespace talus
