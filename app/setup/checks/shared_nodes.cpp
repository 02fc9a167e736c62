#include "app/setup/checks/shared_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mesh/geometry/box_tree.hpp"

namespace talus {

namespace {

/// Nodes with mass of a body, ascending.
template <int D>
std::vector<Index> nodes_with_mass(const Mesh<D>& mesh, const Particles<D>& particles, const Body& body, const NodesOfCell& nodes_of)
{
  std::vector<std::uint8_t> has_particles(static_cast<std::size_t>(mesh.n_cells()), 0),
      has_mass(static_cast<std::size_t>(mesh.n_nodes()), 0);
  for (Index row = body.begin; row < body.end; ++row)
    has_particles[static_cast<std::size_t>(particles.cell[static_cast<std::size_t>(row)])] = 1;
  std::vector<Index> nodes;
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    if (has_particles[static_cast<std::size_t>(c)] == 0)
      continue;
    nodes.clear();
    nodes_of(c, nodes);
    for (const Index n : nodes)
      has_mass[static_cast<std::size_t>(n)] = 1;
  }
  nodes.clear();
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (has_mass[static_cast<std::size_t>(n)] != 0)
      nodes.push_back(n);
  return nodes;
}

/// Cells whose particles may give mass to one of the nodes: two rings around them.
template <int D>
std::vector<std::uint8_t> cells_around(const Mesh<D>& mesh, const std::vector<Index>& nodes)
{
  std::vector<std::uint8_t> near(static_cast<std::size_t>(mesh.n_cells()), 0);
  for (const Index n : nodes)
    for (const Index v : mesh.ring_of_node()[n])
      for (const Index c : mesh.cells_of_node()[v])
        near[static_cast<std::size_t>(c)] = 1;
  return near;
}

/// Particles of a body in some cells: their places, and their mean spacing [m].
template <int D>
struct ParticlesThere {
  std::vector<Vec<D>> places;
  Real spacing = 0;
};
template <int D>
ParticlesThere<D> particles_in(const std::vector<std::uint8_t>& cells, const Particles<D>& particles, const Body& body)
{
  ParticlesThere<D> there;
  for (Index row = body.begin; row < body.end; ++row) {
    const auto p = static_cast<std::size_t>(row);
    if (cells[static_cast<std::size_t>(particles.cell[p])] == 0)
      continue;
    there.places.push_back(particles.x[p]);
    there.spacing += std::pow(particles.volume0[p], 1.0 / D);
  }
  if (!there.places.empty())
    there.spacing /= static_cast<Real>(there.places.size());
  return there;
}

/// Smallest distance between particles of two bodies [m]; the search ends at one of no more than `enough`.
template <int D>
Real distance_between(const ParticlesThere<D>& one, const ParticlesThere<D>& other, Real enough)
{
  Real least = std::numeric_limits<Real>::infinity();
  const BoxTree<D> tree(static_cast<Index>(other.places.size()), [&](Index i) {
    Extent<D> box;
    box.take(other.places[static_cast<std::size_t>(i)]);
    return box;
  });
  for (const Vec<D>& x : one.places) {
    const auto squared = [&](Index i) { return (other.places[static_cast<std::size_t>(i)] - x).squaredNorm(); };
    least = std::min(least, std::sqrt(squared(tree.nearest(x, squared))));
    if (least <= enough)
      break;
  }
  return least;
}

}  // namespace

template <int D>
std::vector<SharedNodes> find_shared_nodes(const Mesh<D>& mesh, const Particles<D>& particles, const std::vector<Body>& bodies,
                                           const NodesOfCell& nodes_of)
{
  std::vector<std::vector<Index>> bodies_at(static_cast<std::size_t>(mesh.n_nodes()));
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (const Index n : nodes_with_mass(mesh, particles, bodies[b], nodes_of))
      bodies_at[static_cast<std::size_t>(n)].push_back(static_cast<Index>(b));
  std::map<std::pair<Index, Index>, std::vector<Index>> nodes_of_pair;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    const auto& here = bodies_at[static_cast<std::size_t>(n)];
    for (std::size_t i = 0; i < here.size(); ++i)
      for (std::size_t j = i + 1; j < here.size(); ++j)
        nodes_of_pair[{here[i], here[j]}].push_back(n);
  }
  std::vector<SharedNodes> pairs;
  for (const auto& [pair, nodes] : nodes_of_pair) {
    const auto cells = cells_around(mesh, nodes);
    const auto one = particles_in(cells, particles, bodies[static_cast<std::size_t>(pair.first)]);
    const auto other = particles_in(cells, particles, bodies[static_cast<std::size_t>(pair.second)]);
    // Particles of cells that share a facet may be farther apart than their spacing: with one in a cell by a third.
    constexpr Real next_to_each_other = 1.5;
    const Real spacing = (one.spacing + other.spacing) / 2, distance = distance_between(one, other, next_to_each_other * spacing);
    Real edges = 0;
    for (const Index n : nodes)
      edges += mesh.node_size(n);
    pairs.push_back({pair.first, pair.second, std::ssize(nodes), distance <= next_to_each_other * spacing, distance - spacing,
                     edges / static_cast<Real>(nodes.size())});
  }
  return pairs;
}

std::vector<std::string> warnings_of(const std::vector<SharedNodes>& pairs, const std::vector<Body>& bodies)
{
  std::vector<std::string> warnings;
  for (const SharedNodes& pair : pairs)
    if (!pair.touch)
      warnings.push_back(
          fmt::format("bodies \"{}\" and \"{}\" are {:.3g} m apart, but share {} node{} at the start: cells of {:.3g} m are too coarse for "
                      "that gap, and the "
                      "bodies push each other before they touch; a gap of three cells or more keeps them apart",
                      bodies[static_cast<std::size_t>(pair.first)].name, bodies[static_cast<std::size_t>(pair.second)].name, pair.gap,
                      pair.nodes, pair.nodes == 1 ? "" : "s", pair.cell));
  return warnings;
}

std::string contacts_in_words(const std::vector<SharedNodes>& pairs, const std::vector<Body>& bodies)
{
  std::string text;
  for (const SharedNodes& pair : pairs)
    if (pair.touch)
      text += fmt::format("{} \"{}\" and \"{}\" ({} node{})", text.empty() ? "" : ",", bodies[static_cast<std::size_t>(pair.first)].name,
                          bodies[static_cast<std::size_t>(pair.second)].name, pair.nodes, pair.nodes == 1 ? "" : "s");
  return text.empty() ? "" : "bodies that touch at the start and move as one where they do, without slip:" + text;
}

template std::vector<SharedNodes> find_shared_nodes<2>(const Mesh<2>&, const Particles<2>&, const std::vector<Body>&, const NodesOfCell&);
template std::vector<SharedNodes> find_shared_nodes<3>(const Mesh<3>&, const Particles<3>&, const std::vector<Body>&, const NodesOfCell&);

namespace {

/// The material that a body of the scene has at first.
const std::string& material_of_body(const Scene& scene, const std::string& name)
{
  return std::ranges::find(scene.bodies, name, &BodySpec::name)->material;
}

/// Whether two bodies are there in the same stage.
bool meet(const Scene& scene, const std::string& a, const std::string& b)
{
  const Presence one = presence_of(a, scene.stages), other = presence_of(b, scene.stages);
  return one.from < other.until && other.from < one.until;
}

/// Whether they have velocities of their own, so that cells may be cut where they touch.
bool are_in_contact(const Scene& scene, const std::string& a, const std::string& b)
{
  return std::ranges::any_of(scene.contacts, [&](const ContactSpec& contact) {
    return !contact.tied && (contact.between == std::vector{a, b} || contact.between == std::vector{b, a});
  });
}

}  // namespace

void warn_of_shared_cells(const Scene& scene, const std::vector<Body>& bodies, std::span<const Index> cell, Index n_cells,
                          Communicator& ranks, std::vector<std::string>& warnings)
{
  constexpr std::int64_t most = 10;
  std::vector<Index> owner(static_cast<std::size_t>(n_cells), none), counted(owner);
  std::int64_t pairs = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::vector<std::int64_t> shared(b, 0);
    for (Index row = bodies[b].begin; row < bodies[b].end; ++row) {
      const auto c = static_cast<std::size_t>(cell[static_cast<std::size_t>(row)]);
      const Index body = static_cast<Index>(b), holds = owner[c];
      if (holds == none)
        owner[c] = body;
      else if (holds != body && std::exchange(counted[c], body) != body)
        ++shared[static_cast<std::size_t>(holds)];
    }
    ranks.sum(shared);  // no cell is filled by two ranks
    for (std::size_t other = 0; other < b; ++other)
      if (shared[other] > 0 && meet(scene, bodies[other].name, bodies[b].name) &&
          !are_in_contact(scene, bodies[other].name, bodies[b].name) && ++pairs <= most)
        warnings.push_back(fmt::format("{}: bodies \"{}\" and \"{}\" share {} cell{} at the start{}", to_string(bodies[b].where),
                                       bodies[other].name, bodies[b].name, shared[other], shared[other] == 1 ? "" : "s",
                                       material_of_body(scene, bodies[other].name) == material_of_body(scene, bodies[b].name)
                                           ? ""
                                           : "; if they only touch, the boundary between their materials cuts cells, and is too strong by "
                                             "one to two cells over the height of what slides along it: better let them fill regions of "
                                             "the mesh"));
  }
  if (pairs > most)
    warnings.push_back(fmt::format("{} more pairs of bodies share cells at the start", pairs - most));
}

void find_groups_filled_twice(const Scene& scene, SceneErrorCollector& errors)
{
  std::map<std::string, std::vector<const BodySpec*>> filled;
  for (const BodySpec& body : scene.bodies) {
    if (body.region.empty())
      continue;
    std::vector<const BodySpec*>& before = filled[body.region];
    const auto at_once = std::ranges::find_if(before, [&](const BodySpec* other) { return meet(scene, body.name, other->name); });
    if (at_once != before.end())
      errors.add(body.where, "region", fmt::format("body \"{}\" fills the cell group \"{}\" already", (*at_once)->name, body.region));
    before.push_back(&body);
  }
}

}  // namespace talus
