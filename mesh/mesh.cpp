#include "mesh/mesh.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "core/parallel/parallel_sort.hpp"
#include "core/parallel/threads.hpp"
#include "mesh/check.hpp"
#include "mesh/connectivity.hpp"
#include "mesh/simplex.hpp"

namespace talus {

namespace {

/// The new number of every old number: the inverse of a list of old numbers.
std::vector<Index> inverse(std::span<const Index> old_numbers, std::size_t count)
{
  std::vector<Index> renumbered(count, none);
  for (std::size_t i = 0; i < old_numbers.size(); ++i)
    renumbered[old_numbers[i]] = static_cast<Index>(i);
  return renumbered;
}

void sort_unique(std::vector<Index>& numbers)
{
  parallel_sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

/// A set in new numbers, ascending.  Members without a new number (nodes of no cell) are left out; throws if none is left.
std::vector<Index> renumber(const std::vector<Index>& members, std::span<const Index> renumbered, std::string_view kind,
                            std::string_view name, std::string_view what)
{
  std::vector<Index> result;
  result.reserve(members.size());
  for (const Index member : members) {
    check_number(member, renumbered.size(), kind, name, what);
    if (renumbered[member] != none)
      result.push_back(renumbered[member]);
  }
  if (result.empty() && !members.empty())
    throw std::invalid_argument(fmt::format("{} \"{}\": none of its {} nodes belongs to a cell", kind, name, members.size()));
  sort_unique(result);
  return result;
}

bool is_before(Facet a, Facet b) noexcept { return std::tie(a.cell, a.local) < std::tie(b.cell, b.local); }

/// The entries of `values` for each of `chosen`.
template <class T>
std::vector<T> picked(const std::vector<T>& values, std::span<const Index> chosen)
{
  std::vector<T> result(chosen.size());
  parallel_for(static_cast<Index>(chosen.size()), [&](Index i) { result[i] = values[chosen[i]]; });
  return result;
}

/// The new numbers of the members of a set that have one.
std::vector<Index> held(const std::vector<Index>& members, std::span<const Index> renumbered)
{
  std::vector<Index> result;
  for (const Index member : members)
    if (renumbered[member] != none)
      result.push_back(renumbered[member]);
  return result;
}

/// The facet with these nodes, as facet of the lower numbered of its cells.
template <int D>
std::optional<Facet> find_facet(const Mesh<D>& mesh, const std::array<Index, D>& nodes)
{
  for (const Index c : mesh.cells_of_node()[nodes[0]]) {
    const auto& cell = mesh.cell(c);
    const bool holds_all = std::ranges::all_of(nodes, [&](Index n) { return std::ranges::find(cell, n) != cell.end(); });
    if (!holds_all)
      continue;
    for (Index a = 0; a <= D; ++a)
      if (std::ranges::find(nodes, cell[a]) == nodes.end())
        return Facet{c, a};
  }
  return std::nullopt;
}

template <class Map>
std::vector<std::string> names_of(const Map& sets)
{
  std::vector<std::string> names;
  for (const auto& [name, members] : sets)
    names.push_back(name);
  return names;
}

}  // namespace

template <int D>
Mesh<D>::Mesh(MeshData<D> data)
{
  check_nodes_and_cells(data);
  const std::vector<Index> old_cells = hilbert_order<D>(data.nodes, data.cells);
  const std::vector<Index> old_nodes = take_cells(data, old_cells);
  const Renumbered<D> named{cells_, nodes_, old_cells, old_nodes};

  cells_of_node_ = cells_at_nodes<D>(cells_, n_nodes());
  FacetMatch<D> match = match_facets<D>(cells_, cells_of_node_);
  if (match.crowded)
    refuse_crowded_facet(named, *match.crowded);
  check_overlap<D>(named, match.neighbours);
  neighbours_ = std::move(match.neighbours);
  ring_of_node_ = nodes_around<D>(cells_, cells_of_node_);

  find_boundary();
  measure();
  take_sets(data, inverse(old_cells, data.cells.size()), inverse(old_nodes, data.nodes.size()));
  map_ = std::move(data.map);
  notes_ = std::move(data.notes);
}

template <int D>
Mesh<D>::Mesh(const Mesh& whole, std::span<const Index> cells)
{
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i] < 0 || cells[i] >= whole.n_cells() || (i > 0 && cells[i] <= cells[i - 1]))
      throw std::invalid_argument(fmt::format("cell {} stands where an ascending number below {} is wanted", cells[i], whole.n_cells()));
  const std::vector<Index> nodes = nodes_in_use<D>(whole.cells(), cells, whole.n_nodes());
  const std::vector<Index> new_cell = inverse(cells, whole.cells_.size()), new_node = inverse(nodes, whole.nodes_.size());

  nodes_ = picked(whole.nodes_, nodes);
  node_size_ = picked(whole.node_size_, nodes);
  on_boundary_ = picked(whole.on_boundary_, nodes);
  cells_ = picked(whole.cells_, cells);
  volume_ = picked(whole.volume_, cells);
  altitude_ = picked(whole.altitude_, cells);
  gradients_ = picked(whole.gradients_, cells);
  neighbours_ = picked(whole.neighbours_, cells);
  parallel_for(n_cells(), [&](Index c) {
    for (Index& n : cells_[c])
      n = new_node[n];
    for (Index& other : neighbours_[c])
      other = other == none ? none : new_cell[other];
  });
  largest_edge_ = whole.largest_edge_;
  low_ = whole.low_;
  high_ = whole.high_;
  map_ = whole.map_;
  notes_ = whole.notes_;

  cells_of_node_ = cells_at_nodes<D>(cells_, n_nodes());
  ring_of_node_ = nodes_around<D>(cells_, cells_of_node_);
  cut_.resize(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n)
    cut_[n] = whole.cells_of_node_[nodes[n]].size() != cells_of_node_[static_cast<Index>(n)].size() || !whole.is_whole(nodes[n]) ? 1 : 0;
  for (const Facet f : whole.boundary_facets_)
    if (new_cell[f.cell] != none)
      boundary_facets_.push_back({new_cell[f.cell], f.local});
  take_cuts(whole, new_cell, new_node);
  take_sets(whole, new_cell, new_node);
}

/// Sorts cells into the given order, orients them positively and numbers nodes by first use; returns the old number of each node.
template <int D>
std::vector<Index> Mesh<D>::take_cells(const MeshData<D>& data, std::span<const Index> old_cells)
{
  std::vector<Index> renumbered(data.nodes.size(), none), old_nodes;
  old_nodes.reserve(data.nodes.size());
  cells_.reserve(old_cells.size());
  for (const Index c : old_cells) {
    Cell cell = data.cells[c];
    for (Index& n : cell) {
      if (renumbered[n] == none) {
        renumbered[n] = static_cast<Index>(old_nodes.size());
        old_nodes.push_back(n);
      }
      n = renumbered[n];
    }
    cells_.push_back(cell);
  }
  nodes_.reserve(old_nodes.size());
  for (const Index n : old_nodes)
    nodes_.push_back(data.nodes[n]);
  parallel_for(n_cells(), [&](Index c) {
    if (signed_volume<D>(corners(c)) < 0)
      std::swap(cells_[c][D - 1], cells_[c][D]);
  });
  return old_nodes;
}

template <int D>
void Mesh<D>::find_boundary()
{
  on_boundary_.assign(nodes_.size(), 0);
  for (Index c = 0; c < n_cells(); ++c)
    for (Index a = 0; a <= D; ++a)
      if (neighbours_[c][a] == none) {
        boundary_facets_.push_back({c, a});
        for (const Index n : nodes_of({c, a}))
          on_boundary_[n] = 1;
      }
}

template <int D>
void Mesh<D>::measure()
{
  volume_.resize(cells_.size());
  altitude_.resize(cells_.size());
  gradients_.resize(cells_.size());
  node_size_.resize(nodes_.size());
  parallel_for(n_cells(), [&](Index c) {
    const Simplex<D> s = corners(c);
    const std::array<Real, D + 1> heights = talus::altitudes<D>(s);
    volume_[c] = signed_volume<D>(s);
    gradients_[c] = talus::gradients<D>(s);
    altitude_[c] = *std::ranges::min_element(heights);
  });
  parallel_for(n_nodes(), [&](Index n) {
    const auto ring = ring_of_node_[n];
    Real sum = 0;
    for (const Index m : ring)
      sum += (nodes_[m] - nodes_[n]).norm();
    node_size_[n] = sum / static_cast<Real>(ring.size() - 1);  // the ring contains n itself, and simplices have no diagonals
  });
  largest_edge_ = -parallel_min(n_cells(), 0, [&](Index c) { return -longest_edge<D>(corners(c)); });
  low_ = high_ = nodes_[0];
  for (const Vec<D>& x : nodes_) {
    low_ = low_.cwiseMin(x);
    high_ = high_.cwiseMax(x);
  }
}

template <int D>
void Mesh<D>::take_sets(const MeshData<D>& data, std::span<const Index> new_cell, std::span<const Index> new_node)
{
  for (const auto& [name, members] : data.node_sets)
    node_sets_[name] = renumber(members, new_node, "node set", name, "node");
  for (const auto& [name, members] : data.cell_sets)
    cell_sets_[name] = renumber(members, new_cell, "cell set", name, "cell");
  for (const auto& [name, members] : data.facet_sets) {
    std::vector<Facet>& facets = facet_sets_[name];
    for (std::array<Index, D> nodes : members) {
      const std::array<Index, D> numbers = nodes;
      bool known = true;
      for (Index& n : nodes) {
        check_number(n, new_node.size(), "facet set", name, "node");
        n = new_node[n];
        known = known && n != none;
      }
      const std::optional<Facet> facet = known ? find_facet<D>(*this, nodes) : std::nullopt;
      if (!facet)
        throw std::invalid_argument(fmt::format("facet set \"{}\": nodes {}, the first at {}, are not a facet of any cell", name,
                                                and_list(numbers), place<D>(data.nodes[numbers[0]])));
      facets.push_back(*facet);
    }
    const auto key = [&](Facet f) { return std::tuple(neighbours_[f.cell][f.local] != none, f.cell, f.local); };
    std::ranges::sort(facets, [&](Facet a, Facet b) { return key(a) < key(b); });
    facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
  }
}

template <int D>
void Mesh<D>::take_sets(const Mesh& whole, std::span<const Index> new_cell, std::span<const Index> new_node)
{
  for (const std::string& name : whole.node_set_names())  // with the nodes of facets and cells that this part does not contain
    node_sets_[name] = held(*whole.node_set(name), new_node);
  for (const auto& [name, members] : whole.cell_sets_)
    cell_sets_[name] = held(members, new_cell);
  for (const auto& [name, members] : whole.facet_sets_) {
    std::vector<Facet>& facets = facet_sets_[name];
    std::size_t n_boundary = 0;
    for (Facet f : members) {
      if (new_cell[f.cell] == none && whole.neighbours_[f.cell][f.local] != none)
        f = whole.back(f);
      if (new_cell[f.cell] == none)
        continue;
      facets.push_back({new_cell[f.cell], f.local});
      n_boundary += whole.on_boundary(f) ? 1 : 0;
    }
    std::sort(facets.begin() + static_cast<std::ptrdiff_t>(n_boundary), facets.end(), is_before);
  }
}

template <int D>
std::array<Vec<D>, D + 1> Mesh<D>::corners(Index c) const noexcept
{
  const Cell& nodes = cell(c);
  Simplex<D> s;
  for (int a = 0; a <= D; ++a)
    s[a] = node(nodes[a]);
  return s;
}

template <int D>
bool Mesh<D>::on_boundary(Facet f) const noexcept
{
  return std::ranges::binary_search(boundary_facets_, f, is_before);
}

template <int D>
std::array<Index, D> Mesh<D>::nodes_of(Facet f) const noexcept
{
  std::array<Index, D> nodes;
  for (int i = 0; i < D; ++i)
    nodes[i] = cell(f.cell)[facet_locals<D>[f.local][i]];
  return nodes;
}

template <int D>
Vec<D> Mesh<D>::area_vector(Facet f) const noexcept
{
  return talus::area_vector(facet<D>(corners(f.cell), f.local));
}

template <int D>
std::array<Real, D + 1> Mesh<D>::barycentric(Index c, const Vec<D>& x) const noexcept
{
  return talus::barycentric<D>(gradients(c), node(cell(c)[0]), x);
}

template <int D>
std::optional<std::vector<Index>> Mesh<D>::node_set(std::string_view name) const
{
  const auto nodes = node_sets_.find(name);
  const auto facets = facet_sets_.find(name);
  const auto cells = cell_sets_.find(name);
  if (nodes == node_sets_.end() && facets == facet_sets_.end() && cells == cell_sets_.end())
    return std::nullopt;
  std::vector<std::uint8_t> member(nodes_.size(), 0);
  if (nodes != node_sets_.end())
    for (const Index n : nodes->second)
      member[n] = 1;
  if (facets != facet_sets_.end())
    for (const Facet f : both_sides_of_cuts(facets->second))
      for (const Index n : nodes_of(f))
        member[n] = 1;
  if (cells != cell_sets_.end())
    for (const Index c : cells->second)
      for (const Index n : cell(c))
        member[n] = 1;
  std::vector<Index> result;
  for (Index n = 0; n < n_nodes(); ++n)
    if (member[n] != 0)
      result.push_back(n);
  return result;
}

template <int D>
std::optional<std::vector<Facet>> Mesh<D>::facet_set(std::string_view name) const
{
  const auto found = facet_sets_.find(name);
  return found == facet_sets_.end() ? std::nullopt : std::optional(found->second);
}

template <int D>
std::optional<std::vector<Index>> Mesh<D>::cell_set(std::string_view name) const
{
  const auto found = cell_sets_.find(name);
  return found == cell_sets_.end() ? std::nullopt : std::optional(found->second);
}

template <int D>
std::vector<std::string> Mesh<D>::node_set_names() const
{
  std::vector<std::string> names = names_of(node_sets_);
  for (auto& more : {facet_set_names(), cell_set_names()})
    names.insert(names.end(), more.begin(), more.end());
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

template <int D>
std::vector<std::string> Mesh<D>::facet_set_names() const
{
  return names_of(facet_sets_);
}

template <int D>
std::vector<std::string> Mesh<D>::cell_set_names() const
{
  return names_of(cell_sets_);
}

template class Mesh<2>;
template class Mesh<3>;

}  // namespace talus
