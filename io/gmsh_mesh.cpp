#include "io/gmsh_mesh.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "io/cell_count.hpp"
#include "io/gmsh_door.hpp"
#include "io/gmsh_read.hpp"
#include "io/mesh_groups.hpp"
#include "io/terrain_mesh.hpp"
#include "mesh/generate.hpp"

namespace talus {

namespace {

template <int D>
Vec<D> point(const std::vector<Real>& numbers, std::string_view key, const MeshSpec& spec)
{
  if (numbers.size() != D)
    throw SceneErrors(spec.where, fmt::format("{} has {} numbers; the scene has dimension {}", key, numbers.size(), D));
  return Eigen::Map<const Vec<D>>(numbers.data());
}

template <int D>
MeshData<D> make_grid(const GridSpec& grid, const MeshSpec& spec)
{
  const Vec<D> low = point<D>(grid.low, "grid.low", spec), high = point<D>(grid.high, "grid.high", spec);
  if (grid.cells.size() != D)
    throw SceneErrors(spec.where, fmt::format("grid.cells has {} numbers; the scene has dimension {}", grid.cells.size(), D));
  std::array<Index, D> cells;
  std::copy_n(grid.cells.begin(), D, cells.begin());
  Real total = D == 2 ? 2 : 6;
  for (const Index n : cells)
    total *= n;
  check_cells<D>(total, "grid.cells", spec);
  constexpr std::uint64_t seed = 1;
  MeshData<D> data = box<D>(low, high, cells);
  return grid.jitter > 0 ? jittered<D>(std::move(data), grid.jitter, seed) : data;
}

template <int D>
MeshData<D> make_unnamed(const MeshSpec& spec, const std::filesystem::path& directory)
{
  if (!spec.file.empty())
    return read_msh<D>(directory / spec.file, spec.where);
  if (!spec.geometry.empty())
    return gmsh<D>().mesh_geometry(spec, directory / spec.geometry);
  if (!spec.regions.empty())
    return gmsh<D>().mesh_regions(spec);
  if (spec.grid)
    return make_grid<D>(*spec.grid, spec);
  if (spec.terrain)
    return make_terrain<D>(spec, directory);
  throw SceneErrors(spec.where, "the mesh needs one of file, geometry, regions, grid and terrain");
}

/// f(), with std::invalid_argument located.
template <class F>
auto located(const MeshSpec& spec, F&& f)
{
  try {
    return f();
  } catch (const std::invalid_argument& complaint) {
    throw SceneErrors(spec.where, spec.file.empty() ? complaint.what() : fmt::format("mesh file \"{}\": {}", spec.file, complaint.what()));
  }
}

}  // namespace

template <int D>
MeshData<D> make_mesh(const MeshSpec& spec, const std::filesystem::path& directory)
{
  return located(spec, [&] {
    MeshData<D> data = make_unnamed<D>(spec, directory);
    add_automatic_groups<D>(data);
    add_groups<D>(data, spec.groups);
    return data;
  });
}

template <int D>
Mesh<D> load_mesh(const MeshSpec& spec, const std::filesystem::path& directory)
{
  return located(spec, [&] { return Mesh<D>(make_mesh<D>(spec, directory)); });
}

template MeshData<2> make_mesh<2>(const MeshSpec&, const std::filesystem::path&);
template MeshData<3> make_mesh<3>(const MeshSpec&, const std::filesystem::path&);
template Mesh<2> load_mesh<2>(const MeshSpec&, const std::filesystem::path&);
template Mesh<3> load_mesh<3>(const MeshSpec&, const std::filesystem::path&);

}  // namespace talus
