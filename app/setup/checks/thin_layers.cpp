#include "app/setup/checks/thin_layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "app/setup/checks/cell_occupancy.hpp"

namespace talus {

namespace {

/// The same for the bodies of one velocity field.
template <int D>
void warn_of_field(std::size_t field, const Scene& scene, const Mesh<D>& mesh, const Particles<D>& particles,
                   const std::vector<Body>& bodies, const std::vector<Material>& materials, const Contacts& contacts, Communicator& ranks,
                   std::vector<std::string>& warnings)
{
  std::map<Index, CellOccupancy<D>> of_kind;
  const auto number = [&](const std::string& name) { return std::ranges::find(bodies, name, &Body::name) - bodies.begin(); };
  const auto kind_of = [&](const std::string& name) { return materials[static_cast<std::size_t>(number(name))].kind; };
  const auto at_start = [&](const std::string& name) {
    return presence_of(name, scene.stages).from == 0 && contacts.field_of(static_cast<Index>(number(name))) == field;
  };
  for (const Body& body : bodies)
    if (const Index kind = kind_of(body.name); at_start(body.name) && !of_kind.contains(kind))
      of_kind.try_emplace(kind, mesh, particles, bodies, ranks,
                          [&](const std::string& name) { return at_start(name) && kind_of(name) == kind; });
  if (of_kind.size() < 2)
    return;
  std::vector<Index> kinds(static_cast<std::size_t>(mesh.n_nodes()), 0);  // number of materials around each node
  for (const auto& [kind, holds] : of_kind)
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      kinds[static_cast<std::size_t>(n)] += std::ranges::any_of(mesh.cells_of_node()[n], holds) ? 1 : 0;
  for (const auto& [kind, holds] : of_kind) {
    Index cells = 0, thin = 0;
    for (Index c = 0; c < mesh.n_cells(); ++c)
      if (holds(c)) {
        ++cells;
        thin += std::ranges::all_of(mesh.cell(c), [&](Index n) { return kinds[static_cast<std::size_t>(n)] > 1; }) ? 1 : 0;
      }
    if (3 * thin > cells) {
      const MaterialSpec& material = scene.materials[static_cast<std::size_t>(kind)];
      warnings.push_back(
          fmt::format("{}: material \"{}\" is less than two cells thick where it lies between others ({} of its {} cells): a weak layer is "
                      "too strong there, several times if it is one cell thick; refine the mesh until it has two cells or more over the "
                      "layer, with boundaries of cells along it",
                      to_string(material.where), material.name, thin, cells));
    }
  }
}

}  // namespace

template <int D>
void warn_of_thin_layers(const Scene& scene, const Mesh<D>& mesh, const Particles<D>& particles, const std::vector<Body>& bodies,
                         const std::vector<Material>& materials, const Contacts& contacts, Communicator& ranks,
                         std::vector<std::string>& warnings)
{
  for (std::size_t field = 0; field < static_cast<std::size_t>(contacts.n_fields); ++field)
    warn_of_field(field, scene, mesh, particles, bodies, materials, contacts, ranks, warnings);
}

template void warn_of_thin_layers(const Scene&, const Mesh<2>&, const Particles<2>&, const std::vector<Body>&, const std::vector<Material>&,
                                  const Contacts&, Communicator&, std::vector<std::string>&);
template void warn_of_thin_layers(const Scene&, const Mesh<3>&, const Particles<3>&, const std::vector<Body>&, const std::vector<Material>&,
                                  const Contacts&, Communicator&, std::vector<std::string>&);

}  // namespace talus
