#include "io/mesh/msh_assembler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "mesh/check.hpp"
#include "mesh/simplex.hpp"

namespace talus {

namespace {

template <class... Args>
[[noreturn]] void refuse(fmt::format_string<Args...> text, Args&&... args)
{
  throw std::invalid_argument(fmt::format(text, std::forward<Args>(args)...));
}

constexpr std::array<const char*, 4> simplices{"points", "edges", "triangles", "tetrahedra"};

template <class T>
void sort_unique(std::vector<T>& items)
{
  std::ranges::sort(items);
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace

int dimension_of_element(std::int64_t type, int highest)
{
  const auto refuse_shape = [](const char* shape) {
    refuse(
        "{} are not supported: mesh with triangles and tetrahedra only (in gmsh: Mesh.RecombineAll = 0, no Recombine, no Transfinite "
        "volumes)",
        shape);
  };
  switch (type) {
    case 15: return 0;
    case 1: return 1;
    case 2: return 2;
    case 4:
      if (highest < 3)
        refuse("tetrahedra in a scene of dimension 2: set dimension: 3 or use a plane mesh of triangles");
      return 3;
    case 3: refuse_shape("quadrilaterals"); break;
    case 5: refuse_shape("hexahedra"); break;
    case 6: refuse_shape("prisms"); break;
    case 7: refuse_shape("pyramids"); break;
    default: break;
  }
  if (type >= 8 && type <= 140)
    refuse("elements of type {} (second order or higher) are not supported: mesh with straight simplices (in gmsh: Mesh.ElementOrder = 1)",
           type);
  refuse("there is no element type {}", type);
}

template <int D>
void MshAssembler<D>::name_group(int dimension, std::int64_t tag, std::string name)
{
  if (dimension < 0 || dimension > 3)
    refuse("group \"{}\" has dimension {}, outside [0, 3]", name, dimension);
  for (const auto& [key, other] : names_)
    if (key == Key{dimension, tag})
      refuse("group {} of dimension {} has two names, \"{}\" and \"{}\"", tag, dimension, other, name);
    else if (key.first == dimension && other == name && !name.empty())
      refuse("two groups of dimension {} have the name \"{}\"", dimension, name);
  names_.emplace(Key{dimension, tag}, std::move(name));
}

template <int D>
void MshAssembler<D>::add_node(std::int64_t tag, const Vec3& x)
{
  node_tags_.push_back(tag);
  nodes_.push_back(x);
}

template <int D>
void MshAssembler<D>::close_nodes()
{
  if (nodes_.empty())
    refuse("the mesh has no nodes");
  Vec3 low = nodes_[0], high = low;
  for (const Vec3& x : nodes_) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  extent_ = (high - low).template head<2>().maxCoeff();
  const bool consecutive = std::ranges::adjacent_find(node_tags_, [](auto a, auto b) { return b != a + 1; }) == node_tags_.end();
  if (consecutive)
    return;
  by_tag_.resize(nodes_.size());
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    by_tag_[n] = {node_tags_[n], static_cast<Index>(n)};
  std::ranges::sort(by_tag_);
  const auto twice = std::ranges::adjacent_find(by_tag_, [](const auto& a, const auto& b) { return a.first == b.first; });
  if (twice != by_tag_.end())
    refuse("node {} occurs twice", twice->first);
}

template <int D>
Index MshAssembler<D>::node_of_tag(std::int64_t tag, std::int64_t element) const
{
  if (by_tag_.empty()) {
    if (tag >= node_tags_.front() && tag <= node_tags_.back())
      return static_cast<Index>(tag - node_tags_.front());
  } else {
    const auto found = std::ranges::lower_bound(by_tag_, std::pair{tag, Index{0}});
    if (found != by_tag_.end() && found->first == tag)
      return found->second;
  }
  refuse("element {} names node {}, which does not exist", element, tag);
}

template <int D>
void MshAssembler<D>::check_cell(std::int64_t tag, const Cell& cell) const
{
  Simplex<D> corners;
  Vec3 centre = Vec3::Zero();
  for (int a = 0; a <= D; ++a) {
    corners[a] = nodes_[cell[a]].template head<D>();
    centre += nodes_[cell[a]] / (D + 1);
  }
  if constexpr (D == 2) {
    const Real plane = nodes_[cells_.empty() ? cell[0] : cells_[0][0]][2];
    for (const Index n : cell)
      if (!(std::abs(nodes_[n][2] - plane) <= 1e-9 * extent_))  // round-off of a rotated plane
        refuse("the mesh is not in a plane of constant z: z = {} at node {}, {} elsewhere; a scene of dimension 2 lies in x and y",
               nodes_[n][2], node_tags_[n], plane);
  }
  const Real longest = longest_edge<D>(corners);
  if (!(std::abs(signed_volume<D>(corners)) > flat_cell * std::pow(longest, D)))  // false for overflow too
    refuse("element {} at {} has no volume", tag, place<D>(centre.template head<D>()));
}

template <int D>
void MshAssembler<D>::add_element(std::int64_t tag, int dimension, std::span<const std::int64_t> groups,
                                  std::span<const std::int64_t> node_tags)
{
  std::array<Index, 4> nodes{};
  for (int a = 0; a <= dimension; ++a) {
    nodes[a] = node_of_tag(node_tags[a], tag);
    if (std::find(nodes.begin(), nodes.begin() + a, nodes[a]) != nodes.begin() + a)
      refuse("element {} names node {} twice", tag, node_tags[a]);
  }
  element_tags_.push_back(tag);
  if (dimension == D) {
    Cell cell;
    std::copy_n(nodes.begin(), D + 1, cell.begin());
    check_cell(tag, cell);
    for (const std::int64_t group : groups)
      cells_of_[{dimension, group}].push_back(static_cast<Index>(cells_.size()));
    cells_.push_back(cell);
    return;
  }
  for (const std::int64_t group : groups) {
    if (dimension == D - 1) {
      std::array<Index, D> facet;
      std::copy_n(nodes.begin(), D, facet.begin());
      facets_of_[{dimension, group}].push_back(facet);
    } else {
      auto& set = nodes_of_[{dimension, group}];
      set.insert(set.end(), nodes.begin(), nodes.begin() + dimension + 1);
    }
  }
}

template <int D>
void MshAssembler<D>::check_element_tags()
{
  if (std::ranges::is_sorted(element_tags_, std::less_equal<>{}))
    return;
  std::ranges::sort(element_tags_);
  const auto twice = std::ranges::adjacent_find(element_tags_);
  if (twice != element_tags_.end())
    refuse("element {} occurs twice", *twice);
}

/// Keeps the first of the cells with equal nodes; returns the new number of every cell.
template <int D>
std::vector<Index> MshAssembler<D>::unite_repeated_cells()
{
  std::vector<std::pair<Cell, Index>> sorted(cells_.size());
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    sorted[c] = {cells_[c], static_cast<Index>(c)};
    std::ranges::sort(sorted[c].first);
  }
  std::ranges::sort(sorted);
  std::vector<Index> first(cells_.size()), number(cells_.size());
  for (std::size_t i = 0; i < sorted.size(); ++i)
    first[sorted[i].second] = i > 0 && sorted[i].first == sorted[i - 1].first ? first[sorted[i - 1].second] : sorted[i].second;
  Index saved = 0;
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const bool is_first = first[c] == static_cast<Index>(c);
    number[c] = is_first ? saved : number[first[c]];
    if (is_first)
      cells_[saved++] = cells_[c];
  }
  cells_.resize(static_cast<std::size_t>(saved));
  return number;
}

template <int D>
std::string MshAssembler<D>::name_of(const Key& group) const
{
  const auto name = names_.find(group);
  return name == names_.end() || name->second.empty() ? fmt::format("physical_{}_{}", group.first, group.second) : name->second;
}

template <int D>
MeshData<D> MshAssembler<D>::finish(bool repeats)
{
  if (cells_.empty())
    refuse("the mesh has no {}, which are the cells of a scene of dimension {}{}", simplices[D], D,
           element_tags_.empty() ? "" : "; its elements are of lower dimension");
  check_element_tags();
  std::vector<Index> cell_number(cells_.size());
  std::iota(cell_number.begin(), cell_number.end(), 0);
  if (repeats)
    cell_number = unite_repeated_cells();

  MeshData<D> data;
  std::vector<Index> node_number(nodes_.size(), none);
  for (const Cell& cell : cells_)
    for (const Index n : cell)
      node_number[n] = 0;
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    if (node_number[n] != none) {
      node_number[n] = static_cast<Index>(data.nodes.size());
      data.nodes.push_back(nodes_[n].template head<D>());
    }
  data.cells = std::move(cells_);
  for (Cell& cell : data.cells)
    for (Index& n : cell)
      n = node_number[n];

  std::vector<std::uint8_t> in_group(cell_number.size(), 0);
  std::vector<Index> repeated;  // cells that are repeated without a reason
  for (const auto& [key, cells] : cells_of_) {
    auto& set = data.cell_sets[name_of(key)];
    for (const Index c : cells) {
      set.push_back(cell_number[c]);
      in_group[c] = 1;
    }
    std::ranges::sort(set);
    for (std::size_t i = 1; i < set.size(); ++i)
      if (set[i] == set[i - 1])
        repeated.push_back(set[i]);
    sort_unique(set);
  }
  std::vector<std::uint8_t> is_there(data.cells.size(), 0);
  for (std::size_t c = 0; repeats && c < cell_number.size(); ++c)
    if (std::exchange(is_there[cell_number[c]], 1) != 0 && in_group[c] == 0)
      repeated.push_back(cell_number[c]);
  if (sort_unique(repeated); !repeated.empty()) {
    Vec<D> centre = Vec<D>::Zero();
    for (const Index n : data.cells[repeated.front()])
      centre += data.nodes[n] / (D + 1);
    data.notes.push_back(fmt::format("{} of {} cells are in the file more than once, the first at {}: each was taken once", repeated.size(),
                                     data.cells.size(), place<D>(centre)));
  }
  for (const auto& [key, facets] : facets_of_) {
    auto& set = data.facet_sets[name_of(key)];
    for (auto facet : facets) {
      for (Index& n : facet) {
        if (node_number[n] == none)
          refuse("a facet of group \"{}\" touches node {}, which belongs to no cell: the group must lie on cells", name_of(key),
                 node_tags_[n]);
        n = node_number[n];
      }
      set.push_back(facet);
    }
  }
  for (const auto& [key, nodes] : nodes_of_) {
    std::vector<Index> set;
    for (const Index n : nodes)
      if (node_number[n] != none)
        set.push_back(node_number[n]);
    if (set.empty())
      continue;
    auto& all = data.node_sets[name_of(key)];
    all.insert(all.end(), set.begin(), set.end());
    sort_unique(all);
  }
  return data;
}

template class MshAssembler<2>;
template class MshAssembler<3>;

}  // namespace talus
