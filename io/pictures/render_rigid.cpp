#include "io/pictures/render_rigid.hpp"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
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

namespace talus::render {

namespace {

constexpr Colour steel{128, 136, 148};
constexpr Real darkest_side = 0.45;      // brightness of what faces away from the light
constexpr Real sharp_edge_of_body = 40;  // angle [degrees] between facets above which their normals are not averaged

vtkSmartPointer<vtkPolyData> surface_of_bodies(const Picture& picture)
{
  vtkNew<vtkPoints> points;
  for (std::size_t n = 0; n < picture.rigid->nodes.size(); n += 3) {
    const Vec3 x = Vec3(picture.rigid->nodes.data() + n) - picture.camera.centre;
    points->InsertNextPoint(x.data());
  }
  vtkNew<vtkCellArray> cells;
  for (std::size_t c = 0; c < picture.rigid->corners.size(); c += 3) {
    cells->InsertNextCell(3);
    for (std::size_t k = 0; k < 3; ++k)
      cells->InsertCellPoint(picture.rigid->corners[c + k]);
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(points);
  surface->SetPolys(cells);
  return surface;
}

vtkSmartPointer<vtkPolyData> shaded(vtkPolyData* surface, const Vec3& light)
{
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(surface);
  normals->SetFeatureAngle(sharp_edge_of_body);
  normals->ConsistencyOff();
  normals->Update();
  vtkSmartPointer<vtkPolyData> lit = normals->GetOutput();
  vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  colours->SetNumberOfTuples(lit->GetNumberOfPoints());
  for (vtkIdType n = 0; n < lit->GetNumberOfPoints(); ++n) {
    const Vec3 normal(lit->GetPointData()->GetNormals()->GetTuple3(n));
    const Real bright = std::lerp(darkest_side, Real{1}, 0.5 * (1 + normal.dot(light)));
    for (int c = 0; c < 3; ++c)
      colours->SetComponent(n, c, bright * steel[static_cast<std::size_t>(c)]);
  }
  lit->GetPointData()->SetScalars(colours);
  return lit;
}

}  // namespace

std::optional<StoredMesh> read_rigid(const std::filesystem::path& folder, Real time)
{
  if (!std::filesystem::exists(folder / "rigid.pvd"))
    return std::nullopt;
  const auto files = read_pvd(folder / "rigid.pvd");
  const auto at = std::ranges::find(files, time, &std::pair<Real, std::filesystem::path>::first);
  if (at == files.end())
    return std::nullopt;
  return read_mesh(at->second);
}

void add_rigid(vtkRenderer* scene, const Picture& picture)
{
  if (!picture.rigid)
    return;
  vtkNew<vtkPolyDataMapper> mapper;
  const auto surface = surface_of_bodies(picture);
  mapper->SetInputData(picture.dimension == 3 ? shaded(surface, light_of(picture.camera)) : surface);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(channels(steel).data());
  actor->GetProperty()->LightingOff();
  scene->AddActor(actor);
}

}  // namespace talus::render
