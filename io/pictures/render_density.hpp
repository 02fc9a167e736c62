#pragma once
// Surfaces of bodies given by particles: an iso-surface of a density to which each particle contributes around it.
#include <vector>

#include "core/types.hpp"

class vtkPolyData;
template <class T>
class vtkSmartPointer;

namespace talus::render {

/// The particles of one body.
struct Matter {
  std::vector<Vec3> x;       ///< positions [m]
  std::vector<Real> volume;  ///< m^3, m^2 in 2-D
  std::vector<Real> value;   ///< one per particle, or empty
};

/// Half the median width of the particles [m], where the width is the square or cube root of the volume: triangles of that size show no
/// steps.  Throws Error if no particle has a volume.
Real default_spacing(const Matter& matter, int dimension);

/// The surface, made of triangles that face outwards, or in 2-D the contour, made of lines with the body on their left; closed.  The volume
/// of each particle is spread over three times its width by Wendland's C2 kernel, so that the density is one inside and about 1/2 on a
/// plane face.  With values, the point data "value" are their mean around each vertex, weighted by the same kernels.  Empty if the density
/// is below 1/2 everywhere.  Throws Error, with a sufficient spacing, if the grid of that spacing [m] has too many points.
vtkSmartPointer<vtkPolyData> surface_of(const Matter& matter, int dimension, Real spacing, Real level);

/// The volume [m^3] inside a closed surface, or the area [m^2] inside closed lines; positive for outward orientation.
Real enclosed(vtkPolyData* surface, int dimension);

}  // namespace talus::render
