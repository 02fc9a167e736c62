#pragma once
// From where a picture is seen, and the part of the sheet that it fills.
#include <array>
#include <variant>
#include <vector>

#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

/// Looks at `centre` from `centre + distance * towards`.
struct Camera {
  Vec3 centre = Vec3::Zero();  ///< m
  Vec3 towards, up;            ///< unit vectors, normal to each other
  Real distance{};             ///< m
  bool perspective{};
  Real slope{};        ///< of the upper edge of what is seen against the middle, if in perspective
  Real half_height{};  ///< m, of what is seen, if parallel
};

/// From where the light falls: from above, over the reader's left shoulder.
Vec3 light_of(const Camera& camera);

/// Directions to the camera, and upwards in the picture.
struct Viewpoint {
  Vec3 towards, up;
};
/// front: x to the right, or y where x is up; the others from there.
Viewpoint viewpoint(const std::variant<Vec3, NamedView>& view, const Vec3& up);

inline constexpr Real letter_height = 0.019;  // of the picture's width

/// Part of the picture, in shares of its width and height from the lower left, that the particles may fill.
struct Panel {
  Real left, bottom, right, top;
  Real width() const noexcept { return right - left; }
  Real height() const noexcept { return top - bottom; }
};
/// Leaves room for the title above, the length scale below and the colour bar on the right.
Panel panel_of(const std::array<int, 2>& size);
/// Height [pixels] of a picture of that width whose panel has the width over height `aspect`.
Real height_for(int width, Real aspect);

/// A camera that sees all `points` in a panel of the given width over height, with a margin.
Camera fit_camera(const std::vector<Vec3>& points, const Viewpoint& from, bool perspective, Real aspect);
/// A camera that sees the window [m] of a 2-D run, low corner and high corner, and nothing more in one of the directions.
Camera window_camera(const std::array<Real, 4>& window, Real aspect);
/// Everything larger by that factor, about the middle of the picture.
void zoom_in(Real factor, Camera& camera);
/// Width over height of the points as seen from there.
Real aspect_of(const std::vector<Vec3>& points, const Viewpoint& from);

}  // namespace talus::render
