#pragma once
// Volumes and areas of named parts of a mesh, and the error of a mesh that is refused.
#include <filesystem>
#include <string>

#include "io/load_mesh.hpp"

namespace talus {

/// Volume [m^D] of the cells of a group.
template <int D>
Real volume_of(const Mesh<D>& mesh, const std::string& cells)
{
  const auto set = mesh.cell_set(cells);
  Real sum = 0;
  for (const Index c : set.value())
    sum += mesh.volume(c);
  return sum;
}

/// Area [m^(D-1)] of the facets of a group.
template <int D>
Real area_of(const Mesh<D>& mesh, const std::string& facets)
{
  const auto set = mesh.facet_set(facets);
  Real sum = 0;
  for (const Facet f : set.value())
    sum += mesh.area_vector(f).norm();
  return sum;
}

/// The message with which load_mesh() refuses the mesh; "no complaint" if it takes it.  Files are looked for in the folder.
template <int D>
std::string complaint(const MeshSpec& spec, const std::filesystem::path& folder = ".")
{
  try {
    load_mesh<D>(spec, folder);
  } catch (const SceneErrors& errors) {
    return errors.what();
  }
  return "no complaint";
}

}  // namespace talus
