// Contours and silhouettes of the bodies' surfaces.
#include "io/pictures/render_outline.hpp"

#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataSilhouette.h>
#include <vtkSmartPointer.h>

namespace talus::render {

namespace {

constexpr Real surface_level = 0.5;

vtkSmartPointer<vtkPolyData> silhouette(vtkPolyData* surface, const Camera& camera)
{
  const Vec3 eye = camera.centre + camera.distance * camera.towards;
  vtkNew<vtkPolyDataSilhouette> edges;
  edges->SetInputData(surface);
  edges->SetEnableFeatureAngle(0);
  edges->SetBorderEdges(0);
  if (camera.perspective) {
    edges->SetDirectionToSpecifiedOrigin();
    edges->SetOrigin(eye[0], eye[1], eye[2]);
  } else {
    edges->SetDirectionToSpecifiedVector();
    edges->SetVector(camera.towards[0], camera.towards[1], camera.towards[2]);
  }
  edges->Update();
  return edges->GetOutput();
}

void append(const Lines& more, Lines& lines)
{
  const auto n = static_cast<Index>(lines.points.size());
  lines.points.insert(lines.points.end(), more.points.begin(), more.points.end());
  for (const auto& [a, b] : more.ends)
    lines.ends.push_back({a + n, b + n});
}

}  // namespace

Lines outline_of(const std::map<int, Matter>& bodies, int dimension, const Camera& camera)
{
  Lines lines;
  for (const auto& [number, matter] : bodies) {
    const auto surface = surface_of(matter, dimension, default_spacing(matter, dimension), surface_level);
    append(lines_of(dimension == 2 ? surface : silhouette(surface, camera)), lines);
  }
  return lines;
}

}  // namespace talus::render
