#pragma once
// Where bodies were: lines over the particles as they are now.
#include <map>

#include "io/pictures/render_camera.hpp"
#include "io/pictures/render_data.hpp"

namespace talus::render {

/// The contour of each body in 2-D; in 3-D the edge of each as the camera sees it, and its sharp edges.
Lines outline_of(const std::map<int, Matter>& bodies, int dimension, const Camera& camera);

}  // namespace talus::render
