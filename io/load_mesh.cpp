#include "io/load_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/word_match.hpp"
#include "io/mesh/cell_count.hpp"
#include "io/mesh/gmsh_plugin.hpp"
#include "io/mesh/gmsh_read.hpp"
#include "io/mesh/mesh_groups.hpp"
#include "io/terrain/terrain_mesh.hpp"
#include "mesh/check.hpp"
#include "mesh/generate/generate.hpp"
#include "mesh/overlap.hpp"
#include "mesh/simplex.hpp"
#include "mesh/smooth.hpp"

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

/// Calls f(); a std::invalid_argument becomes SceneErrors with the position.
template <class F>
auto located(const MeshSpec& spec, F&& f)
{
  try {
    return f();
  } catch (const std::invalid_argument& complaint) {
    throw SceneErrors(spec.where, spec.file.empty() ? complaint.what() : fmt::format("mesh file \"{}\": {}", spec.file, complaint.what()));
  }
}

/// Whether the mesh was not made by Talus: such meshes may have errors that the facets do not show.
bool is_foreign(const MeshSpec& spec) { return !spec.file.empty() || !spec.geometry.empty(); }

template <int D>
void note_unjoined_nodes(MeshData<D>& data)
{
  const auto groups = unjoined_nodes(data);
  if (groups.empty())
    return;
  const auto& at = data.nodes[static_cast<std::size_t>(groups.front().front())];
  data.notes.push_back(fmt::format(
      "at {} place{} there is more than one node, the first at {}: the cells there are not joined, and the mesh has a crack whose "
      "sides are part of the boundary; in gmsh Coherence (or BooleanFragments) joins them",
      groups.size(), groups.size() == 1 ? "" : "s", place<D>(at)));
}

/// The cell groups of a cell, as text.
template <int D>
std::string groups_of(const Mesh<D>& mesh, Index cell)
{
  std::string names;
  for (const std::string& name : mesh.cell_set_names()) {
    const auto cells = *mesh.cell_set(name);
    if (std::binary_search(cells.begin(), cells.end(), cell))
      names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", name);
  }
  return names.empty() ? "no group" : names;
}

template <int D>
void refuse_overlap(const Mesh<D>& mesh)
{
  const auto overlap = find_overlap(mesh);
  if (!overlap)
    return;
  const Vec<D> middle = (centroid<D>(mesh.corners(overlap->first)) + centroid<D>(mesh.corners(overlap->second))) / 2;
  throw std::invalid_argument(fmt::format(
      "cells overlap although they share no facet: {} pair{}, the first near {}, one cell of {}, the other of {}; mass there would count "
      "twice",
      overlap->pairs, overlap->pairs == 1 ? "" : "s", place<D>(middle), groups_of(mesh, overlap->first), groups_of(mesh, overlap->second)));
}

}  // namespace

template <int D>
MeshData<D> make_mesh(const MeshSpec& spec, const std::filesystem::path& directory)
{
  return located(spec, [&] {
    MeshData<D> data = make_unnamed<D>(spec, directory);
    add_automatic_groups<D>(data);
    if (is_foreign(spec)) {
      note_unjoined_nodes(data);
      for (std::string& note : data.notes)
        note = fmt::format("{}: mesh file \"{}\": {}", to_string(spec.where), spec.file.empty() ? spec.geometry : spec.file, note);
    }
    add_side_groups<D>(data, spec.regions);
    add_groups<D>(data, spec.groups);
    return spec.smoothing > 0 ? smoothed<D>(std::move(data), spec.smoothing) : data;
  });
}

template <int D>
Mesh<D> load_mesh(const MeshSpec& spec, const std::filesystem::path& directory)
{
  return located(spec, [&] {
    Mesh<D> mesh(make_mesh<D>(spec, directory));
    if (is_foreign(spec))
      refuse_overlap(mesh);
    return mesh;
  });
}

template <int D>
Mesh<D> load_mesh(const Scene& scene, const std::filesystem::path& directory)
{
  Mesh<D> mesh = load_mesh<D>(scene.mesh, directory);
  std::vector<SceneError> errors;
  std::vector<std::string> groups;
  const auto add = [&](std::size_t cut, std::string message) {
    SourceLocation where = scene.cuts[cut].where;
    where.path += ".on";
    errors.push_back({where, std::move(message), {}});
  };
  const std::vector<std::string> known = mesh.facet_set_names();
  for (std::size_t k = 0; k < scene.cuts.size(); ++k) {
    if (const std::string& on = groups.emplace_back(scene.cuts[k].on); std::ranges::find(known, on) == known.end())
      add(k, fmt::format("the mesh has no facet group \"{}\"{}", on, suggestion(on, known)));
  }
  try {
    if (errors.empty())
      return Mesh<D>(std::move(mesh), groups);
  } catch (const CutError& what) {
    add(what.cut, what.what());
  }
  throw SceneErrors(std::move(errors));
}

template MeshData<2> make_mesh<2>(const MeshSpec&, const std::filesystem::path&);
template MeshData<3> make_mesh<3>(const MeshSpec&, const std::filesystem::path&);
template Mesh<2> load_mesh<2>(const MeshSpec&, const std::filesystem::path&);
template Mesh<3> load_mesh<3>(const MeshSpec&, const std::filesystem::path&);
template Mesh<2> load_mesh<2>(const Scene&, const std::filesystem::path&);
template Mesh<3> load_mesh<3>(const Scene&, const std::filesystem::path&);

}  // namespace talus
