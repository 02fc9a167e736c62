#include "mesh/overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "mesh/geometry/box_tree.hpp"
#include "mesh/simplex.hpp"

namespace talus {

namespace {

/// The length by which the projections of two simplices on an axis overlap [m]; if negative, the gap between them.
template <int D>
Real overlap_along(const Vec<D>& axis, const Simplex<D>& p, const Simplex<D>& q)
{
  const auto range = [&](const Simplex<D>& s) {
    std::pair<Real, Real> ends{std::numeric_limits<Real>::infinity(), -std::numeric_limits<Real>::infinity()};
    for (const Vec<D>& corner : s) {
      const Real at = axis.dot(corner - p[0]);
      ends = {std::min(ends.first, at), std::max(ends.second, at)};
    }
    return ends;
  };
  const auto [p_low, p_high] = range(p);
  const auto [q_low, q_high] = range(q);
  return std::min(p_high, q_high) - std::max(p_low, q_low);
}

/// Whether two simplices penetrate each other by more than a depth [m].  If not, they are separated by a plane along a facet of one of
/// them, or in 3-D along an edge of each (Gottschalk, Lin & Manocha 1996, SIGGRAPH, 171).
template <int D>
bool penetrate(const Simplex<D>& p, const Simplex<D>& q, Real depth)
{
  const auto separates = [&](const Vec<D>& axis) {
    const Real length = axis.norm();
    return length > 0 && overlap_along<D>(axis / length, p, q) <= depth;
  };
  for (const Simplex<D>* s : {&p, &q})
    for (int a = 0; a <= D; ++a)
      if (separates(area_vector(facet<D>(*s, a))))
        return false;
  if constexpr (D == 3) {
    constexpr std::array<std::array<std::size_t, 2>, 6> edges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
    for (const auto& [a, b] : edges)
      for (const auto& [c, d] : edges) {
        const Vec<3> along = (p[b] - p[a]).normalized(), across = (q[d] - q[c]).normalized(), axis = along.cross(across);
        constexpr Real parallel = 1e-9;  // sine of the angle below which an axis is round-off
        if (axis.norm() > parallel && separates(axis))
          return false;
      }
  }
  return true;
}

template <int D>
Extent<D> box_of(const Simplex<D>& s)
{
  Extent<D> box;
  for (const Vec<D>& corner : s)
    box.take(corner);
  return box;
}

}  // namespace

template <int D>
std::optional<OverlappingCells> find_overlap(const Mesh<D>& mesh)
{
  const BoxTree<D> tree(mesh.n_cells(), [&](Index c) { return box_of<D>(mesh.corners(c)); });
  std::vector<std::uint8_t> at_boundary(static_cast<std::size_t>(mesh.n_cells()), 0);
  for (const Facet f : mesh.boundary_facets())
    at_boundary[static_cast<std::size_t>(f.cell)] = 1;
  std::optional<OverlappingCells> found;
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    if (at_boundary[static_cast<std::size_t>(c)] == 0)
      continue;
    const Simplex<D> cell = mesh.corners(c);
    tree.around(box_of<D>(cell), [&](Index other) {
      const bool is_seen_once = other > c || (other < c && at_boundary[static_cast<std::size_t>(other)] == 0);
      if (is_seen_once && penetrate<D>(cell, mesh.corners(other), least_penetration * std::min(mesh.altitude(c), mesh.altitude(other)))) {
        if (!found)
          found = {std::min(c, other), std::max(c, other), 0};
        ++found->pairs;
      }
      return false;
    });
  }
  return found;
}

template <int D>
std::vector<std::vector<Index>> unjoined_nodes(const MeshData<D>& data)
{
  std::vector<Index> nodes;
  Real shortest = std::numeric_limits<Real>::infinity();
  const auto boundary = data.facet_sets.find("boundary");
  if (boundary == data.facet_sets.end())
    return {};
  const auto at = [&](Index n) -> const Vec<D>& { return data.nodes[static_cast<std::size_t>(n)]; };
  for (const auto& facet : boundary->second)
    for (std::size_t a = 0; a < D; ++a) {
      nodes.push_back(facet[a]);
      shortest = std::min(shortest, (at(facet[a]) - at(facet[(a + 1) % D])).norm());
    }
  // A direction along which nodes of a plane side or of a grid hardly ever have equal positions.
  constexpr std::array<Real, 3> direction{0.7548776662, 0.5698402910, 0.4301597090};
  const auto along = [&](Index n) {
    Real sum = 0;
    for (int d = 0; d < D; ++d)
      sum += direction[static_cast<std::size_t>(d)] * at(n)[d];
    return sum;
  };
  std::sort(nodes.begin(), nodes.end(), [&](Index n, Index m) { return std::pair(along(n), n) < std::pair(along(m), m); });
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const Real near = 1e-6 * shortest, near_along = std::sqrt(D) * near;
  std::vector<std::vector<Index>> groups;
  std::vector<std::uint8_t> taken(nodes.size(), 0);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (taken[i] != 0)
      continue;
    std::vector<Index> group{nodes[i]};
    for (std::size_t j = i + 1; j < nodes.size() && along(nodes[j]) - along(nodes[i]) <= near_along; ++j)
      if (taken[j] == 0 && (at(nodes[j]) - at(nodes[i])).norm() <= near)
        group.push_back(nodes[j]), taken[j] = 1;
    if (group.size() == 1)
      continue;
    std::sort(group.begin(), group.end());
    groups.push_back(std::move(group));
  }
  std::sort(groups.begin(), groups.end());
  return groups;
}

template std::optional<OverlappingCells> find_overlap<2>(const Mesh<2>&);
template std::optional<OverlappingCells> find_overlap<3>(const Mesh<3>&);
template std::vector<std::vector<Index>> unjoined_nodes<2>(const MeshData<2>&);
template std::vector<std::vector<Index>> unjoined_nodes<3>(const MeshData<3>&);

}  // namespace talus
