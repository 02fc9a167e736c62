#include "solver/rigid/rigid_nodes.hpp"

#include "solver/strips/particles_in_cell.hpp"

namespace talus {

namespace {

/// Nodes farther than this in front of a body exchange no impulses with it, in mean edges.  What moves with a body acts as a part of it, so the
/// value is small; below two thirds, a particle that touches can be in a cell of which no node near the particle takes part.
constexpr Real nearness = 0.7;

}  // namespace

template <int D>
void RigidNodes<D>::begin(const Mesh<D>& mesh, const Subdomain& subdomain, Communicator& ranks, const RigidScene<D>& scene,
                          const std::vector<std::vector<Index>>& groups_of_field)
{
  n_bodies_ = scene.bodies.size();
  if (!any())
    return;
  groups_of_field_ = groups_of_field;
  const auto n_nodes = static_cast<std::size_t>(mesh.n_nodes()), n_cells = static_cast<std::size_t>(mesh.n_cells());
  candidate_.assign(n_nodes, 0);
  touch_.assign(n_nodes, {});
  place_of_cell_.assign(n_cells, none);
  if (subdomain.alone())
    return;
  copies_ = copies_of_nodes(ranks, subdomain, MessageTag::rigid_nodes, std::vector<std::uint8_t>(n_nodes, 1));
  back_ = ReturnToOwners<Touch<D>>(ranks, MessageTag::rigid_touches, copies_, {});
}

template <int D>
void RigidNodes<D>::find_candidates(const Place& at, const Nodes<D>& nodes)
{
  for (const Index n : candidates_)
    candidate_[static_cast<std::size_t>(n)] = 0;
  candidates_.clear();
  nodes.in_use.for_each_ascending([&](Index n) {
    const auto i = static_cast<std::size_t>(n);
    if (!at.own.has(n) || nodes.active[i] == 0 || !at.acts_on(n))
      return;
    const Real near = nearness * at.mesh.node_size(n), reach = at.shape.radius() + near;
    if ((at.mesh.node(n) - at.state.x).squaredNorm() > reach * reach || at.distance(at.mesh.node(n)).distance > near)
      return;
    candidate_[i] = 1;
    candidates_.push_back(n);
    nodes_.push_back({.rigid = at.rigid, .field = static_cast<Index>(at.field), .node = n, .touch = {}});
  });
  copies_.send(candidate_, OfMarked{itself, candidate_});
  copies_.take(candidate_, OfMarked{itself, candidate_});
  for (const NeighbourRank& border : copies_.borders())
    for (const Index n : border.in)
      if (candidate_[static_cast<std::size_t>(n)] != 0)
        candidates_.push_back(n);
}

template <int D>
void RigidNodes<D>::find_touching_particles(const Place& at)
{
  for (const Index c : marked_)
    place_of_cell_[static_cast<std::size_t>(c)] = none;
  marked_.clear();
  for (const Index n : candidates_)
    for (const Index m : at.mesh.ring_of_node()[n])
      for (const Index c : at.mesh.cells_of_node()[m])
        if (Index& place = place_of_cell_[static_cast<std::size_t>(c)]; place == none) {
          place = static_cast<Index>(marked_.size());
          marked_.push_back(c);
        }
  if (touching_.size() < marked_.size())
    touching_.resize(marked_.size());
  parallel_for(static_cast<Index>(marked_.size()), [&](Index k) {
    auto& touching = touching_[static_cast<std::size_t>(k)];
    touching.clear();
    for_each_particle_in<D>(at.strips, groups_of_field_[at.field], marked_[static_cast<std::size_t>(k)],
                            [&](const StripColumns<D>& columns, std::size_t p) {
                              if (at.shape.is_sheet())
                                if (const SideOfSheet side(columns.side.of(p)); !side.kept || side.behind != at.sheets.is_behind(at.field))
                                  return;
                              const Vec<D> x = columns.x.of(p);
                              const SurfaceDistance<D> to = at.distance(x);
                              const Real gap = to.distance - half_width<D>(columns.F.of(p), columns.volume0.of(p), to.normal);
                              if (gap > 0)
                                return;
                              const Mat<D> field = at.with_affine_fields ? columns.affine_field().of(p) : Mat<D>(Mat<D>::Zero());
                              touching.push_back({{gap, to.normal, x - to.distance * to.normal, field}, x});
                            });
  });
}

template <int D>
void RigidNodes<D>::find_deepest(const Place& at, std::span<RigidNode<D>> found)
{
  parallel_for_uneven(static_cast<Index>(candidates_.size()), [&](Index k) {
    const Index n = candidates_[static_cast<std::size_t>(k)];
    Touch<D>& deepest = touch_[static_cast<std::size_t>(n)];
    const Real beside = at.mesh.node_size(n) / 2;
    for (const Index m : at.mesh.ring_of_node()[n])
      for (const Index c : at.mesh.cells_of_node()[m])
        for (const auto& [touch, x] : touching_[static_cast<std::size_t>(place_of_cell_[static_cast<std::size_t>(c)])]) {
          const Vec<D> arm = x - at.mesh.node(n);
          const Real along = touch.normal.dot(arm);
          if (arm.squaredNorm() - along * along <= beside * beside)
            deepest = std::min(deepest, touch);
        }
  });
  back_(touch_, Whole{}, [](Touch<D>& deepest, const Touch<D>& other) { deepest = std::min(deepest, other); });
  for (RigidNode<D>& one : found) {
    one.touch = touch_[static_cast<std::size_t>(one.node)];
    one.offset = one.touch.affine_field * (at.mesh.node(one.node) - one.touch.place);
  }
  for (const Index n : candidates_)
    touch_[static_cast<std::size_t>(n)] = {};
}

template <int D>
void RigidNodes<D>::find(const Mesh<D>& mesh, const OwnNodes& own, const ParticleStrips<D>& strips, const RigidScene<D>& scene,
                         std::span<const RigidState<D>> states, const Sheets<D>& sheets, std::span<const VelocityField<D>> fields,
                         bool with_affine_fields)
{
  if (!any())
    return;
  nodes_.clear();
  for (std::size_t r = 0; r < scene.bodies.size(); ++r)
    for (std::size_t f = 0; f < fields.size(); ++f) {
      const Place at{mesh, own, strips, *scene.bodies[r].shape, states[r], static_cast<Index>(r), sheets, f, with_affine_fields};
      const std::size_t before = nodes_.size();
      find_candidates(at, fields[f].nodes);
      const std::span<RigidNode<D>> found = std::span(nodes_).subspan(before);
      find_touching_particles(at);
      find_deepest(at, found);
    }
  std::erase_if(nodes_, [](const RigidNode<D>& one) { return !one.touch.is_seen(); });
}

#define TALUS_INSTANTIATE(D)                                                                                         \
  template void RigidNodes<D>::begin(const Mesh<D>&, const Subdomain&, Communicator&, const RigidScene<D>&,          \
                                     const std::vector<std::vector<Index>>&);                                        \
  template void RigidNodes<D>::find(const Mesh<D>&, const OwnNodes&, const ParticleStrips<D>&, const RigidScene<D>&, \
                                    std::span<const RigidState<D>>, const Sheets<D>&, std::span<const VelocityField<D>>, bool);
TALUS_INSTANTIATE(2)
TALUS_INSTANTIATE(3)
#undef TALUS_INSTANTIATE

}  // namespace talus
