// Nodes are doubled along facets inside a mesh.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "mesh/check.hpp"
#include "mesh/connectivity.hpp"
#include "mesh/mesh.hpp"

namespace talus {

namespace {

bool is_before(Facet a, Facet b) noexcept { return std::tie(a.cell, a.local) < std::tie(b.cell, b.local); }

/// Sets of numbers that are joined one after the other; the lowest number stands for its set.
class JoinedSets {
 public:
  explicit JoinedSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t of(std::size_t i)
  {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b)
  {
    a = of(a), b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

/// The nodes of cuts and the cells on their sides.
template <int D>
class Doubling {
 public:
  Doubling(const Mesh<D>& mesh, std::span<const std::string> names) : mesh_(mesh), names_(names)
  {
    cut_at_.resize(static_cast<std::size_t>(mesh.n_cells()));
    for (auto& row : cut_at_)
      row.fill(none);
    for (std::size_t k = 0; k < names.size(); ++k)
      mark_facets(k);
    place_.assign(static_cast<std::size_t>(mesh.n_nodes()), none);
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      if (std::ranges::any_of(mesh.cells_of_node()[n], [&](Index c) { return is_cut_at(c, n); }))
        find_sides(n);
    for (std::size_t k = 0; k < names.size(); ++k)
      if (std::ranges::none_of(doubled_, [&](const DoubledNode& at) { return at.cut == static_cast<Index>(k); }))
        throw CutError(k, fmt::format("the cut \"{}\" doubles no node, as nodes at its border inside the mesh stay single: it needs {}",
                                      names[k], D == 2 ? "two facets in a row" : "a node with its facets all around"));
    find_first_sides();
  }
  /// Whether node n is doubled.
  bool doubles(Index n) const noexcept { return place_[static_cast<std::size_t>(n)] != none; }
  /// Whether a cell lies on the second side of a doubled node.
  bool is_second(Index cell, Index n) const noexcept { return at(n).second_has(cell) != at(n).turned; }
  const std::vector<Index>& tips() const noexcept { return tips_; }
  /// Calls f(node, cut, area vector from the first side to the second, its measure) for each doubled node, ascending.
  template <class F>
  void for_each_doubled(F&& f) const
  {
    for (const DoubledNode& one : doubled_)
      f(one.node, one.cut, one.turned ? Vec<D>(-one.area) : one.area, one.measure);
  }
  /// The facets of all cuts, from both sides.
  std::vector<Facet> facets() const
  {
    std::vector<Facet> all;
    for (Index c = 0; c < mesh_.n_cells(); ++c)
      for (Index a = 0; a <= D; ++a)
        if (cut_of({c, a}) != none)
          all.push_back({c, a});
    return all;
  }

 private:
  struct DoubledNode {
    Index node, cut = none;
    std::vector<Index> second = {};  ///< cells of the side that has not the lowest cell, ascending
    Vec<D> area = Vec<D>::Zero();    ///< from the side of the lowest cell
    Real measure = 0;
    bool turned = false;  ///< whether the side of the lowest cell is the second one
    bool second_has(Index cell) const noexcept { return std::ranges::binary_search(second, cell); }
  };

  Index& cut_of(Facet f) noexcept { return cut_at_[static_cast<std::size_t>(f.cell)][static_cast<std::size_t>(f.local)]; }
  Index cut_of(Facet f) const noexcept { return cut_at_[static_cast<std::size_t>(f.cell)][static_cast<std::size_t>(f.local)]; }
  const DoubledNode& at(Index n) const noexcept { return doubled_[static_cast<std::size_t>(place_[static_cast<std::size_t>(n)])]; }
  bool is_cut_at(Index c, Index n) const noexcept
  {
    for (Index a = 0; a <= D; ++a)
      if (mesh_.cell(c)[static_cast<std::size_t>(a)] != n && cut_of({c, a}) != none)
        return true;
    return false;
  }

  void mark_facets(std::size_t k)
  {
    const std::vector<Facet> facets = mesh_.facet_set(names_[k]).value();
    const auto outside =
        std::ranges::count_if(facets, [&](Facet f) { return mesh_.neighbours(f.cell)[static_cast<std::size_t>(f.local)] == none; });
    if (outside > 0)
      throw CutError(k, fmt::format("{} of the {} facets of \"{}\" lie on the boundary of the mesh: a cut goes through the inside, with "
                                    "cells on both of its sides",
                                    outside, facets.size(), names_[k]));
    for (const Facet f : facets) {
      if (const Index other = cut_of(f); other != none)
        throw CutError(k, fmt::format("the cuts \"{}\" and \"{}\" have facets in common: leave these out of one of them",
                                      names_[static_cast<std::size_t>(other)], names_[k]));
      cut_of(f) = cut_of(mesh_.back(f)) = static_cast<Index>(k);
    }
  }

  /// Parts the cells around a node by the facets of cuts.
  void find_sides(Index n)
  {
    const auto star = mesh_.cells_of_node()[n];
    JoinedSets sets(star.size());
    Index cut = none;
    for (std::size_t i = 0; i < star.size(); ++i)
      for (Index a = 0; a <= D; ++a) {
        if (mesh_.cell(star[i])[static_cast<std::size_t>(a)] == n)
          continue;
        const Index across = mesh_.neighbours(star[i])[static_cast<std::size_t>(a)];
        if (const Index of_facet = cut_of({star[i], a}); of_facet != none)
          cut = cut == none ? of_facet : std::min(cut, of_facet);
        else if (across != none)
          sets.join(i, static_cast<std::size_t>(std::ranges::lower_bound(star, across) - star.begin()));
      }
    std::vector<std::size_t> sides;
    for (std::size_t i = 0; i < star.size(); ++i)
      if (sets.of(i) == i)
        sides.push_back(i);
    if (sides.size() == 1)
      return tips_.push_back(n);
    if (sides.size() > 2)
      throw CutError(static_cast<std::size_t>(cut),
                     fmt::format("at {} cuts meet or cross and leave {} sides, and a node has one twin: let one of the cuts end a cell "
                                 "before the other",
                                 place<D>(mesh_.node(n)), sides.size()));
    place_[static_cast<std::size_t>(n)] = static_cast<Index>(doubled_.size());
    DoubledNode& here = doubled_.emplace_back(DoubledNode{.node = n, .cut = cut});
    for (std::size_t i = 0; i < star.size(); ++i)
      if (sets.of(i) == sides[1])
        here.second.push_back(star[i]);
    for (const Index c : star)
      for (Index a = 0; a <= D; ++a)
        if (mesh_.cell(c)[static_cast<std::size_t>(a)] != n && cut_of({c, a}) != none && !here.second_has(c)) {
          if (!here.second_has(mesh_.back({c, a}).cell))
            continue;  // both sides of the facet belong to one of the node: it ends here
          const Vec<D> area = mesh_.area_vector({c, a}) / D;
          here.area += area, here.measure += area.norm();
        }
  }

  /// Says for each piece of the cuts which side is the first one.
  void find_first_sides()
  {
    JoinedSets sides(2 * doubled_.size());
    const auto side_of = [&](Index cell, Index n) {
      return 2 * static_cast<std::size_t>(place_[static_cast<std::size_t>(n)]) + (at(n).second_has(cell) ? 1 : 0);
    };
    const std::vector<Facet> all = facets();
    const auto for_each_doubled_of = [&](Facet f, auto&& visit) {
      for (const Index n : mesh_.nodes_of(f))
        if (doubles(n) && at(n).second_has(f.cell) != at(n).second_has(mesh_.back(f).cell))
          visit(n);
    };
    for (const Facet f : all) {
      std::optional<std::size_t> before;
      for_each_doubled_of(f, [&](Index n) {
        const std::size_t side = side_of(f.cell, n);
        if (before)
          sides.join(*before, side);
        before = side;
      });
    }
    for (std::size_t i = 0; i < doubled_.size(); ++i)
      if (sides.of(2 * i) == sides.of(2 * i + 1))
        throw CutError(static_cast<std::size_t>(doubled_[i].cut),
                       fmt::format("the cut \"{}\" has one side only: it is turned in itself like a Moebius strip",
                                   names_[static_cast<std::size_t>(doubled_[i].cut)]));
    // A piece is named by the lower of the two numbers of its sides: that side is the first unless its area vector says otherwise.
    struct Piece {
      Vec<D> area = Vec<D>::Zero();
      Real measure = 0, volume = 0;
    };
    std::vector<Piece> pieces(2 * doubled_.size());
    const auto piece_of = [&](std::size_t i) { return std::min(sides.of(2 * i), sides.of(2 * i + 1)); };
    const auto sign_of = [&](std::size_t i) { return sides.of(2 * i) == piece_of(i) ? 1 : -1; };
    for (std::size_t i = 0; i < doubled_.size(); ++i) {
      Piece& piece = pieces[piece_of(i)];
      piece.area += sign_of(i) * doubled_[i].area;
      piece.measure += doubled_[i].measure;
      piece.volume += sign_of(i) * doubled_[i].area.dot(mesh_.node(doubled_[i].node) - mesh_.low());
    }
    for (std::size_t i = 0; i < doubled_.size(); ++i) {
      const Piece& piece = pieces[piece_of(i)];
      constexpr Real closed = 1e-6, equal = 1 - 1e-6;  // round-off must not choose the axis
      Index axis = 0;
      while (std::abs(piece.area[axis]) < equal * piece.area.cwiseAbs().maxCoeff())
        ++axis;
      const bool is_first = piece.area.norm() > closed * piece.measure ? piece.area[axis] > 0 : piece.volume > 0;
      doubled_[i].turned = (sign_of(i) > 0) != is_first;
    }
  }

  const Mesh<D>& mesh_;
  std::span<const std::string> names_;
  std::vector<std::array<Index, D + 1>> cut_at_;  ///< by cell and local facet
  std::vector<Index> place_;                      ///< by node: in `doubled_`, or none
  std::vector<DoubledNode> doubled_;
  std::vector<Index> tips_;
};

}  // namespace

template <int D>
Mesh<D>::Mesh(Mesh uncut, std::span<const std::string> cuts) : Mesh(std::move(uncut))
{
  if (cuts.empty())
    return;
  const Doubling<D> by(*this, cuts);
  cuts_.facets = by.facets();
  // Nodes are numbered by the first cell that uses them, as those of any mesh.
  constexpr std::size_t second = 1;
  std::vector<std::array<Index, 2>> renumbered(nodes_.size(), {none, none});
  std::vector<Vec<D>> places;
  std::vector<Cell> cells = cells_;
  for (Index c = 0; c < n_cells(); ++c)
    for (Index& n : cells[static_cast<std::size_t>(c)]) {
      Index& to = renumbered[static_cast<std::size_t>(n)][by.doubles(n) && by.is_second(c, n) ? second : 0];
      if (to == none) {
        to = static_cast<Index>(places.size());
        places.push_back(node(n));
      }
      n = to;
    }
  by.for_each_doubled([&](Index n, Index cut, const Vec<D>& area, Real measure) {
    const auto& twins = renumbered[static_cast<std::size_t>(n)];
    cuts_.pairs.push_back({twins[0], twins[1], cut, area, measure});
  });
  std::ranges::sort(cuts_.pairs, {}, &NodePair<D>::first);
  for (const Index n : by.tips())
    cuts_.tips.push_back(renumbered[static_cast<std::size_t>(n)][0]);
  std::ranges::sort(cuts_.tips);
  for (auto& [name, members] : node_sets_) {
    std::vector<Index> doubled;
    for (const Index n : members)
      for (const Index to : renumbered[static_cast<std::size_t>(n)])
        if (to != none)
          doubled.push_back(to);
    std::ranges::sort(doubled);
    members = std::move(doubled);
  }
  nodes_ = std::move(places);
  cells_ = std::move(cells);
  cells_of_node_ = cells_at_nodes<D>(cells_, n_nodes());
  ring_of_node_ = nodes_around<D>(cells_, cells_of_node_);
  boundary_facets_.clear();
  find_boundary();
  measure();
}

template <int D>
void Mesh<D>::take_cuts(const Mesh& whole, std::span<const Index> new_cell, std::span<const Index> new_node)
{
  const auto local = [&](Index n) { return new_node[static_cast<std::size_t>(n)]; };
  for (NodePair<D> pair : whole.cuts_.pairs) {
    pair.first = local(pair.first), pair.second = local(pair.second);
    if (pair.first != none && pair.second != none)
      cuts_.pairs.push_back(pair);
  }
  for (const Facet f : whole.cuts_.facets)
    if (const Index cell = new_cell[static_cast<std::size_t>(f.cell)]; cell != none)
      cuts_.facets.push_back({cell, f.local});
  for (const Index n : whole.cuts_.tips)
    if (local(n) != none)
      cuts_.tips.push_back(local(n));
}

template <int D>
Facet Mesh<D>::back(Facet f) const noexcept
{
  const Index across = neighbours(f.cell)[static_cast<std::size_t>(f.local)];
  const auto& there = neighbours(across);
  return {across, static_cast<Index>(std::ranges::find(there, f.cell) - there.begin())};
}

template <int D>
std::vector<Facet> Mesh<D>::both_sides_of_cuts(std::span<const Facet> facets) const
{
  std::vector<Facet> all;
  for (const Facet f : facets) {
    all.push_back(f);
    if (std::ranges::binary_search(cuts_.facets, f, is_before) && neighbours(f.cell)[static_cast<std::size_t>(f.local)] != none)
      all.push_back(back(f));
  }
  return all;
}

#define TALUS_INSTANTIATE(D)                                                                     \
  template Mesh<D>::Mesh(Mesh, std::span<const std::string>);                                    \
  template void Mesh<D>::take_cuts(const Mesh&, std::span<const Index>, std::span<const Index>); \
  template Facet Mesh<D>::back(Facet) const noexcept;                                            \
  template std::vector<Facet> Mesh<D>::both_sides_of_cuts(std::span<const Facet>) const;
TALUS_INSTANTIATE(2)
TALUS_INSTANTIATE(3)
#undef TALUS_INSTANTIATE

}  // namespace talus
