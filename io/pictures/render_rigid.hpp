#pragma once
// Rigid bodies in pictures.
#include <optional>

#include "io/output/vtk.hpp"
#include "io/pictures/render_canvas.hpp"

class vtkRenderer;

namespace talus::render {

/// The surfaces of the rigid bodies of a run at a time [s], from the files that rigid.pvd lists; nothing without them.  Throws
/// EnvironmentError if one cannot be read.
std::optional<StoredMesh> read_rigid(const std::filesystem::path& folder, Real time);

/// Draws picture.rigid: grey, in 3-D shaded by the light.
void add_rigid(vtkRenderer* scene, const Picture& picture);

}  // namespace talus::render
