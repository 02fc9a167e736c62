#pragma once
// `accuracy: draft | standard | fine`: one key for the settings that trade time for accuracy.
#include "io/scene/scene.hpp"

namespace talus {

/// Multiplies the sizes of all cells that Talus generates.  Meshes from files stay as they are.
void scale_cells(MeshSpec& mesh, Real factor);

/// Sets unset keys of the scene according to its accuracy, and scales its cells; see docs/guide/choosing_a_kernel.md for measurements.
void settle_accuracy(Scene& scene);

}  // namespace talus
