#include "mesh/generate/generate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "mesh/generate/random.hpp"
#include "mesh/simplex.hpp"

namespace talus {

namespace {

/// The numbers of the nodes of a structured box, x fastest.
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
  /// Calls f(at) for all grid positions with at[d] < count[d].
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
      throw std::invalid_argument(
          fmt::format("a box needs low < high and at least one cell along each axis, not {} to {} in {} cells", low[d], high[d], cells[d]));
    ++count[d];
    total *= cells[d];
  }
  if (total * (D + 1) > std::numeric_limits<Index>::max())
    throw std::invalid_argument(fmt::format("a box of {:.3g} cells is more than 32-bit numbers can count", total));
  MeshData<D> data;
  Grid<D>::for_each(count, [&](const std::array<Index, D>& at) {
    Vec<D> x;
    for (int d = 0; d < D; ++d)  // interpolated, not accumulated: the last node is bitwise `high`
      x[d] = (low[d] * (cells[d] - at[d]) + high[d] * at[d]) / cells[d];
    data.nodes.push_back(x);
  });
  return data;
}

/// Makes the facet sets of the sides and the cell set `all`.  Facets on a side are recognised by their nodes, for every division of cells.
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
      // One tetrahedron for each path from corner (0,0,0) to (1,1,1) along the edges of the brick.
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

template MeshData<2> box<2>(Vec<2>, Vec<2>, std::array<Index, 2>);
template MeshData<3> box<3>(Vec<3>, Vec<3>, std::array<Index, 3>);

}  // namespace talus
