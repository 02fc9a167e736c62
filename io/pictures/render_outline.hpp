#pragma once
// Outlines of bodies at another time, drawn over the present particles.
#include <map>

#include "io/pictures/render_camera.hpp"
#include "io/pictures/render_data.hpp"

namespace talus::render {

/// The contour of each body in 2-D; in 3-D the silhouette of each body from the camera, and its sharp edges.
Lines outline_of(const std::map<int, Matter>& bodies, int dimension, const Camera& camera);

}  // namespace talus::render
