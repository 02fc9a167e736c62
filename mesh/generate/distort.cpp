// Distortions of meshes, declared in generate.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "mesh/connectivity.hpp"
#include "mesh/generate/generate.hpp"
#include "mesh/generate/random.hpp"
#include "mesh/quality.hpp"
#include "mesh/simplex.hpp"

namespace talus {

namespace {

template <int D>
Vec<D> in_cube(std::mt19937_64& random)
{
  Vec<D> x;
  for (int d = 0; d < D; ++d)
    x[d] = 2 * uniform(random) - 1;
  return x;
}

/// A random permutation of 0 ... n-1 (Fisher-Yates).
std::vector<Index> shuffled(Index n, std::mt19937_64& random)
{
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), 0);
  for (Index i = n - 1; i > 0; --i)
    std::swap(order[i], order[static_cast<Index>(uniform(random) * (i + 1))]);
  return order;
}

template <int D>
Simplex<D> corners(const MeshData<D>& data, Index c)
{
  Simplex<D> s;
  for (int a = 0; a <= D; ++a)
    s[a] = data.nodes[data.cells[c][a]];
  return s;
}

/// For each node the orthonormal normals of its boundary facets; the node may only move perpendicular to them.
template <int D>
std::vector<std::vector<Vec<D>>> boundary_normals(const MeshData<D>& data)
{
  constexpr Real independent = 1e-6;  // sine of the angle above which two planes count as different
  std::vector<std::vector<Vec<D>>> normals(data.nodes.size());
  const FacetMatch<D> match = match_facets<D>(data.cells, cells_at_nodes<D>(data.cells, static_cast<Index>(data.nodes.size())));
  for (Index c = 0; c < static_cast<Index>(data.cells.size()); ++c)
    for (int a = 0; a <= D; ++a) {
      if (match.neighbours[c][a] != none)
        continue;
      const Vec<D> unit = area_vector(facet<D>(corners(data, c), a)).normalized();
      for (const int local : facet_locals<D>[a]) {
        auto& basis = normals[data.cells[c][local]];
        Vec<D> rest = unit;
        for (const Vec<D>& n : basis)
          rest -= n.dot(rest) * n;
        if (rest.norm() > independent)
          basis.push_back(rest.normalized());
      }
    }
  return normals;
}

/// The smallest |volume| at node n after moving it to x, relative to its volume before; negative if a cell is inverted.
template <int D>
Real least_volume_ratio(const MeshData<D>& data, std::span<const Index> cells, Index n, const Vec<D>& x, std::span<const Real> volume)
{
  Real least = std::numeric_limits<Real>::infinity();
  for (const Index c : cells) {
    Simplex<D> s = corners(data, c);
    for (int a = 0; a <= D; ++a)
      if (data.cells[c][a] == n)
        s[a] = x;
    least = std::min(least, signed_volume<D>(s) / volume[c]);
  }
  return least;
}

/// The position above the middle of `base` where the smallest angle of all cells at node n is `angle`, if it exists.
template <int D>
std::optional<Vec<D>> press_flat(const MeshData<D>& data, std::span<const Index> cells, Index n, const std::array<Vec<D>, D>& base,
                                 Real angle)
{
  Vec<D> middle = Vec<D>::Zero();
  for (const Vec<D>& x : base)
    middle += x / D;
  const Vec<D> normal = area_vector(base).normalized();
  const Real top = normal.dot(data.nodes[n] - middle);  // signed height [m]
  const auto least_angle = [&](const Vec<D>& x) {
    Real least = std::numeric_limits<Real>::infinity();
    for (const Index c : cells) {
      Simplex<D> s = corners(data, c);
      for (int a = 0; a <= D; ++a)
        if (data.cells[c][a] == n)
          s[a] = x;
      least = std::min(least, smallest_angle<D>(s));
    }
    return least;
  };
  Real high = 1;  // fraction of the height of the node; bisected down to neighbouring numbers
  while (high > 0 && least_angle(middle + high * top * normal) >= angle)
    high /= 2;
  if (high == 1)
    return std::nullopt;
  Real low = high;
  high *= 2;
  for (Real half = (low + high) / 2; low < half && half < high; half = (low + high) / 2)
    (least_angle(middle + half * top * normal) < angle ? low : high) = half;
  return middle + high * top * normal;
}

template <int D>
std::vector<Real> signed_volumes(const MeshData<D>& data)
{
  std::vector<Real> volume(data.cells.size());
  for (std::size_t c = 0; c < volume.size(); ++c)
    volume[c] = signed_volume<D>(corners(data, static_cast<Index>(c)));
  return volume;
}

}  // namespace

template <int D>
MeshData<D> jittered(MeshData<D> data, Real amount, std::uint64_t seed, BoundaryNodes boundary)
{
  constexpr Real least_share = 0.2;  // smallest fraction of its volume that a cell keeps in one move
  constexpr int most_halvings = 20;
  const Index n_nodes = static_cast<Index>(data.nodes.size());
  const Csr cells_of_node = cells_at_nodes<D>(data.cells, n_nodes);
  const auto normals = boundary_normals(data);
  const std::vector<Real> volume = signed_volumes(data);
  const std::vector<Vec<D>> start = data.nodes;
  std::mt19937_64 random(seed);
  for (Index n = 0; n < n_nodes; ++n) {
    Vec<D> move = in_cube<D>(random);  // drawn for every node, so that the option `boundary` does not change inner nodes
    if (!normals[n].empty() && boundary == BoundaryNodes::stay)
      continue;
    Real shortest = std::numeric_limits<Real>::infinity();
    for (const Index c : cells_of_node[n])
      for (const Index m : data.cells[c])
        if (m != n)
          shortest = std::min(shortest, (start[m] - start[n]).norm());
    move *= amount * shortest;
    for (const Vec<D>& normal : normals[n])
      move -= normal.dot(move) * normal;
    for (int halving = 0; halving < most_halvings; ++halving, move /= 2)
      if (least_volume_ratio<D>(data, cells_of_node[n], n, start[n] + move, volume) > least_share) {
        data.nodes[n] = start[n] + move;
        break;
      }
  }
  return data;
}

template <int D>
MeshData<D> graded(MeshData<D> data, Real ratio)
{
  if (!(ratio > 0) || !std::isfinite(ratio))
    throw std::invalid_argument(fmt::format("the ratio of a grading must be positive, not {}", ratio));
  if (ratio == 1 || data.nodes.empty())
    return data;
  const auto [first, last] =
      std::minmax_element(data.nodes.begin(), data.nodes.end(), [](const auto& a, const auto& b) { return a[0] < b[0]; });
  const Real low = (*first)[0], length = (*last)[0] - low;
  for (Vec<D>& x : data.nodes)
    x[0] = low + length * std::expm1((x[0] - low) / length * std::log(ratio)) / (ratio - 1);
  return data;
}

template <int D>
MeshData<D> slivered(MeshData<D> data, Real angle, Index count, std::uint64_t seed)
{
  if (!(angle > 0 && angle < 0.5236))
    throw std::invalid_argument(fmt::format("the angle of flat cells must lie between 0 and pi/6, not {} rad", angle));
  const Index n_nodes = static_cast<Index>(data.nodes.size());
  const Csr cells_of_node = cells_at_nodes<D>(data.cells, n_nodes);
  const auto normals = boundary_normals(data);
  const std::vector<Real> volume = signed_volumes(data);
  std::vector<std::uint8_t> used(data.nodes.size(), 0);
  std::mt19937_64 random(seed);
  Index made = 0;
  for (const Index n : shuffled(n_nodes, random)) {
    if (made == count)
      break;
    const auto cells = cells_of_node[n];
    const Index c = cells.empty() ? none : cells[static_cast<std::size_t>(uniform(random) * static_cast<Real>(cells.size()))];
    const auto free = [&](Index m) { return used[m] == 0; };
    const bool free_star = std::ranges::all_of(cells, [&](Index k) { return std::ranges::all_of(data.cells[k], free); });
    if (c == none || !normals[n].empty() || !free_star)
      continue;
    const Index local = static_cast<Index>(std::ranges::find(data.cells[c], n) - data.cells[c].begin());
    const std::optional<Vec<D>> pressed = press_flat<D>(data, cells, n, facet<D>(corners(data, c), static_cast<int>(local)), angle);
    if (!pressed || !(least_volume_ratio<D>(data, cells, n, *pressed, volume) > 0))
      continue;
    data.nodes[n] = *pressed;
    for (const Index k : cells)
      for (const Index m : data.cells[k])
        used[m] = 1;
    ++made;
  }
  if (made < count)
    throw std::invalid_argument(fmt::format("there is room for only {} of {} flat cells", made, count));
  return data;
}

template MeshData<2> jittered<2>(MeshData<2>, Real, std::uint64_t, BoundaryNodes);
template MeshData<3> jittered<3>(MeshData<3>, Real, std::uint64_t, BoundaryNodes);
template MeshData<2> graded<2>(MeshData<2>, Real);
template MeshData<3> graded<3>(MeshData<3>, Real);
template MeshData<2> slivered<2>(MeshData<2>, Real, Index, std::uint64_t);
template MeshData<3> slivered<3>(MeshData<3>, Real, Index, std::uint64_t);

}  // namespace talus
