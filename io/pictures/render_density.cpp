// Densities on a regular grid, with iso-surfaces by VTK's flying edges (Schroeder, Maynard, Geveci, LDAV 2015).
#include "io/pictures/render_density.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges2D.h>
#include <vtkFlyingEdges3D.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkReverseSense.h>
#include <vtkSmartPointer.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.hpp"
#include "io/pictures/render_data.hpp"

namespace talus::render {

namespace {

constexpr Real reach_over_width = 3;  // with two, clustered points of a triangle leave holes between the clusters
constexpr Real most_points = 1e8;     // points of four bytes, or eight with values, and as many again for the search
constexpr auto value_name = "value";

Real width_of(Real volume, int dimension) { return dimension == 2 ? std::sqrt(volume) : std::cbrt(volume); }

/// Wendland's C2 kernel (Adv. Comput. Math. 4, 1995) at the distance r relative to the reach, times reach^D.
Real kernel(Real r, int dimension)
{
  if (r >= 1)
    return 0;
  const Real rest = (1 - r) * (1 - r);
  return (dimension == 2 ? 7 : 10.5) / std::numbers::pi * rest * rest * (1 + 4 * r);
}

struct Grid {
  Vec3 low;  ///< low corner [m]
  Real spacing;
  std::array<Index, 3> counts;
  std::size_t size() const
  {
    return static_cast<std::size_t>(counts[0]) * static_cast<std::size_t>(counts[1]) * static_cast<std::size_t>(counts[2]);
  }
};

/// A grid around everything that the particles reach.
Grid grid_of(const Matter& matter, int dimension, Real spacing)
{
  const Bounds bounds = bounds_of(matter.x).value();
  const Real widest = width_of(*std::max_element(matter.volume.begin(), matter.volume.end()), dimension);
  const Vec3 margin = Vec3::Constant(reach_over_width * widest + spacing);
  Grid grid{bounds.low - margin, spacing, {1, 1, 1}};
  const Vec3 extent = bounds.high - bounds.low + 2 * margin;
  Real n = 1, volume = 1;
  for (int d = 0; d < dimension; ++d) {
    n *= extent[d] / spacing + 2;
    volume *= extent[d];
  }
  if (n > most_points)
    throw Error(fmt::format("--spacing: {:.3g} m makes a grid of {:.2g} points, {:.0g} are the most; {:.2g} m would do", spacing, n,
                            most_points, 1.1 * width_of(volume / most_points, dimension)));
  for (int d = 0; d < dimension; ++d)
    grid.counts[static_cast<std::size_t>(d)] = static_cast<Index>(extent[d] / spacing) + 2;
  if (dimension == 2)
    grid.low[2] = 0;
  return grid;
}

/// Calls f(grid point, weight) for all points within reach of particle p; the sum of weights times the cells' volumes is the particle's
/// volume.
template <class F>
void spread(const Matter& matter, std::size_t p, int dimension, const Grid& grid, F&& f)
{
  if (!(matter.volume[p] > 0))
    return;
  const Real reach = reach_over_width * width_of(matter.volume[p], dimension);
  const Real scale = 1 / std::pow(reach_over_width, dimension);  // volume over reach^D
  const Vec3 centre = (matter.x[p] - grid.low) / grid.spacing;
  const Real cells = reach / grid.spacing;
  std::array<Index, 3> first{}, last{};
  for (int d = 0; d < 3; ++d) {
    const auto a = static_cast<std::size_t>(d);
    first[a] = d < dimension ? std::max<Index>(0, static_cast<Index>(std::ceil(centre[d] - cells))) : 0;
    last[a] = d < dimension ? std::min<Index>(grid.counts[a] - 1, static_cast<Index>(std::floor(centre[d] + cells))) : 0;
  }
  for (Index k = first[2]; k <= last[2]; ++k)
    for (Index j = first[1]; j <= last[1]; ++j)
      for (Index i = first[0]; i <= last[0]; ++i) {
        Vec3 offset = Vec3(static_cast<Real>(i), static_cast<Real>(j), static_cast<Real>(k)) - centre;
        if (dimension == 2)
          offset[2] = 0;
        const Real weight = scale * kernel(offset.norm() / cells, dimension);
        const auto row = static_cast<std::size_t>(k) * static_cast<std::size_t>(grid.counts[1]) + static_cast<std::size_t>(j);
        if (weight > 0)
          f(row * static_cast<std::size_t>(grid.counts[0]) + static_cast<std::size_t>(i), weight);
      }
}

/// The density, and with values their mean, at the points of the grid.
vtkSmartPointer<vtkImageData> densities(const Matter& matter, int dimension, const Grid& grid)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(static_cast<int>(grid.counts[0]), static_cast<int>(grid.counts[1]), static_cast<int>(grid.counts[2]));
  image->SetSpacing(grid.spacing, grid.spacing, grid.spacing);
  const auto make = [&](const char* name) {
    auto array = vtkSmartPointer<vtkFloatArray>::New();
    array->SetName(name);
    array->SetNumberOfValues(static_cast<vtkIdType>(grid.size()));
    array->FillValue(0);
    return array;
  };
  const auto density = make("density");
  float* rho = density->GetPointer(0);
  for (std::size_t p = 0; p < matter.x.size(); ++p)
    spread(matter, p, dimension, grid, [rho](std::size_t i, Real weight) { rho[i] += static_cast<float>(weight); });
  image->GetPointData()->SetScalars(density);
  if (matter.value.empty())
    return image;
  const auto value = make(value_name);
  float* sum = value->GetPointer(0);
  for (std::size_t p = 0; p < matter.x.size(); ++p)
    if (std::isfinite(matter.value[p]))
      spread(matter, p, dimension, grid,
             [&, a = matter.value[p]](std::size_t i, Real weight) { sum[i] += static_cast<float>(weight * a); });
  for (std::size_t i = 0; i < grid.size(); ++i)
    if (rho[i] > 0)
      sum[i] /= rho[i];
  image->GetPointData()->AddArray(value);
  return image;
}

/// Converts points to double precision and moves them to their position: single precision is sufficient near the origin, but shows steps at
/// map coordinates.
void put_in_place(vtkPolyData* surface, const Vec3& low)
{
  vtkNew<vtkPoints> placed;
  placed->SetDataTypeToDouble();
  placed->SetNumberOfPoints(surface->GetNumberOfPoints());
  Vec3 x;
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i) {
    surface->GetPoint(i, x.data());
    x += low;
    placed->SetPoint(i, x.data());
  }
  surface->SetPoints(placed);
}

template <class FlyingEdges>
vtkSmartPointer<vtkPolyData> level_of(vtkImageData* image, Real level)
{
  vtkNew<FlyingEdges> edges;
  edges->SetInputData(image);
  edges->SetValue(0, level);
  edges->ComputeScalarsOff();
  if constexpr (requires { edges->SetInterpolateAttributes(1); }) {
    edges->ComputeNormalsOff();
    edges->ComputeGradientsOff();
    edges->SetInterpolateAttributes(image->GetPointData()->GetNumberOfArrays() > 1 ? 1 : 0);
  }
  edges->Update();
  return edges->GetOutput();
}

}  // namespace

Real default_spacing(const Matter& matter, int dimension)
{
  std::vector<Real> volumes;
  std::copy_if(matter.volume.begin(), matter.volume.end(), std::back_inserter(volumes), [](Real v) { return v > 0; });
  if (volumes.empty())
    throw Error("there is no particle with a volume");
  const auto middle = volumes.begin() + static_cast<std::ptrdiff_t>(volumes.size() / 2);
  std::nth_element(volumes.begin(), middle, volumes.end());
  return 0.5 * width_of(*middle, dimension);
}

vtkSmartPointer<vtkPolyData> surface_of(const Matter& matter, int dimension, Real spacing, Real level)
{
  const Grid grid = grid_of(matter, dimension, spacing);
  const auto image = densities(matter, dimension, grid);
  const auto surface = dimension == 2 ? level_of<vtkFlyingEdges2D>(image, level) : level_of<vtkFlyingEdges3D>(image, level);
  put_in_place(surface, grid.low);
  if (!(enclosed(surface, dimension) < 0))
    return surface;
  vtkNew<vtkReverseSense> turned;
  turned->SetInputData(surface);
  turned->ReverseCellsOn();
  turned->Update();
  return turned->GetOutput();
}

Real enclosed(vtkPolyData* surface, int dimension)
{
  Real sum = 0;
  vtkCellArray* cells = dimension == 2 ? surface->GetLines() : surface->GetPolys();
  if (surface->GetNumberOfPoints() == 0)
    return 0;
  Vec3 origin;
  surface->GetPoint(0, origin.data());  // near the surface, so that no digits are lost at map coordinates
  vtkNew<vtkIdList> corners;
  std::array<Vec3, 3> x;
  for (cells->InitTraversal(); cells->GetNextCell(corners) != 0;) {
    for (int a = 0; a < dimension; ++a) {
      surface->GetPoint(corners->GetId(a), x[static_cast<std::size_t>(a)].data());
      x[static_cast<std::size_t>(a)] -= origin;
    }
    sum += dimension == 2 ? (x[0][0] * x[1][1] - x[0][1] * x[1][0]) / 2 : x[0].dot(x[1].cross(x[2])) / 6;
  }
  return sum;
}

}  // namespace talus::render
