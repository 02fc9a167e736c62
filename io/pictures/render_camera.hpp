#pragma once
// The camera of a picture, and the part of the picture that the particles fill.
#include <array>
#include <variant>
#include <vector>

#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

/// A camera at `centre + distance * towards` that looks at `centre`.
struct Camera {
  Vec3 centre = Vec3::Zero();  ///< in m
  Vec3 towards, up;            ///< orthogonal unit vectors
  Real distance{};             ///< in m
  bool perspective{};
  Real slope{};        ///< perspective: slope of the upper edge of the view relative to its centre line
  Real half_height{};  ///< parallel projection: half the visible height [m]
};

/// The direction of the light: from above and behind the left shoulder of the viewer.
Vec3 light_of(const Camera& camera);

/// Directions towards the camera, and upwards in the picture.
struct Viewpoint {
  Vec3 towards, up;
};
/// The viewpoint; front has x to the right, or y where x is up, and the other views follow from it.
Viewpoint viewpoint(const std::variant<Vec3, NamedView>& view, const Vec3& up);

inline constexpr Real letter_height = 0.019;  // fraction of the picture's width

/// The part of the picture for the particles, in fractions of its width and height from the lower left.
struct Panel {
  Real left, bottom, right, top;
  Real width() const noexcept { return right - left; }
  Real height() const noexcept { return top - bottom; }
};
/// The panel, with room for the title above, the length scale below and the colour bar on the right.
Panel panel_of(const std::array<int, 2>& size);
/// The height [pixels] of a picture of that width whose panel has the width over height `aspect`.
Real height_for(int width, Real aspect);

/// A camera for which all `points` are in a panel of the given width over height, with a margin.
Camera fit_camera(const std::vector<Vec3>& points, const Viewpoint& from, bool perspective, Real aspect);
/// A camera for a window [m] of a 2-D run, given by its low and high corner; the view is larger in at most one direction.
Camera window_camera(const std::array<Real, 4>& window, Real aspect);
/// Magnifies the view by a factor, about the middle of the picture.
void zoom_in(Real factor, Camera& camera);
/// The width over height of the points from that viewpoint.
Real aspect_of(const std::vector<Vec3>& points, const Viewpoint& from);

}  // namespace talus::render
