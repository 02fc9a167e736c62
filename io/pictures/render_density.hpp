#pragma once
// Where bodies end that are given by particles: the level of a density that each particle spreads over its surroundings.
#include <vector>

#include "core/types.hpp"

class vtkPolyData;
template <class T>
class vtkSmartPointer;

namespace talus::render {

/// Particles of one body.
struct Matter {
  std::vector<Vec3> x;       ///< m
  std::vector<Real> volume;  ///< m^3, m^2 in 2-D
  std::vector<Real> value;   ///< one per particle, or none
};

/// Half the median width of the particles [m], a width being the square or cube root of a volume: a surface of triangles that small shows no
/// steps.  Error if there is no particle with a volume.
Real default_spacing(const Matter& matter, int dimension);

/// The surface, triangles that look outwards, or in 2-D the contour, lines that have the body on their left; closed.  Each particle spreads its
/// volume over three times its width by Wendland's C2 kernel, so that the density is one inside and about 1/2 on a plane face.  With values, the point
/// data "value" are their mean around each vertex, weighted by the same kernels.  Nothing if nothing is that dense.
/// Error, with a spacing that would do, if the grid of that spacing [m] has too many points.
vtkSmartPointer<vtkPolyData> surface_of(const Matter& matter, int dimension, Real spacing, Real level);

/// What a closed surface encloses [m^3], or closed lines [m^2]; positive if it looks outwards.
Real enclosed(vtkPolyData* surface, int dimension);

}  // namespace talus::render
