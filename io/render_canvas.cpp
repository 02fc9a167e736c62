// Particles, outline, colour bar and words with VTK.
#include "io/render_canvas.hpp"
#include <Eigen/Geometry>

#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
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

#include "core/error.hpp"
#include "core/units.hpp"
#include "io/render_png.hpp"
#include "io/render_sheet.hpp"
#include "io/render_words.hpp"

namespace talus::render {

namespace {

namespace fs = std::filesystem;

constexpr Colour grey{178, 178, 178}, no_value{190, 190, 190};
constexpr Real shadow = 0.45;        // brightness taken from a surface that turns its back on the light
constexpr Real gloss = 0.14;         // white added to a surface that faces it: without it the dark end of the colours shows no shape
constexpr Real shading_reach = 3.0;  // radii of particles over which the surface normal is averaged

/// Seventeen points of viridis (S. van der Walt, N. Smith, 2015, CC0); straight lines between them stay within 0.022 of it.
constexpr std::array<std::uint32_t, 17> viridis{0x440154, 0x48186a, 0x472d7b, 0x424086, 0x3b528b, 0x33638d, 0x2c728e, 0x26828e, 0x21918c,
                                                0x1fa088, 0x28ae80, 0x3fbc73, 0x5ec962, 0x84d44b, 0xaddc30, 0xd8e219, 0xfde725};

Real channel(std::uint32_t rgb, int c) { return static_cast<Real>((rgb >> (16 - 8 * c)) & 0xff); }

vtkSmartPointer<vtkPolyData> coloured(const Picture& picture, const Cloud& cloud)
{
  vtkNew<vtkPoints> points;
  points->SetNumberOfPoints(static_cast<vtkIdType>(cloud.x.size()));
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  colours->SetNumberOfTuples(static_cast<vtkIdType>(cloud.x.size()));
  const Vec3 right = picture.camera.up.cross(picture.camera.towards);
  const Vec3 light = (0.35 * picture.camera.towards + 0.85 * picture.camera.up - 0.4 * right).normalized();
  const auto lit = picture.dimension == 3 ? facing(cloud, light, shading_reach * picture.radius) : std::vector<Real>{};
  for (std::size_t p = 0; p < cloud.x.size(); ++p) {
    // Relative to the centre: single precision on the graphics side would show steps at map coordinates.
    const Vec3 x = cloud.x[p] - picture.camera.centre;
    points->SetPoint(static_cast<vtkIdType>(p), x.data());
    const Colour plain = colour_of((cloud.value[p] - picture.range[0]) / (picture.range[1] - picture.range[0]));
    const Real shaded = lit.empty() ? 1 : 1 - shadow * 0.5 * (1 - lit[p]);
    const Real white = lit.empty() ? 0 : gloss * std::max(0.0, lit[p]);
    for (int c = 0; c < 3; ++c)
      colours->SetComponent(static_cast<vtkIdType>(p), c, std::lerp(shaded * plain[static_cast<std::size_t>(c)], 255.0, white));
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->GetPointData()->SetScalars(colours);
  return data;
}

void add_particles(vtkRenderer* renderer, const Picture& picture, const Cloud& cloud)
{
  vtkNew<vtkPointGaussianMapper> mapper;
  mapper->SetInputData(coloured(picture, cloud));
  mapper->SetScaleFactor(picture.radius);
  mapper->EmissiveOff();
  mapper->SetTriangleScale(1);  // the disc fills the triangle: no fragments are spent outside
  mapper->SetSplatShaderCode(
      "//VTK::Color::Impl\n"
      "if (dot(offsetVCVSOutput.xy, offsetVCVSOutput.xy) > 1.0) discard;\n");
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  renderer->AddActor(actor);
}

void add_outline(vtkRenderer* renderer, const Picture& picture, const Outline& outline)
{
  vtkNew<vtkPoints> points;
  for (const Vec3& node : outline.nodes) {
    const Vec3 x = node - picture.camera.centre;
    points->InsertNextPoint(x.data());
  }
  vtkNew<vtkCellArray> lines;
  for (const auto& [a, b] : outline.edges) {
    lines->InsertNextCell(2);
    lines->InsertCellPoint(a);
    lines->InsertCellPoint(b);
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(lines);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(channels(grey).data());
  actor->GetProperty()->SetLineWidth(1.5F * oversampling);
  actor->GetProperty()->LightingOff();
  renderer->AddActor(actor);
}

/// The view fills the picture's height; the camera was fitted to the panel, a part of it.
void aim(vtkRenderer* renderer, const Camera& camera, const Panel& panel)
{
  vtkCamera* eye = renderer->GetActiveCamera();
  const Vec3 place = camera.distance * camera.towards;
  constexpr Real degree = std::numbers::pi / 180;
  eye->SetFocalPoint(0, 0, 0);
  eye->SetPosition(place.data());
  eye->SetViewUp(camera.up.data());
  eye->SetViewAngle(2 / degree * std::atan(std::tan(0.5 * view_angle * degree) / panel.height()));
  eye->SetParallelProjection(camera.perspective ? 0 : 1);
  eye->SetParallelScale(camera.half_height / panel.height());
  eye->SetWindowCenter(0, 1 - (panel.top + panel.bottom));
  renderer->ResetCameraClippingRange();
}

void add_colour_bar(Sheet& sheet, const Picture& picture, const Cloud& cloud, const std::array<Real, 2>& size)
{
  const auto [low, high] = picture.range;
  const auto [factor, unit_name] = scaled_unit(cloud.unit, std::max(std::abs(low), std::abs(high)));
  const Panel panel = panel_of(picture.size);
  const Real left = panel.right * size[0] + 1.2 * sheet.letter(), right = left + sheet.letter();
  const Real bottom = (panel.bottom + 0.06 * panel.height()) * size[1], top = (panel.top - 0.06 * panel.height()) * size[1];
  constexpr int bands = 256;
  for (int b = 0; b < bands; ++b) {
    const Real y0 = bottom + (top - bottom) * b / bands, y1 = bottom + (top - bottom) * (b + 1) / bands;
    sheet.area({{left, y0}, {right, y0}, {right, y1}, {left, y1}}, colour_of((b + 0.5) / bands));
  }
  for (const auto& [value, text] : ticks(factor * low, factor * high)) {
    const Real y = bottom + (top - bottom) * (value - factor * low) / (factor * (high - low));
    sheet.line({{right, y}, {right + 0.3 * sheet.letter(), y}}, ink);
    sheet.text(text, right + 0.5 * sheet.letter(), y);
  }
  const bool bare = unit_name.empty() || unit_name == "-";
  sheet.text(bare ? cloud.label : fmt::format("{} [{}]", cloud.label, unit_name), size[0] - sheet.letter(), 0.5 * (bottom + top),
             Side::centre, {.upright = true});
}

/// 2-D: a length to measure by.
void add_scale(Sheet& sheet, const Picture& picture, const std::array<Real, 2>& size)
{
  const Real pixels_per_metre = panel_of(picture.size).height() * size[1] / (2 * picture.camera.half_height);
  const Real length = round_below(0.2 * size[0] / pixels_per_metre);
  const Real left = 1.2 * sheet.letter(), right = left + length * pixels_per_metre, y = 1.2 * sheet.letter(), tip = 0.3 * sheet.letter();
  sheet.line({{left, y + tip}, {left, y - tip}, {left, y}, {right, y}, {right, y + tip}, {right, y - tip}}, ink);
  sheet.text(length < 0.1 ? fmt::format("{:g} mm", 1e3 * length) : fmt::format("{:g} m", length), right + 0.5 * sheet.letter(), y);
}

/// 3-D: which way the axes point.
void add_axes(Sheet& sheet, const Picture& picture)
{
  const Vec3 right = picture.camera.up.cross(picture.camera.towards);
  const Real arm = 2.2 * sheet.letter(), x0 = 3.4 * sheet.letter(), y0 = 2.6 * sheet.letter();
  for (int d = 0; d < 3; ++d) {
    const Real x = right[d], y = picture.camera.up[d];
    if (std::hypot(x, y) < 0.1)
      continue;  // points at the eye
    sheet.line({{x0, y0}, {x0 + arm * x, y0 + arm * y}}, ink);
    const Real to_text = 1 + 0.25 / std::hypot(x, y);
    sheet.text(std::string(1, "xyz"[d]), x0 + to_text * arm * x, y0 + to_text * arm * y, Side::centre);
  }
}

}  // namespace

Colour colour_of(Real share)
{
  if (std::isnan(share))
    return no_value;
  const Real place = std::clamp(share, 0.0, 1.0) * (viridis.size() - 1);
  const auto left = std::min(static_cast<std::size_t>(place), viridis.size() - 2);
  Colour colour{};
  for (int c = 0; c < 3; ++c)
    colour[static_cast<std::size_t>(c)] = static_cast<unsigned char>(
        std::lround(std::lerp(channel(viridis[left], c), channel(viridis[left + 1], c), place - static_cast<Real>(left))));
  return colour;
}

void draw(const Picture& picture, const Cloud& cloud, const Outline& outline, const fs::path& png)
{
  const std::array<Real, 2> size{static_cast<Real>(oversampling * picture.size[0]), static_cast<Real>(oversampling * picture.size[1])};
  const Panel panel = panel_of(picture.size);
  vtkNew<vtkRenderWindow> window;
  prepare(window, picture.size);
  window->SetNumberOfLayers(2);
  vtkNew<vtkRenderer> scene, front;
  scene->SetBackground(1, 1, 1);
  scene->SetViewport(panel.left, 0, panel.right, 1);
  front->SetLayer(1);
  front->InteractiveOff();
  vtkNew<vtkRenderer> paper;  // white beside the panel
  paper->SetBackground(1, 1, 1);
  for (vtkRenderer* renderer : {paper.Get(), scene.Get(), front.Get()})
    window->AddRenderer(renderer);

  add_outline(scene, picture, outline);
  add_particles(scene, picture, cloud);
  aim(scene, picture.camera, panel);

  Sheet sheet(front, letter_height * size[0]);
  const Real line = size[1] - 1.3 * sheet.letter();
  sheet.text(picture.title, 1.2 * sheet.letter(), line, Side::left, {.size = 1.15, .bold = true});
  sheet.text(fmt::format("t = {:.4g} s", picture.time), size[0] - 0.6 * sheet.letter(), line, Side::right);
  add_colour_bar(sheet, picture, cloud, size);
  if (picture.dimension == 2)
    add_scale(sheet, picture, size);
  else
    add_axes(sheet, picture);
  save(window, png);
}

}  // namespace talus::render
