#include "io/pictures/render_ground.hpp"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>

#include "io/pictures/render_words.hpp"

namespace talus::render {

namespace {

constexpr Real darkest = 0.4;          // brightness of ground that faces away from the light
constexpr Colour rock{236, 231, 222};  // colour of ground that faces the light
constexpr Colour contour_colour{150, 138, 122}, rigid_colour{110, 96, 80};
constexpr Real sharp_edge = 40;           // angle [degrees] between facets above which their normals are not averaged
constexpr Real contours_of_picture = 16;  // approximate number of contours over the height of the ground

Vec3 node(const RigidGround& ground, Index n) { return Eigen::Map<const Vec3>(ground.nodes.data() + 3 * static_cast<std::size_t>(n)); }

vtkSmartPointer<vtkPolyData> surface_of(const RigidGround& ground, const Vec3& centre)
{
  vtkNew<vtkPoints> points;
  for (std::size_t n = 0; n < ground.nodes.size() / 3; ++n) {
    const Vec3 x = node(ground, static_cast<Index>(n)) - centre;
    points->InsertNextPoint(x.data());
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& triangle : ground.triangles) {
    cells->InsertNextCell(3);
    for (const Index n : triangle)
      cells->InsertCellPoint(n);
  }
  vtkNew<vtkPolyData> bare;
  bare->SetPoints(points);
  bare->SetPolys(cells);
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(bare);
  normals->SetFeatureAngle(sharp_edge);
  normals->Update();
  return normals->GetOutput();
}

/// Sets the brightness from the angle between the surface, as seen from above, and the light.
void shade(vtkPolyData* surface, const Vec3& up, const Vec3& light)
{
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  colours->SetNumberOfTuples(surface->GetNumberOfPoints());
  vtkDataArray* normals = surface->GetPointData()->GetNormals();
  for (vtkIdType n = 0; n < surface->GetNumberOfPoints(); ++n) {
    Vec3 normal = Eigen::Map<const Vec3>(normals->GetTuple3(n));
    if (normal.dot(up) < 0)
      normal = -normal;
    const Real bright = std::lerp(darkest, Real{1}, std::clamp(normal.dot(light), Real{0}, Real{1}));
    for (int c = 0; c < 3; ++c)
      colours->SetComponent(n, c, bright * rock[static_cast<std::size_t>(c)]);
  }
  surface->GetPointData()->SetScalars(colours);
}

/// Cuts the ground at the same plane as the particles.
void cut(vtkMapper* mapper, const Picture& picture)
{
  if (!picture.clip)
    return;
  const Vec3 normal = -picture.clip->normal;
  const Vec3 place = picture.clip->offset / picture.clip->normal.squaredNorm() * picture.clip->normal - picture.camera.centre;
  vtkNew<vtkPlane> plane;
  plane->SetNormal(normal[0], normal[1], normal[2]);
  plane->SetOrigin(place[0], place[1], place[2]);
  mapper->AddClippingPlane(plane);
}

void add_surface(vtkRenderer* renderer, const Picture& picture)
{
  const auto surface = surface_of(*picture.ground, picture.camera.centre);
  shade(surface, picture.upwards, light_of(picture.camera));
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(surface);
  vtkMapper::SetResolveCoincidentTopologyToPolygonOffset();  // draws lines in front of the surface that they lie on
  cut(mapper, picture);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  renderer->AddActor(actor);
}

Lines lines_between(const std::vector<Edge>& edges, const RigidGround& ground)
{
  Lines lines;
  for (std::size_t n = 0; n < ground.nodes.size() / 3; ++n)
    lines.points.push_back(node(ground, static_cast<Index>(n)));
  lines.ends = edges;
  return lines;
}

Real step_between_contours(const RigidGround& ground, const Vec3& up)
{
  Real low = std::numeric_limits<Real>::max(), high = -low;
  for (std::size_t n = 0; n < ground.nodes.size() / 3; ++n) {
    const Real z = node(ground, static_cast<Index>(n)).dot(up);
    low = std::min(low, z), high = std::max(high, z);
  }
  return high > low ? round_below(1.5 * (high - low) / contours_of_picture) : 0;
}

}  // namespace

Lines contours_of(const RigidGround& ground, const Vec3& up, Real step)
{
  Lines lines;
  if (!(step > 0))
    return lines;
  for (const auto& triangle : ground.triangles) {
    std::array<Vec3, 3> x;
    std::array<Real, 3> z{};
    for (std::size_t a = 0; a < 3; ++a)
      x[a] = node(ground, triangle[a]), z[a] = x[a].dot(up) / step;
    const auto [low, high] = std::minmax_element(z.begin(), z.end());
    for (Real level = std::floor(*low) + 1; level <= *high; ++level) {
      const auto first = static_cast<Index>(lines.points.size());
      for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t b = (a + 1) % 3;
        if ((z[a] < level) != (z[b] < level))
          lines.points.emplace_back(x[a] + (level - z[a]) / (z[b] - z[a]) * (x[b] - x[a]));
      }
      if (static_cast<Index>(lines.points.size()) == first + 2)
        lines.ends.push_back({first, first + 1});
    }
  }
  return lines;
}

void add_ground(vtkRenderer* scene, vtkRenderer* over, const Picture& picture)
{
  if (!picture.ground)
    return;
  const RigidGround& ground = *picture.ground;
  const bool flat = picture.dimension == 2;
  if (flat) {
    add_lines(over, picture, lines_between(ground.lines, ground), {rigid_colour, 2.5F, 1});
  } else {
    add_surface(scene, picture);
    add_lines(scene, picture, contours_of(ground, picture.upwards, step_between_contours(ground, picture.upwards)),
              {contour_colour, 0.7F, 1});
  }
  add_lines(flat ? over : scene, picture, lines_between(ground.layers, ground), {layer_colour, 2.0F, 1});
}

}  // namespace talus::render
