#pragma once
// `accuracy: draft | standard | fine`: one word for the choices that trade time for accuracy.
#include "io/scene/scene.hpp"

namespace talus {

/// Multiplies the sizes of all cells that Talus makes itself.  Meshes from files stay as they are.
void scale_cells(MeshSpec& mesh, Real factor);

/// Sets what the scene leaves open by its accuracy, and scales its cells; see docs/guide/choosing_a_kernel.md for what was measured.
void settle_accuracy(Scene& scene);

}  // namespace talus
