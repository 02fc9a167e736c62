#include "app/observers/rigid_frame.hpp"

#include <cmath>
#include <numbers>

namespace talus {

namespace {

constexpr Index around = 48;  ///< sides of a circle that is drawn

template <int D>
struct DrawnSurface {
  std::vector<Vec<D>> corners;
  std::vector<std::array<Index, 3>> triangles;
};

DrawnSurface<2> surface_of_ball(const RigidShape<2>& shape)
{
  DrawnSurface<2> ball{{Vec<2>::Zero()}, {}};
  for (Index i = 0; i < around; ++i) {
    const Real angle = 2 * std::numbers::pi * i / around;
    ball.corners.push_back(shape.radius() * Vec<2>(std::cos(angle), std::sin(angle)));
    ball.triangles.push_back({0, 1 + i, 1 + (i + 1) % around});
  }
  return ball;
}

DrawnSurface<3> surface_of_ball(const RigidShape<3>& shape)
{
  DrawnSurface<3> ball;
  constexpr Index rings = around / 2;
  for (Index j = 0; j <= rings; ++j)
    for (Index i = 0; i < around; ++i) {
      const Real angle = 2 * std::numbers::pi * i / around, height = std::numbers::pi * j / rings;
      ball.corners.push_back(shape.radius() *
                             Vec3(std::sin(height) * std::cos(angle), std::sin(height) * std::sin(angle), -std::cos(height)));
    }
  for (Index j = 0; j < rings; ++j)
    for (Index i = 0; i < around; ++i) {
      const Index next = (i + 1) % around, low = j * around, high = low + around;
      if (j > 0)
        ball.triangles.push_back({low + i, low + next, high + next});
      if (j + 1 < rings)
        ball.triangles.push_back({low + i, high + next, high + i});
    }
  return ball;
}

/// Twice the signed area of a triangle.
Real turn(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) { return (b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0]; }

/// Triangles that fill a simple counterclockwise polygon, cut off one after the other (ear clipping).
std::vector<std::array<Index, 3>> filled(const std::vector<Vec<2>>& corners, std::vector<Index> left)
{
  std::vector<std::array<Index, 3>> triangles;
  const auto place = [&](Index corner) { return corners[static_cast<std::size_t>(corner)]; };
  while (left.size() > 3) {
    std::size_t best = 0;  // without an ear, as round-off may have it, any corner
    for (std::size_t i = 0; i < left.size(); ++i) {
      const Index a = left[(i + left.size() - 1) % left.size()], b = left[i], c = left[(i + 1) % left.size()];
      const auto lies_inside = [&](Index k) {
        return k != a && k != b && k != c && turn(place(a), place(b), place(k)) >= 0 && turn(place(b), place(c), place(k)) >= 0 &&
               turn(place(c), place(a), place(k)) >= 0;
      };
      if (turn(place(a), place(b), place(c)) > 0 && std::ranges::none_of(left, lies_inside)) {
        best = i;
        break;
      }
    }
    triangles.push_back({left[(best + left.size() - 1) % left.size()], left[best], left[(best + 1) % left.size()]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

DrawnSurface<2> surface_of_facets(const FacetSurface<2>& facets)
{
  std::vector<Index> next(facets.corners().size()), order;
  for (const auto& facet : facets.facets())
    next[static_cast<std::size_t>(facet[0])] = facet[1];
  for (Index corner = 0; order.size() < next.size(); corner = next[static_cast<std::size_t>(corner)])
    order.push_back(corner);
  return {facets.corners(), filled(facets.corners(), std::move(order))};
}
DrawnSurface<3> surface_of_facets(const FacetSurface<3>& facets) { return {facets.corners(), facets.facets()}; }

/// In 2-D a sheet is drawn as wide as this times the radius of the circle around it: a line would not be seen.
constexpr Real width_of_sheet = 0.03;

DrawnSurface<2> surface_of_sheet(const RigidShape<2>& shape)
{
  DrawnSurface<2> sheet;
  for (const auto& facet : shape.facets()->facets()) {
    const auto first = static_cast<Index>(sheet.corners.size());
    std::array<Vec<2>, 2> ends;
    for (std::size_t k = 0; k < 2; ++k)
      ends[k] = shape.facets()->corners()[static_cast<std::size_t>(facet[k])];
    const Vec<2> aside = 0.5 * width_of_sheet * shape.radius() * area_of<2>(ends.data()).normalized();
    for (const Vec<2>& end : ends)
      sheet.corners.insert(sheet.corners.end(), {end - aside, end + aside});
    sheet.triangles.push_back({first, first + 2, first + 3});
    sheet.triangles.push_back({first, first + 3, first + 1});
  }
  return sheet;
}
DrawnSurface<3> surface_of_sheet(const RigidShape<3>& shape) { return surface_of_facets(*shape.facets()); }

template <int D>
DrawnSurface<D> drawn(const RigidShape<D>& shape)
{
  if (shape.is_ball())
    return surface_of_ball(shape);
  return shape.is_sheet() ? surface_of_sheet(shape) : surface_of_facets(*shape.facets());
}

}  // namespace

template <int D>
Frame::MeshFile rigid_of_frame(const RunView<D>& view, std::filesystem::path file)
{
  Frame::MeshFile part{std::move(file), {.dimension = 2, .nodes = {}, .positions = {}, .cells = {}, .corners = {}}, {}};
  Column body{.name = "rigid", .components = 1, .values = {}}, velocity{.name = "velocity", .components = 3, .values = {}, .unit = "m/s"};
  Index first = 0;
  for (std::size_t r = 0; r < view.state.rigid.size(); ++r) {
    const RigidState<D>& state = view.state.rigid[r];
    const RigidShape<D>& shape = *view.problem.rigid.bodies[r].shape;
    const DrawnSurface<D> surface = drawn(shape);
    for (const Vec<D>& corner : surface.corners) {
      const Vec<D> place = state.x + state.in_scene(corner), v = state.velocity_at(place);
      for (Index d = 0; d < 3; ++d) {
        part.mesh.positions.push_back(d < D ? place[std::min(d, D - 1)] : 0);
        velocity.values.push_back(d < D ? static_cast<float>(v[std::min(d, D - 1)]) : 0);
      }
      body.values.push_back(static_cast<float>(r));
    }
    for (const auto& triangle : surface.triangles)
      for (const Index corner : triangle)
        part.mesh.corners.push_back(first + corner);
    first += static_cast<Index>(surface.corners.size());
  }
  part.mesh.nodes.of_all = first;
  part.mesh.cells.of_all = static_cast<std::int64_t>(part.mesh.corners.size() / 3);
  part.columns = {std::move(body), std::move(velocity)};
  return part;
}

template Frame::MeshFile rigid_of_frame<2>(const RunView<2>&, std::filesystem::path);
template Frame::MeshFile rigid_of_frame<3>(const RunView<3>&, std::filesystem::path);

}  // namespace talus
