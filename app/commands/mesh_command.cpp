// talus mesh
#include <fmt/format.h>

#include "app/commands/mesh_command.hpp"
#include "app/setup/setup.hpp"
#include "io/files/atomic_file.hpp"
#include "io/load_mesh.hpp"
#include "io/mesh/gmsh_write.hpp"
#include "io/scene/reader.hpp"
#include "io/terrain/terrain_mesh.hpp"
#include "mesh/quality.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// The requirements on a mesh before it is made.
struct Wanted {
  MeshSpec spec;
  fs::path folder;
  std::optional<int> dimension;
};

Wanted wanted_by(const MeshOptions& options)
{
  const auto kind = options.file.extension();
  if (kind == ".yaml" || kind == ".yml") {
    Scene scene = read_scene(options.file, options.set);
    return {scene.mesh, folder_of(scene), scene.dimension};
  }
  if (const auto why = not_ordinary(options.file))
    throw Error(fmt::format("mesh file \"{}\" {}", options.file.string(), *why));
  MeshSpec spec;
  spec.where.file = options.file.string();
  const std::string name = options.file.filename().string();
  if (kind == ".msh")
    spec.file = name;
  else
    spec.geometry = name;
  spec.size = options.size;
  std::vector<std::string> problems;
  spec.check(problems);
  if (!problems.empty())
    throw SceneErrors(spec.where, fmt::format("{}{}", problems.front(), spec.size || kind == ".msh" ? "" : " (--size)"));
  return {spec, options.file.parent_path(), options.dimension};
}

template <int D>
void show(const Mesh<D>& mesh, const MeshSpec& spec, const MeshOptions& options)
{
  for (const std::string& note : mesh.notes())
    fmt::print(stderr, "warning: {}\n", note);
  const MeshQuality<D> measures = quality(mesh);
  fmt::print("{}{}{}", to_string(measures), spec.smoothing == 0 ? advice(measures.offsets) : "", terrain_in_words(mesh, ""));
  fmt::print("groups\n");
  for (const std::string& name : mesh.cell_set_names())
    fmt::print("  {:<28} {:>9} cells\n", name, mesh.cell_set(name)->size());
  for (const std::string& name : mesh.facet_set_names())
    fmt::print("  {:<28} {:>9} facets\n", name, mesh.facet_set(name)->size());
  for (const std::string& name : mesh.node_set_names())
    if (!mesh.facet_set(name) && !mesh.cell_set(name))
      fmt::print("  {:<28} {:>9} nodes\n", name, mesh.node_set(name)->size());
  if (!options.out)
    return;
  write_msh(*options.out, mesh);
  fmt::print("written to {}\n", options.out->string());
}

}  // namespace

void show_mesh(const MeshOptions& options)
{
  const Wanted wanted = wanted_by(options);
  const auto show_in = [&]<int D>(std::integral_constant<int, D>) { show(load_mesh<D>(wanted.spec, wanted.folder), wanted.spec, options); };
  constexpr std::integral_constant<int, 2> plane;
  constexpr std::integral_constant<int, 3> space;
  if (wanted.dimension)
    return *wanted.dimension == 2 ? show_in(plane) : show_in(space);
  std::optional<Mesh<3>> solid;
  try {
    solid = load_mesh<3>(wanted.spec, wanted.folder);
  } catch (const SceneErrors& of_solid) {
    if (std::string_view(of_solid.what()).find("has no tetrahedra") == std::string_view::npos)
      throw;
    return show_in(plane);  // without triangles either, that will be the message
  }
  show(*solid, wanted.spec, options);
}

}  // namespace talus
