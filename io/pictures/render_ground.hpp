#pragma once
// The ground of a run on terrain: a shaded surface with contours in 3-D, a line in 2-D.
#include "io/pictures/render_canvas.hpp"

class vtkRenderer;

namespace talus::render {

/// The colour of the boundaries of layers.
inline constexpr Colour layer_colour{92, 58, 22};

/// Draws picture.ground and the boundaries of its layers, if there is a ground.  `over`: the renderer for lines over the particles.
void add_ground(vtkRenderer* scene, vtkRenderer* over, const Picture& picture);

/// Contours at multiples of `step` [m] along `up`, in the coordinates of the nodes.
Lines contours_of(const RigidGround& ground, const Vec3& up, Real step);

}  // namespace talus::render
