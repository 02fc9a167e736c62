#include "mesh/check.hpp"

#include <fmt/format.h>

#include <stdexcept>

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

template <int D>
void check_nodes_and_cells(const MeshData<D>& data)
{
  if (data.cells.empty())
    refuse("the mesh has no {}", D == 2 ? "triangles" : "tetrahedra");
  if (data.cells.size() > static_cast<std::size_t>(std::numeric_limits<Index>::max()) / (D + 1))
    refuse("the mesh has {} cells, more than 32-bit numbers can count", data.cells.size());
  const Index n_nodes = static_cast<Index>(data.nodes.size());
  for (Index n = 0; n < n_nodes; ++n)
    if (!data.nodes[n].allFinite())
      refuse("node {} at {} has a coordinate that is not a finite number", n, place<D>(data.nodes[n]));
  for (std::size_t c = 0; c < data.cells.size(); ++c) {
    const auto& cell = data.cells[c];
    for (const Index n : cell)
      if (n < 0 || n >= n_nodes)
        refuse("cell {} refers to node {}, but there are {} nodes, counted from 0", c, n, n_nodes);
    for (int a = 0; a <= D; ++a)
      for (int b = a + 1; b <= D; ++b)
        if (cell[a] == cell[b])
          refuse("cell {} at {} has node {} twice", c, place<D>(data.nodes[cell[a]]), cell[a]);
    const Simplex<D> s = corners<D>(data.nodes, cell);
    const Real volume = std::abs(signed_volume<D>(s)), longest = longest_edge<D>(s);
    if (!(volume > flat_cell * std::pow(longest, D)))
      refuse("cell {} at {} is flat: its {} is {:.3g} m^{} with a longest edge of {:.3g} m", c, place<D>(centroid<D>(s)),
             D == 2 ? "area" : "volume", volume, D, longest);
  }
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

template <int D>
void check_overlap(const Renumbered<D>& mesh, std::span<const std::array<Index, D + 1>> neighbours)
{
  for (Index c = 0; c < static_cast<Index>(mesh.cells.size()); ++c)
    for (Index a = 0; a <= D; ++a) {
      const Index other = neighbours[c][a];
      if (other < c)  // `none`, or already checked from the other side
        continue;
      // Outward orders of a facet seen from its two sides are odd permutations of each other.
      std::array<Index, D> seen, across;
      int b = 0;
      for (int i = 0; i < D; ++i)
        seen[i] = mesh.cells[c][facet_locals<D>[a][i]];
      while (std::find(seen.begin(), seen.end(), mesh.cells[other][b]) != seen.end())
        ++b;
      for (int i = 0; i < D; ++i)
        across[i] = mesh.cells[other][facet_locals<D>[b][i]];
      const auto first = std::find(across.begin(), across.end(), seen[0]) - across.begin();
      const bool same_order = across[static_cast<std::size_t>(first + 1) % D] == seen[1];
      if (D == 2 ? first == 0 : same_order)
        refuse_pair(mesh, Facet{c, a}, other);
    }
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
