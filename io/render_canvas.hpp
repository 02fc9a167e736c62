#pragma once
// One picture: particles in their colours, the mesh outline, a colour bar, and words, drawn off screen and saved as PNG.
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "io/render_data.hpp"

namespace talus::render {

using Colour = std::array<unsigned char, 3>;

/// Viridis, readable with any kind of colour blindness and in grey.  share in [0, 1]; outside is clamped, NaN is grey.
Colour colour_of(Real share);

/// Camera: looks at `centre` from `centre + distance * towards`.
struct Camera {
  Vec3 centre = Vec3::Zero();  ///< m
  Vec3 towards, up;            ///< unit vectors, normal to each other
  Real distance{};             ///< m
  bool perspective{};
  Real half_height{};  ///< m, of what is seen, if parallel
};

inline constexpr Real letter_height = 0.019;  // of the picture's width
inline constexpr Real view_angle = 25;        // degrees, over the height of the panel

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
Camera fit_camera(const std::vector<Vec3>& points, const Vec3& towards, const Vec3& up, bool perspective, Real aspect);
/// Width over height of the points as that camera direction sees them.
Real aspect_of(const std::vector<Vec3>& points, const Vec3& towards, const Vec3& up);

struct Picture {
  std::array<int, 2> size;  ///< pixels
  Camera camera;
  int dimension{};
  Real radius{};                ///< m, of a particle as drawn
  std::array<Real, 2> range{};  ///< values at the two ends of the colour bar, SI
  std::string title;
  Real time{};  ///< s
};

/// Draws and writes.  Needs a display (X11); the caller has looked for one.  EnvironmentError if the file cannot be written.
void draw(const Picture& picture, const Cloud& cloud, const Outline& outline, const std::filesystem::path& png);

}  // namespace talus::render
