#include "mesh/generate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <stdexcept>

#include "mesh/connectivity.hpp"
#include "mesh/quality.hpp"
#include "mesh/simplex.hpp"

namespace talus {

namespace {

/// Uniform in [0, 1), the same everywhere: distributions of the standard library differ between libraries.
Real uniform(std::mt19937_64& random) { return static_cast<Real>(random() >> 11) * 0x1p-53; }

template <int D>
Vec<D> in_cube(std::mt19937_64& random)
{
  Vec<D> x;
  for (int d = 0; d < D; ++d)
    x[d] = 2 * uniform(random) - 1;
  return x;
}

/// Fisher-Yates.
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

/// Numbers of the nodes of a structured box, x fastest.
template <int D>
struct Grid {
  std::array<Index, D> cells;
  Index node(const std::array<Index, D>& at) const
  {
    Index n = 0;
    for (int d = D - 1; d >= 0; --d)
      n = n * (cells[d] + 1) + at[d];
    return n;
  }
  /// f(at) for all places with at[d] < count[d].
  template <class F>
  static void for_each(const std::array<Index, D>& count, F&& f)
  {
    std::array<Index, D> at{};
    const Index planes = D == 3 ? count[D - 1] : 1;
    for (Index k = 0; k < planes; ++k)
      for (Index j = 0; j < count[1]; ++j)
        for (Index i = 0; i < count[0]; ++i) {
          at[0] = i;
          at[1] = j;
          if constexpr (D == 3)
            at[2] = k;
          f(at);
        }
  }
};

template <int D>
MeshData<D> box_nodes(Vec<D> low, Vec<D> high, std::array<Index, D> cells)
{
  std::array<Index, D> count = cells;
  Real total = D == 2 ? 2 : 6;
  for (int d = 0; d < D; ++d) {
    if (!(low[d] < high[d]) || cells[d] < 1)
      throw std::invalid_argument(fmt::format("a box needs low < high and at least one cell along each axis, not {} to {} in {} cells", low[d],
                                              high[d], cells[d]));
    ++count[d];
    total *= cells[d];
  }
  if (total > std::numeric_limits<Index>::max() / (D + 1))
    throw std::invalid_argument(fmt::format("a box of {:.3g} cells is more than 32-bit numbers can count", total));
  MeshData<D> data;
  Grid<D>::for_each(count, [&](const std::array<Index, D>& at) {
    Vec<D> x;
    for (int d = 0; d < D; ++d)  // weights, not steps: the last node is `high` to the bit
      x[d] = (low[d] * (cells[d] - at[d]) + high[d] * at[d]) / cells[d];
    data.nodes.push_back(x);
  });
  return data;
}

/// Sides and the set `all`.  Facets on a side are recognised by their nodes, whatever way the cells were cut.
template <int D>
void name_sides(MeshData<D>& data, const Grid<D>& grid)
{
  constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
  std::array<Index, D> stride{};
  for (Index d = 0, step = 1; d < D; step *= grid.cells[d] + 1, ++d)
    stride[d] = step;
  const auto place_of = [&](Index node, int d) { return node / stride[d] % (grid.cells[d] + 1); };
  for (const auto& cell : data.cells)
    for (const auto& locals : facet_locals<D>) {
      std::array<Index, D> nodes;
      for (int i = 0; i < D; ++i)
        nodes[i] = cell[locals[i]];
      for (int d = 0; d < D; ++d)
        for (const bool top : {false, true})
          if (std::all_of(nodes.begin(), nodes.end(), [&](Index n) { return place_of(n, d) == (top ? grid.cells[d] : 0); }))
            data.facet_sets[fmt::format("{}_{}", axes[d], top ? "max" : "min")].push_back(nodes);
    }
  auto& all = data.cell_sets["all"];
  all.resize(data.cells.size());
  std::iota(all.begin(), all.end(), 0);
}

/// For each node the normals, orthonormal, of the boundary facets it belongs to: it may only move across them.
template <int D>
std::vector<std::vector<Vec<D>>> boundary_normals(const MeshData<D>& data)
{
  constexpr Real independent = 1e-6;  // sine of the angle between planes that count as two
  std::vector<std::vector<Vec<D>>> normals(data.nodes.size());
  const FacetMatch<D> match = match_facets<D>(data.cells, static_cast<Index>(data.nodes.size()));
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

/// Smallest |volume| at node n with the node at x, relative to what it was; negative if a cell is turned over.
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

/// The place above the middle of `base` where the smallest angle of all cells at node n is `angle`, if there is one.
template <int D>
std::optional<Vec<D>> press_flat(const MeshData<D>& data, std::span<const Index> cells, Index n, const std::array<Vec<D>, D>& base, Real angle)
{
  Vec<D> middle = Vec<D>::Zero();
  for (const Vec<D>& x : base)
    middle += x / D;
  const Vec<D> normal = area_vector(base).normalized();
  const Real top = normal.dot(data.nodes[n] - middle);  // signed
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
  Real high = 1;  // share of the height of the node; bisected until they are neighbouring numbers
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
MeshData<D> box(Vec<D> low, Vec<D> high, std::array<Index, D> cells)
{
  if constexpr (D == 2) {
    return box(low, high, cells, Diagonals::rising);
  } else {
    MeshData<D> data = box_nodes<D>(low, high, cells);
    const Grid<D> grid{cells};
    Grid<D>::for_each(cells, [&](const std::array<Index, D>& at) {
      // One tetrahedron per way from corner (0,0,0) to (1,1,1) along the edges of the brick.
      std::array<int, 3> way{0, 1, 2};
      do {
        std::array<Index, 3> corner = at;
        std::array<Index, 4> cell{grid.node(corner), 0, 0, 0};
        for (int i = 0; i < 3; ++i) {
          ++corner[way[i]];
          cell[i + 1] = grid.node(corner);
        }
        data.cells.push_back(cell);
      } while (std::next_permutation(way.begin(), way.end()));
    });
    name_sides(data, grid);
    return data;
  }
}

MeshData<2> box(Vec<2> low, Vec<2> high, std::array<Index, 2> cells, Diagonals diagonals, std::uint64_t seed)
{
  MeshData<2> data = box_nodes<2>(low, high, cells);
  const Grid<2> grid{cells};
  std::mt19937_64 random(seed);
  Grid<2>::for_each(cells, [&](const std::array<Index, 2>& at) {
    const auto [i, j] = at;
    const Index a = grid.node({i, j}), b = grid.node({i + 1, j}), c = grid.node({i + 1, j + 1}), d = grid.node({i, j + 1});
    const bool rising = diagonals == Diagonals::rising || (diagonals == Diagonals::alternating && (i + j) % 2 == 0) ||
                        (diagonals == Diagonals::random && uniform(random) < 0.5);
    if (rising)
      data.cells.insert(data.cells.end(), {{a, b, c}, {a, c, d}});
    else
      data.cells.insert(data.cells.end(), {{a, b, d}, {b, c, d}});
  });
  name_sides(data, grid);
  return data;
}

template <int D>
MeshData<D> jittered(MeshData<D> data, Real amount, std::uint64_t seed, BoundaryNodes boundary)
{
  constexpr Real least_share = 0.2;  // of its volume that a cell keeps in one move
  constexpr int most_halvings = 20;
  const Index n_nodes = static_cast<Index>(data.nodes.size());
  const Csr cells_of_node = cells_at_nodes<D>(data.cells, n_nodes);
  const auto normals = boundary_normals(data);
  const std::vector<Real> volume = signed_volumes(data);
  const std::vector<Vec<D>> start = data.nodes;
  std::mt19937_64 random(seed);
  for (Index n = 0; n < n_nodes; ++n) {
    Vec<D> move = in_cube<D>(random);  // drawn for every node, so that `boundary` changes nothing inside
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
  const auto [first, last] = std::minmax_element(data.nodes.begin(), data.nodes.end(), [](const auto& a, const auto& b) { return a[0] < b[0]; });
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
    const bool free_star = std::all_of(cells.begin(), cells.end(), [&](Index k) { return std::all_of(data.cells[k].begin(), data.cells[k].end(), free); });
    if (c == none || !normals[n].empty() || !free_star)
      continue;
    const Index local = static_cast<Index>(std::find(data.cells[c].begin(), data.cells[c].end(), n) - data.cells[c].begin());
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

template MeshData<2> box<2>(Vec<2>, Vec<2>, std::array<Index, 2>);
template MeshData<3> box<3>(Vec<3>, Vec<3>, std::array<Index, 3>);
template MeshData<2> jittered<2>(MeshData<2>, Real, std::uint64_t, BoundaryNodes);
template MeshData<3> jittered<3>(MeshData<3>, Real, std::uint64_t, BoundaryNodes);
template MeshData<2> graded<2>(MeshData<2>, Real);
template MeshData<3> graded<3>(MeshData<3>, Real);
template MeshData<2> slivered<2>(MeshData<2>, Real, Index, std::uint64_t);
template MeshData<3> slivered<3>(MeshData<3>, Real, Index, std::uint64_t);

}  // namespace talus
