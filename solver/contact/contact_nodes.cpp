#include "solver/contact/contact_nodes.hpp"

#include <limits>

#include "solver/strips/particles_in_cell.hpp"

namespace talus {

namespace {

/// Where one body has a corner and the other is flat, its filling changes less, and the flat one says which way the surface faces.  With 6 the
/// front edge of a sliding block still ploughs: it slides 4 to 9 % too short a way at twice the limit of friction, with 60 at most 1 %.
constexpr int power_of_steepness = 60;
/// Share of a neighbour in the surface at a node, relative to the node itself: impulses act on all nodes that rows of operators reach.
constexpr Real weight_of_neighbour = 0.5;
/// A filling that changes by less than this over the size of a node says nothing about the direction of a surface.
constexpr Real least_change = 1e-3;

/// Particles reach from minus to plus infinity where there are none.
constexpr Real beyond = std::numeric_limits<Real>::infinity();

/// Selects the nodes that particles reach.
struct Reached {
  template <class Row>
  static auto parts(Row& row) noexcept
  {
    return std::tie(row.first, row.second);
  }
  template <class Row>
  static bool is_there(const Row& row, Index) noexcept
  {
    return row.first > -beyond || row.second < beyond;
  }
  template <class Row>
  static void clear(Row& row) noexcept
  {
    row = {-beyond, beyond};
  }
};

template <int D>
std::size_t local_number(const Mesh<D>& mesh, Index cell, Index node) noexcept
{
  const auto& nodes = mesh.cell(cell);
  return static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
}

/// The surface between two fields in a cell, per volume [1/m], from the gradients of their fillings: where they meet, one ends as the other
/// begins.
template <int D>
Real surface_in_cell(const Vec<D>& first, const Vec<D>& second)
{
  const Vec<D> difference = second - first;
  const Real size = difference.norm();
  return size > 0 ? std::max(Real{0}, std::min(second.dot(difference), -first.dot(difference)) / size) : 0;
}

}  // namespace

template <int D>
void ContactNodes<D>::begin(const Mesh<D>& mesh, const Subdomain& subdomain, Communicator& ranks, const Contacts& contacts)
{
  if (contacts.laws.empty())
    return;
  contacts_ = contacts;
  const auto n_nodes = static_cast<std::size_t>(mesh.n_nodes());
  const std::size_t n_laws = contacts.laws.size(), n_fields = static_cast<std::size_t>(contacts.n_fields);
  candidate_.assign(n_laws, std::vector<std::uint8_t>(n_nodes, 0));
  normal_.assign(n_laws, std::vector<Vec<D>>(n_nodes, Vec<D>::Zero()));
  reach_.assign(n_laws, std::vector<Reach>(n_nodes, Reach{-beyond, beyond}));
  volumes_.assign(n_fields, std::vector<CellVolumes>(static_cast<std::size_t>(mesh.n_cells())));
  fill_.assign(n_fields, std::vector<Real>(n_nodes, 0));
  hats_.assign(n_nodes, 0);
  for (Index c = 0; c < mesh.n_cells(); ++c)
    for (const Index n : mesh.cell(c))
      hats_[static_cast<std::size_t>(n)] += mesh.volume(c) / (D + 1);
  is_marked_.assign(static_cast<std::size_t>(mesh.n_cells()), 0);
  bodies_.assign(n_fields, {});
  for (std::size_t body = 0; body < contacts.field_of_body.size(); ++body)
    bodies_[contacts.field_of(static_cast<Index>(body))].push_back(static_cast<Index>(body));
  if (subdomain.alone())
    return;
  copies_ = copies_of_nodes(ranks, subdomain, MessageTag::contact_nodes, std::vector<std::uint8_t>(n_nodes, 1));
  cells_ = copies_of_cells(ranks, subdomain, MessageTag::contact_cells, mesh.n_cells());
  back_ = ReturnToOwners<Reach>(ranks, MessageTag::contact_reach, copies_, {-beyond, beyond});
}

template <int D>
void ContactNodes<D>::find_candidates(const OwnNodes& own, std::span<const VelocityField<D>> fields)
{
  nodes_.clear();
  for (std::size_t l = 0; l < contacts_.laws.size(); ++l) {
    const Nodes<D>& first = fields[static_cast<std::size_t>(contacts_.laws[l].first)].nodes;
    const Nodes<D>& second = fields[static_cast<std::size_t>(contacts_.laws[l].second)].nodes;
    std::vector<std::uint8_t>& candidate = candidate_[l];
    std::fill(candidate.begin(), candidate.end(), std::uint8_t{0});
    first.in_use.for_each_ascending([&](Index n) {
      const auto i = static_cast<std::size_t>(n);
      if (own.has(n) && first.active[i] != 0 && second.active[i] != 0) {
        candidate[i] = 1;
        nodes_.push_back({.node = n, .law = static_cast<Index>(l)});
      }
    });
    copies_.send(candidate, OfMarked{itself, candidate});
    copies_.take(candidate, OfMarked{itself, candidate});
  }
}

// Gradients of fillings are averaged over one ring around a candidate and reach one more, so fillings are needed within two.
template <int D>
void ContactNodes<D>::mark_cells(const Mesh<D>& mesh)
{
  ring_.assign(hats_.size(), 0);
  near_nodes_.clear();
  for (const auto& candidate : candidate_)
    for (std::size_t n = 0; n < candidate.size(); ++n)
      if (candidate[n] != 0 && std::exchange(ring_[n], std::uint8_t{1}) == 0)
        near_nodes_.push_back(static_cast<Index>(n));
  n_candidates_ = near_nodes_.size();
  std::size_t front = 0;
  for (std::uint8_t ring = 2; ring <= 3; ++ring)
    for (const std::size_t last = near_nodes_.size(); front < last; ++front)
      for (const Index m : mesh.ring_of_node()[near_nodes_[front]])
        if (ring_[static_cast<std::size_t>(m)] == 0) {
          ring_[static_cast<std::size_t>(m)] = ring;
          near_nodes_.push_back(m);
        }
  for (const Index c : marked_) {
    is_marked_[static_cast<std::size_t>(c)] = 0;
    for (auto& of_field : volumes_)
      of_field[static_cast<std::size_t>(c)] = {};
  }
  marked_.clear();
  for (const Index n : near_nodes_)
    for (const Index c : mesh.cells_of_node()[n])
      if (std::exchange(is_marked_[static_cast<std::size_t>(c)], std::uint8_t{1}) == 0)
        marked_.push_back(c);
}

template <int D>
void ContactNodes<D>::sum_volumes(const Mesh<D>& mesh, const ParticleStrips<D>& strips)
{
  parallel_for(static_cast<Index>(marked_.size()), [&](Index k) {
    const Index cell = marked_[static_cast<std::size_t>(k)];
    for (std::size_t f = 0; f < volumes_.size(); ++f) {
      Corners& sum = volumes_[f][static_cast<std::size_t>(cell)].of;
      for_each_particle_in<D>(strips, bodies_[f], cell, [&](const StripColumns<D>& columns, std::size_t p) {
        const std::array<Real, D + 1> share = mesh.barycentric(cell, columns.x.of(p));
        for (std::size_t a = 0; a <= D; ++a)
          sum[a] += share[a] * columns.volume.of(p);
      });
    }
  });
  for (auto& of_field : volumes_) {
    cells_.send(of_field, Whole{});
    cells_.take(of_field, Whole{});
  }
}

template <int D>
void ContactNodes<D>::find_normals(const Mesh<D>& mesh)
{
  parallel_for(static_cast<Index>(near_nodes_.size()), [&](Index k) {
    const Index n = near_nodes_[static_cast<std::size_t>(k)];
    for (std::size_t f = 0; f < fill_.size(); ++f) {
      Real volume = 0;
      for (const Index c : mesh.cells_of_node()[n])
        volume += volumes_[f][static_cast<std::size_t>(c)].of[local_number(mesh, c, n)];
      fill_[f][static_cast<std::size_t>(n)] = volume / hats_[static_cast<std::size_t>(n)];
    }
  });
  for (std::size_t l = 0; l < contacts_.laws.size(); ++l)
    find_normals_of(mesh, l);
  for (std::size_t l = 0; l < normal_.size(); ++l) {
    copies_.send(normal_[l], OfMarked{itself, candidate_[l]});
    copies_.take(normal_[l], OfMarked{itself, candidate_[l]});
  }
}

template <int D>
void ContactNodes<D>::find_normals_of(const Mesh<D>& mesh, std::size_t l)
{
  const ContactLaw& law = contacts_.laws[l];
  const std::vector<Real>&fill_1 = fill_[static_cast<std::size_t>(law.first)], &fill_2 = fill_[static_cast<std::size_t>(law.second)];
  gradients_.resize(hats_.size());
  parallel_for(static_cast<Index>(near_nodes_.size()), [&](Index k) {
    const Index n = near_nodes_[static_cast<std::size_t>(k)];
    NodeGradients& sum = gradients_[static_cast<std::size_t>(n)] = {};
    for (const Index c : mesh.cells_of_node()[n]) {
      Real first = 0, second = 0;
      Vec<D> of_first = Vec<D>::Zero(), of_second = Vec<D>::Zero();
      for (std::size_t a = 0; a <= D; ++a) {
        const auto m = static_cast<std::size_t>(mesh.cell(c)[a]);
        first += fill_1[m], second += fill_2[m];
        of_first += fill_1[m] * mesh.gradients(c)[a];
        of_second += fill_2[m] * mesh.gradients(c)[a];
      }
      const Real weight = mesh.volume(c) * first * second;
      sum.weight += weight;
      sum.first += weight * of_first, sum.second += weight * of_second;
      sum.area += mesh.volume(c) / (D + 1) * surface_in_cell<D>(of_first, of_second);
    }
    Real weights = 0;  // the candidates around the node share its surface
    for (const Index m : mesh.ring_of_node()[n])
      if (candidate_[l][static_cast<std::size_t>(m)] != 0)
        weights += m == n ? 1 : weight_of_neighbour;
    sum.area = weights > 0 ? sum.area / weights : 0;
  });
  for (ContactNode<D>& at : nodes_) {
    if (at.law != static_cast<Index>(l))
      continue;
    NodeGradients sum;
    for (const Index n : mesh.ring_of_node()[at.node]) {
      const NodeGradients& of_node = gradients_[static_cast<std::size_t>(n)];
      sum.area += (n == at.node ? 1 : weight_of_neighbour) * of_node.area;
      sum.weight += of_node.weight;
      sum.first += of_node.first, sum.second += of_node.second;
    }
    at.area = sum.area;
    if (!(sum.weight > 0))
      continue;
    const Vec<D> first = sum.first / sum.weight, second = sum.second / sum.weight;
    const Real larger = std::max({first.norm(), second.norm(), std::numeric_limits<Real>::min()});
    const Real of_first = std::pow(first.norm() / larger, power_of_steepness),
               of_second = std::pow(second.norm() / larger, power_of_steepness);
    const Vec<D> mean = (of_second * second - of_first * first) / std::max(of_first + of_second, std::numeric_limits<Real>::min());
    const Real size = mean.norm();
    if (size * mesh.node_size(at.node) > least_change)
      at.normal = mean / size;
    normal_[l][static_cast<std::size_t>(at.node)] = at.normal;
  }
}

template <int D>
void ContactNodes<D>::find_reach(const Mesh<D>& mesh, const ParticleStrips<D>& strips)
{
  for (std::size_t l = 0; l < reach_.size(); ++l) {
    const ContactLaw& law = contacts_.laws[l];
    parallel_for_uneven(static_cast<Index>(n_candidates_), [&](Index k) {
      const Index n = near_nodes_[static_cast<std::size_t>(k)];
      Reach& reach = reach_[l][static_cast<std::size_t>(n)] = {-beyond, beyond};
      const Vec<D> normal = normal_[l][static_cast<std::size_t>(n)];
      if (candidate_[l][static_cast<std::size_t>(n)] == 0 || normal.isZero(0))
        return;
      thread_local std::vector<Index> cells;
      cells.clear();
      for (const Index m : mesh.ring_of_node()[n])
        cells.insert(cells.end(), mesh.cells_of_node()[m].begin(), mesh.cells_of_node()[m].end());
      std::ranges::sort(cells);
      cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
      // Calls reach_of(distance along the normal, half width) for the particles beside the node.
      const auto for_each_beside = [&](Index field, auto&& reach_of) {
        const Real beside = mesh.node_size(n) / 2;
        for (const Index c : cells)
          for_each_particle_in<D>(strips, bodies_[static_cast<std::size_t>(field)], c, [&](const StripColumns<D>& columns, std::size_t p) {
            const Vec<D> arm = columns.x.of(p) - mesh.node(n);
            const Real along = normal.dot(arm);
            if (arm.squaredNorm() - along * along <= beside * beside)
              reach_of(along, half_width<D>(columns.F.of(p), columns.volume0.of(p), normal));
          });
      };
      for_each_beside(law.first, [&](Real along, Real half) { reach.first = std::max(reach.first, along + half); });
      for_each_beside(law.second, [&](Real along, Real half) { reach.second = std::min(reach.second, along - half); });
    });
    back_(reach_[l], Reached{}, [](Reach& reach, const Reach& other) {
      reach.first = std::max(reach.first, other.first);
      reach.second = std::min(reach.second, other.second);
    });
  }
  for (ContactNode<D>& at : nodes_) {
    const Reach& reach = reach_[static_cast<std::size_t>(at.law)][static_cast<std::size_t>(at.node)];
    at.touches = reach.first >= reach.second;
  }
}

template <int D>
void ContactNodes<D>::find(const Mesh<D>& mesh, const OwnNodes& own, const ParticleStrips<D>& strips,
                           std::span<const VelocityField<D>> fields)
{
  if (!any())
    return;
  find_candidates(own, fields);
  mark_cells(mesh);
  sum_volumes(mesh, strips);
  find_normals(mesh);
  find_reach(mesh, strips);
}

#define TALUS_INSTANTIATE(D)                                                                              \
  template void ContactNodes<D>::begin(const Mesh<D>&, const Subdomain&, Communicator&, const Contacts&); \
  template void ContactNodes<D>::find(const Mesh<D>&, const OwnNodes&, const ParticleStrips<D>&, std::span<const VelocityField<D>>);
TALUS_INSTANTIATE(2)
TALUS_INSTANTIATE(3)
#undef TALUS_INSTANTIATE

}  // namespace talus
