#pragma once
// The ground of a run in terrain: a shaded surface with contours in 3-D, a line in 2-D.
#include "io/pictures/render_canvas.hpp"

class vtkRenderer;

namespace talus::render {

/// Colour of the line where layers end.
inline constexpr Colour layer_colour{92, 58, 22};

/// Draws picture.ground, and where its layers end, where there is ground.  `over`: what lies over the particles.
void add_ground(vtkRenderer* scene, vtkRenderer* over, const Picture& picture);

/// Lines at round elevations: the multiples of `step` [m] along `up`.  Points are relative to nothing, as the nodes are.
Lines contours_of(const RigidGround& ground, const Vec3& up, Real step);

}  // namespace talus::render
