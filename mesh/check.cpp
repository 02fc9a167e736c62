#include "mesh/check.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "core/parallel/threads.hpp"
#include "mesh/connectivity.hpp"
#include "mesh/simplex.hpp"

namespace talus {

namespace {

template <class... Arguments>
[[noreturn]] void refuse(fmt::format_string<Arguments...> text, Arguments&&... arguments)
{
  throw std::invalid_argument(fmt::format(text, std::forward<Arguments>(arguments)...));
}

template <int D>
Simplex<D> corners(std::span<const Vec<D>> nodes, const std::array<Index, D + 1>& cell)
{
  Simplex<D> s;
  for (int a = 0; a <= D; ++a)
    s[a] = nodes[cell[a]];
  return s;
}

/// The text "nodes 1, 2 and 3 at (0, 1)", with the centre of the facet.
template <int D>
std::string facet_name(const Renumbered<D>& mesh, Facet f)
{
  std::array<Index, D> numbers;
  Vec<D> middle = Vec<D>::Zero();
  for (int i = 0; i < D; ++i) {
    const Index n = mesh.cells[f.cell][facet_locals<D>[f.local][i]];
    numbers[i] = mesh.node_number[n];
    middle += mesh.nodes[n] / D;
  }
  std::sort(numbers.begin(), numbers.end());
  return fmt::format("nodes {} at {}", and_list(numbers), place<D>(middle));
}

template <int D>
[[noreturn]] void refuse_pair(const Renumbered<D>& mesh, Facet f, Index other)
{
  const auto [first, second] = std::minmax({mesh.cell_number[f.cell], mesh.cell_number[other]});
  if (same_nodes(mesh.cells[f.cell], mesh.cells[other]))
    refuse("cells {} and {} at {} are the same cell twice", first, second,
           place<D>(centroid<D>(corners<D>(mesh.nodes, mesh.cells[other]))));
  refuse("cells {} and {} overlap: they lie on the same side of their common facet with {}", first, second, facet_name(mesh, f));
}

}  // namespace

template <int D>
std::string place(const Vec<D>& x)
{
  if constexpr (D == 2)
    return fmt::format("({:.6g}, {:.6g})", x[0], x[1]);
  else
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
}

std::string and_list(std::span<const Index> numbers)
{
  std::string text;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    text += fmt::format("{}{}", i == 0 ? "" : i + 1 == numbers.size() ? " and " : ", ", numbers[i]);
  return text;
}

namespace {

/// Whether a cell has a node twice, one that does not exist, or no volume.
template <int D>
bool is_bad(const MeshData<D>& data, const std::array<Index, D + 1>& cell) noexcept
{
  const auto n_nodes = static_cast<Index>(data.nodes.size());
  for (int a = 0; a <= D; ++a) {
    if (cell[a] < 0 || cell[a] >= n_nodes)
      return true;
    for (int b = a + 1; b <= D; ++b)
      if (cell[a] == cell[b])
        return true;
  }
  const Simplex<D> s = corners<D>(data.nodes, cell);
  const Real longest = longest_edge<D>(s), cubed = longest * longest * (D == 2 ? 1 : longest);
  return !(std::abs(signed_volume<D>(s)) > flat_cell * cubed);
}

/// Throws with what is wrong with the cell.
template <int D>
[[noreturn]] void refuse_cell(const MeshData<D>& data, Index c)
{
  const auto& cell = data.cells[c];
  const auto n_nodes = static_cast<Index>(data.nodes.size());
  for (const Index n : cell)
    if (n < 0 || n >= n_nodes)
      refuse("cell {} refers to node {}, but there are {} nodes, counted from 0", c, n, n_nodes);
  for (int a = 0; a <= D; ++a)
    for (int b = a + 1; b <= D; ++b)
      if (cell[a] == cell[b])
        refuse("cell {} at {} has node {} twice", c, place<D>(data.nodes[cell[a]]), cell[a]);
  const Simplex<D> s = corners<D>(data.nodes, cell);
  refuse("cell {} at {} is flat: its {} is {:.3g} m^{} with a longest edge of {:.3g} m", c, place<D>(centroid<D>(s)),
         D == 2 ? "area" : "volume", std::abs(signed_volume<D>(s)), D, longest_edge<D>(s));
}

/// The first of `n` items that is bad; n if there is none.
template <class IsBad>
Index first_bad(Index n, IsBad&& is_bad)
{
  return static_cast<Index>(parallel_min(n, n, [&](Index i) { return is_bad(i) ? i : n; }));
}

}  // namespace

template <int D>
void check_nodes_and_cells(const MeshData<D>& data)
{
  if (data.cells.empty())
    refuse("the mesh has no {}", D == 2 ? "triangles" : "tetrahedra");
  if (data.cells.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max()) / (D + 1))
    refuse("the mesh has {} cells, more than 32-bit numbers can count", data.cells.size());
  const auto n_nodes = static_cast<Index>(data.nodes.size()), n_cells = static_cast<Index>(data.cells.size());
  if (const Index n = first_bad(n_nodes, [&](Index i) { return !data.nodes[i].allFinite(); }); n < n_nodes)
    refuse("node {} at {} has a coordinate that is not a finite number", n, place<D>(data.nodes[n]));
  if (const Index c = first_bad(n_cells, [&](Index i) { return is_bad(data, data.cells[i]); }); c < n_cells)
    refuse_cell(data, c);
}

void check_number(Index number, std::size_t count, std::string_view kind, std::string_view group, std::string_view what)
{
  if (number < 0 || static_cast<std::size_t>(number) >= count)
    refuse("{} \"{}\" refers to {} {}, but there are {}, counted from 0", kind, group, what, number, count);
}

template <int D>
void refuse_crowded_facet(const Renumbered<D>& mesh, const std::array<Facet, 3>& claims)
{
  for (int i = 0; i < 3; ++i)
    for (int j = i + 1; j < 3; ++j)
      if (same_nodes(mesh.cells[claims[i].cell], mesh.cells[claims[j].cell]))
        refuse_pair(mesh, claims[i], claims[j].cell);
  std::array<Index, 3> numbers;
  for (int i = 0; i < 3; ++i)
    numbers[i] = mesh.cell_number[claims[i].cell];
  std::sort(numbers.begin(), numbers.end());
  refuse("the facet with {} belongs to more than two cells: {}", facet_name(mesh, claims[0]), and_list(numbers));
}

namespace {

/// Whether a cell and its neighbour lie on the same side of the facet, or have the same nodes.
template <int D>
bool overlap(const std::array<Index, D + 1>& cell, Index a, const std::array<Index, D + 1>& other) noexcept
{
  // Outward orders of a facet seen from its two sides are odd permutations of each other.
  std::array<Index, D> seen, across;
  for (int i = 0; i < D; ++i)
    seen[i] = cell[facet_locals<D>[a][i]];
  int b = 0;
  while (std::find(seen.begin(), seen.end(), other[b]) != seen.end())
    ++b;
  for (int i = 0; i < D; ++i)
    across[i] = other[facet_locals<D>[b][i]];
  const auto first = std::find(across.begin(), across.end(), seen[0]) - across.begin();
  const bool same_order = across[static_cast<std::size_t>(first + 1) % D] == seen[1];
  return D == 2 ? first == 0 : same_order;
}

}  // namespace

template <int D>
void check_overlap(const Renumbered<D>& mesh, std::span<const std::array<Index, D + 1>> neighbours)
{
  const auto n_cells = static_cast<Index>(mesh.cells.size());
  const auto overlaps = [&](Index c, Index a) {
    const Index other = neighbours[c][a];
    return other > c && overlap<D>(mesh.cells[c], a, mesh.cells[other]);  // if lower: `none`, or checked from the other side
  };
  const Index c = first_bad(n_cells, [&](Index i) {
    bool any = false;
    for (Index a = 0; a <= D; ++a)
      any = any || overlaps(i, a);
    return any;
  });
  for (Index a = 0; a <= D && c < n_cells; ++a)
    if (overlaps(c, a))
      refuse_pair(mesh, Facet{c, a}, neighbours[c][a]);
}

template std::string place<2>(const Vec<2>&);
template std::string place<3>(const Vec<3>&);
template void check_nodes_and_cells<2>(const MeshData<2>&);
template void check_nodes_and_cells<3>(const MeshData<3>&);
template void refuse_crowded_facet<2>(const Renumbered<2>&, const std::array<Facet, 3>&);
template void refuse_crowded_facet<3>(const Renumbered<3>&, const std::array<Facet, 3>&);
template void check_overlap<2>(const Renumbered<2>&, std::span<const std::array<Index, 3>>);
template void check_overlap<3>(const Renumbered<3>&, std::span<const std::array<Index, 4>>);

}  // namespace talus
