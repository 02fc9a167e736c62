// Camera positions for which the visible points fill the panel.
#include "io/pictures/render_camera.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "io/pictures/render_data.hpp"

namespace talus::render {

namespace {

constexpr Real panel_margin = 0.03;  // fraction of the panel, on each side
constexpr Real panel_right = 0.85;   // fraction of the picture's width
constexpr Real view_angle = 25;      // vertical angle of view [degrees]
constexpr Real degree = std::numbers::pi / 180;
constexpr Real above = 2.6, below = 2.4;  // title and length scale, in letter heights

struct Axes {
  Vec3 right, up, towards;
};

Axes axes_of(const Vec3& towards, const Vec3& up)
{
  const Vec3 t = towards.normalized();
  const Vec3 right = up.cross(t).normalized();
  return {right, t.cross(right), t};
}

/// The coordinates of the points along the directions right, up, and towards the camera.
std::vector<Vec3> seen(const std::vector<Vec3>& points, const Axes& axes)
{
  std::vector<Vec3> out;
  out.reserve(points.size());
  for (const Vec3& x : points)
    out.emplace_back(x.dot(axes.right), x.dot(axes.up), x.dot(axes.towards));
  return out;
}

/// The distance at which all points are visible, with the camera looking at (centre[0], centre[1]) along the third axis.
Real distance_for(const std::vector<Vec3>& points, const Vec3& centre, Real slope_x, Real slope_y)
{
  Real distance = 0;
  for (const Vec3& p : points) {
    const Vec3 q = p - centre;
    distance = std::max({distance, q[2] + std::abs(q[0]) / slope_x, q[2] + std::abs(q[1]) / slope_y});
  }
  return distance;
}

/// Moves the centre so that the outermost points are equally near to opposite sides of the panel.
void balance(const std::vector<Vec3>& points, Vec3& centre, Real distance)
{
  Vec3 low = Vec3::Constant(std::numeric_limits<Real>::max()), high = -low;
  for (const Vec3& p : points) {
    const Vec3 slope = (p - centre) / (distance - (p - centre)[2]);
    low = low.cwiseMin(slope);
    high = high.cwiseMax(slope);
  }
  centre.head<2>() += 0.5 * distance * (low + high).head<2>();
}

}  // namespace

Viewpoint viewpoint(const std::variant<Vec3, NamedView>& view, const Vec3& up)
{
  if (const auto* towards = std::get_if<Vec3>(&view))
    return {*towards, up};
  Index vertical = 0;
  up.cwiseAbs().maxCoeff(&vertical);
  const Vec3 right = vertical == 0 ? Vec3::UnitY() : Vec3::UnitX();
  const Vec3 front = right.cross(up).normalized();
  switch (std::get<NamedView>(view)) {
    case NamedView::front: return {front, up};
    case NamedView::back: return {-front, up};
    case NamedView::left: return {-right, up};
    case NamedView::right: return {right, up};
    case NamedView::top: return {up, -front};
    case NamedView::iso: break;
  }
  return {front + right + up.normalized(), up};
}

Vec3 light_of(const Camera& camera)
{
  const Vec3 right = camera.up.cross(camera.towards);
  return (0.35 * camera.towards + 0.85 * camera.up - 0.4 * right).normalized();
}

Panel panel_of(const std::array<int, 2>& size)
{
  const Real letter = letter_height * size[0] / size[1];
  return {0, below * letter, panel_right, 1 - above * letter};
}

Real height_for(int width, Real aspect) { return width * (panel_right / aspect + (above + below) * letter_height); }

Real aspect_of(const std::vector<Vec3>& points, const Viewpoint& from)
{
  const auto bounds = bounds_of(seen(points, axes_of(from.towards, from.up)));
  if (!bounds)
    return 1;
  const Vec3 size = bounds->high - bounds->low;
  return size[1] > 0 && size[0] > 0 ? size[0] / size[1] : 1;
}

Camera fit_camera(const std::vector<Vec3>& points, const Viewpoint& from, bool perspective, Real aspect)
{
  const Axes axes = axes_of(from.towards, from.up);
  const auto projected = seen(points, axes);
  const Bounds bounds = bounds_of(projected).value_or(Bounds{-Vec3::Ones(), Vec3::Ones()});
  Vec3 centre = 0.5 * (bounds.low + bounds.high);
  const Vec3 half = 0.5 * (bounds.high - bounds.low);
  const Real room = 1 - 2 * panel_margin;
  Camera camera{.towards = axes.towards, .up = axes.up, .perspective = perspective, .slope = std::tan(0.5 * view_angle * degree)};
  camera.half_height = std::max(half[1], half[0] / aspect) / room;
  if (camera.half_height <= 0)
    camera.half_height = 1;
  camera.distance = 4 * std::max(half.norm(), camera.half_height);
  if (perspective && half.norm() > 0) {
    const Real slope_y = camera.slope * room;
    for (int i = 0; i < 5; ++i) {  // converges by a factor of about ten in each iteration
      camera.distance = distance_for(projected, centre, slope_y * aspect, slope_y);
      balance(projected, centre, camera.distance);
    }
    camera.distance = distance_for(projected, centre, slope_y * aspect, slope_y);
  }
  camera.centre = centre[0] * axes.right + centre[1] * axes.up + centre[2] * axes.towards;
  return camera;
}

Camera window_camera(const std::array<Real, 4>& window, Real aspect)
{
  const Real half_width = 0.5 * (window[2] - window[0]), half_height = 0.5 * (window[3] - window[1]);
  Camera camera{.centre = Vec3(window[0] + half_width, window[1] + half_height, 0), .towards = Vec3::UnitZ(), .up = Vec3::UnitY()};
  camera.half_height = std::max(half_height, half_width / aspect);
  camera.distance = 4 * std::max(half_width, half_height);
  return camera;
}

void zoom_in(Real factor, Camera& camera)
{
  camera.half_height /= factor;
  camera.slope /= factor;
}

}  // namespace talus::render
