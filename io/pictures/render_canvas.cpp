// Draws particles, outline, colour bar and texts with VTK.
#include "io/pictures/render_canvas.hpp"
#include <Eigen/Geometry>

#include <vtkActor.h>
#include <vtkBoundingBox.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointGaussianMapper.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/pictures/render_ground.hpp"
#include "io/pictures/render_legend.hpp"
#include "io/pictures/render_png.hpp"
#include "io/pictures/render_rigid.hpp"
#include "io/pictures/render_sheet.hpp"

namespace talus::render {

namespace {

namespace fs = std::filesystem;

constexpr Colour grey{178, 178, 178}, edge_grey{140, 140, 140};
constexpr auto radius_name = "radius";
constexpr Real shadow = 0.45;        // brightness of a surface that faces away from the light
constexpr Real gloss = 0.14;         // white added to a surface that faces the light, so that dark colours show the shape too
constexpr Real shading_reach = 3.0;  // radius, in radii of particles, over which the surface normal is averaged

vtkSmartPointer<vtkPolyData> coloured(const Picture& picture, const Cloud& cloud)
{
  vtkNew<vtkPoints> points;
  points->SetNumberOfPoints(static_cast<vtkIdType>(cloud.x.size()));
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  colours->SetNumberOfTuples(static_cast<vtkIdType>(cloud.x.size()));
  const Vec3 light = light_of(picture.camera);
  const auto lit = picture.dimension == 3 ? facing(cloud, light, shading_reach * picture.radius) : std::vector<Real>{};
  for (std::size_t p = 0; p < cloud.x.size(); ++p) {
    // Relative to the centre, because the single precision of the graphics would show steps at map coordinates.
    const Vec3 x = cloud.x[p] - picture.camera.centre;
    points->SetPoint(static_cast<vtkIdType>(p), x.data());
    const Colour plain = picture.scale.colour(cloud.value[p]);
    const Real shaded = lit.empty() ? 1 : 1 - shadow * 0.5 * (1 - lit[p]);
    const Real white = lit.empty() ? 0 : gloss * std::max(0.0, lit[p]);
    for (int c = 0; c < 3; ++c)
      colours->SetComponent(static_cast<vtkIdType>(p), c, std::lerp(shaded * plain[static_cast<std::size_t>(c)], 255.0, white));
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->GetPointData()->SetScalars(colours);
  const std::vector<Real> radii = picture.dimension == 2 ? closing_radii(numbers_of(cloud.x), picture.radius, picture.spread.of(cloud.ids))
                                                         : std::vector<Real>(cloud.x.size(), picture.radius);
  vtkNew<vtkDoubleArray> widths;
  widths->SetName(radius_name);
  for (const Real radius : radii)
    widths->InsertNextValue(radius);
  data->GetPointData()->AddArray(widths);
  return data;
}

void add_particles(vtkRenderer* renderer, const Picture& picture, const Cloud& cloud)
{
  vtkNew<vtkPointGaussianMapper> mapper;
  mapper->SetInputData(coloured(picture, cloud));
  mapper->SetScaleFactor(1);
  mapper->SetScaleArray(radius_name);
  mapper->EmissiveOff();
  mapper->SetTriangleScale(1);  // the disc fills the triangle, so no fragments are wasted
  mapper->SetSplatShaderCode(
      "//VTK::Color::Impl\n"
      "if (dot(offsetVCVSOutput.xy, offsetVCVSOutput.xy) > 1.0) discard;\n");
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  renderer->AddActor(actor);
}

/// Sets both renderers to the panel, so that nothing is drawn behind the texts, with the same camera, whose clipping range contains the
/// objects of both.
void aim(vtkRenderer* scene, vtkRenderer* over, const Camera& camera, const Panel& panel)
{
  for (vtkRenderer* renderer : {scene, over})
    renderer->SetViewport(panel.left, panel.bottom, panel.right, panel.top);
  vtkCamera* eye = scene->GetActiveCamera();
  over->SetActiveCamera(eye);
  const Vec3 place = camera.distance * camera.towards;
  eye->SetFocalPoint(0, 0, 0);
  eye->SetPosition(place.data());
  eye->SetViewUp(camera.up.data());
  eye->SetParallelProjection(camera.perspective ? 0 : 1);
  eye->SetParallelScale(camera.half_height);
  if (camera.perspective)
    eye->SetViewAngle(360 / std::numbers::pi * std::atan(camera.slope));
  vtkBoundingBox all;
  for (vtkRenderer* renderer : {scene, over})
    if (std::array<double, 6> bounds{}; renderer->ComputeVisiblePropBounds(bounds.data()), vtkMath::AreBoundsInitialized(bounds.data()))
      all.AddBounds(bounds.data());
  if (std::array<double, 6> bounds{}; all.IsValid()) {
    all.GetBounds(bounds.data());
    scene->ResetCameraClippingRange(bounds.data());
  }
}

}  // namespace

void add_lines(vtkRenderer* renderer, const Picture& picture, const Lines& lines, const Pen& pen)
{
  vtkNew<vtkPoints> points;
  for (const Vec3& point : lines.points) {
    const Vec3 x = point - picture.camera.centre;
    points->InsertNextPoint(x.data());
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& [a, b] : lines.ends) {
    cells->InsertNextCell(2);
    cells->InsertCellPoint(a);
    cells->InsertCellPoint(b);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(cells);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(channels(pen.colour).data());
  actor->GetProperty()->SetLineWidth(pen.width * oversampling);
  actor->GetProperty()->SetOpacity(pen.opacity);
  actor->GetProperty()->LightingOff();
  renderer->AddActor(actor);
}

void draw(const Picture& picture, const Cloud& cloud, const fs::path& png)
{
  const Panel panel = panel_of(picture.size);
  vtkNew<vtkRenderWindow> window;
  prepare(window, picture.size);
  vtkNew<vtkRenderer> paper, scene, over, front;  // white beside the panel; solid objects; lines over them; texts
  window->SetNumberOfLayers(3);
  int layer = 0;
  for (vtkRenderer* renderer : {paper.Get(), scene.Get(), over.Get(), front.Get()}) {
    renderer->SetBackground(1, 1, 1);
    renderer->SetLayer(std::max(0, layer++ - 1));
    window->AddRenderer(renderer);
  }
  front->InteractiveOff();

  const bool edges = picture.mesh_lines == MeshLines::edges;
  add_ground(scene, over, picture);
  add_lines(edges && picture.dimension == 2 ? over : scene, picture, picture.mesh, edges ? Pen{edge_grey, 0.75, 0.9} : Pen{grey, 1.5, 1});
  add_particles(scene, picture, cloud);
  add_rigid(picture.dimension == 2 ? over : scene, picture);
  add_lines(over, picture, picture.start, {start_colour, 1.5, 1});
  aim(scene, over, picture.camera, panel);

  Sheet sheet(front, letter_height * oversampling * picture.size[0]);
  add_words(sheet, picture, cloud);
  save(window, png);
}

}  // namespace talus::render
