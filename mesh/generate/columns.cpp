#include "mesh/generate/columns.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "mesh/connectivity.hpp"
#include "mesh/simplex.hpp"

namespace talus {

namespace {

/// The number of intervals of a slab in the column over a plan node.
template <int D>
Index intervals(const Stack<D>& stack, std::size_t s, Index column)
{
  const Real from = s == 0 ? stack.bottom[column] : stack.slabs[s - 1].top[column], to = stack.slabs[s].top[column];
  if (!(to > from))
    return 0;
  constexpr Real most = 1e6;  // most intervals of a slab in a column: more is a typing error
  return static_cast<Index>(std::clamp(std::round((to - from) / stack.slabs[s].height[column]), Real{1}, most));
}

/// The nodes of one column, from below.
struct ColumnHeights {
  Index column;
  Index slab;  ///< the slab of the interval below the node; `none` at the bottom
  Real share;  ///< fraction of the slab's thickness, in (0, 1]; a quotient of integers, so that equal fractions are bitwise equal
};
bool comes_first(const ColumnHeights& a, const ColumnHeights& b) noexcept
{
  return std::tie(a.slab, a.share, a.column) < std::tie(b.slab, b.share, b.column);
}

template <int D>
struct Nodes {
  std::vector<Vec<D>> place;
  std::vector<ColumnHeights> stand;
  std::vector<Index> begin;  ///< first node of each column, and the end of the last
};

template <int D>
Nodes<D> make_nodes(const Stack<D>& stack)
{
  Nodes<D> nodes;
  nodes.begin.push_back(0);
  for (Index column = 0; column < static_cast<Index>(stack.plan.nodes.size()); ++column) {
    const auto add = [&](Real height, Index slab, Real share) {
      Vec<D> x;
      x.template head<D - 1>() = stack.plan.nodes[column];
      x[D - 1] = height;
      nodes.place.push_back(x);
      nodes.stand.push_back({column, slab, share});
    };
    Real from = stack.bottom[column];
    add(from, none, 1);
    for (std::size_t s = 0; s < stack.slabs.size(); ++s) {
      const Real to = stack.slabs[s].top[column];
      const Index n = intervals(stack, s, column);
      for (Index k = 1; k <= n; ++k)
        add((from * (n - k) + to * k) / n, static_cast<Index>(s), static_cast<Real>(k) / n);
      from = n > 0 ? to : from;
    }
    nodes.begin.push_back(static_cast<Index>(nodes.place.size()));
  }
  return nodes;
}

/// All cells of the stack with their slabs.
template <int D>
struct Filling {
  std::vector<std::array<Index, D + 1>> cells;
  std::vector<Index> plan_cell, slab;
};

/// Makes the cells between the columns over one plan cell.
template <int D>
class PrismCutter {
 public:
  PrismCutter(const Stack<D>& stack, const Nodes<D>& nodes, Filling<D>& filling, std::vector<typename Columns<D>::Front>& fronts)
      : stack_(stack), nodes_(nodes), filling_(filling), fronts_(fronts)
  {}

  void close(Index plan_cell)
  {
    const auto& columns = stack_.plan.cells[plan_cell];
    for (int i = 0; i < D; ++i)
      now_[i] = nodes_.begin[columns[i]];
    Index slab = none, group = none;
    const auto pass = [&](Index slab_above, Index group_above) {
      if (group != group_above)
        fronts_.push_back({now_, plan_cell, slab, slab_above, group, group_above});
      slab = slab_above, group = group_above;
    };
    for (int i = next(columns); i < D; i = next(columns)) {
      const Index node = now_[i] + 1, slab_here = nodes_.stand[node].slab;
      if (slab_here != slab)
        pass(slab_here, stack_.slabs[slab_here].group[plan_cell]);
      auto& cell = filling_.cells.emplace_back();
      std::copy(now_.begin(), now_.end(), cell.begin());
      cell[D] = node;
      filling_.plan_cell.push_back(plan_cell);
      filling_.slab.push_back(slab);
      now_[i] = node;
    }
    pass(none, none);
  }

 private:
  /// The column with the lowest next node; D if all columns are complete.
  int next(const std::array<Index, D>& columns) const
  {
    int first = D;
    for (int i = 0; i < D; ++i)
      if (now_[i] + 1 < nodes_.begin[columns[i] + 1] &&
          (first == D || comes_first(nodes_.stand[now_[i] + 1], nodes_.stand[now_[first] + 1])))
        first = i;
    return first;
  }

  const Stack<D>& stack_;
  const Nodes<D>& nodes_;
  Filling<D>& filling_;
  std::vector<typename Columns<D>::Front>& fronts_;
  std::array<Index, D> now_{};
};

/// The nodes of the facet opposite a local node.
template <int D>
std::array<Index, D> facet_of(const std::array<Index, D + 1>& cell, int local)
{
  std::array<Index, D> nodes;
  for (int i = 0; i < D; ++i)
    nodes[i] = cell[facet_locals<D>[local][i]];
  return nodes;
}

/// Collects facets with an upright edge: two of their nodes lie in one column.
template <int D>
bool is_upright(const std::array<Index, D>& facet, const std::vector<ColumnHeights>& stand)
{
  for (int i = 0; i < D; ++i)
    for (int j = i + 1; j < D; ++j)
      if (stand[facet[i]].column == stand[facet[j]].column)
        return true;
  return false;
}

}  // namespace

template <int D>
Real cells_of(const Stack<D>& stack)
{
  std::vector<Real> of_column(stack.plan.nodes.size(), 0);
  for (Index column = 0; column < static_cast<Index>(of_column.size()); ++column)
    for (std::size_t s = 0; s < stack.slabs.size(); ++s)
      of_column[column] += intervals(stack, s, column);
  Real cells = 0;
  for (const auto& columns : stack.plan.cells)
    for (const Index column : columns)
      cells += of_column[column];
  return cells;
}

template <int D>
Columns<D> fill_columns(const Stack<D>& stack)
{
  Nodes<D> nodes = make_nodes(stack);
  Columns<D> result;
  Filling<D> filling;
  PrismCutter<D> zipper(stack, nodes, filling, result.fronts);
  for (Index c = 0; c < static_cast<Index>(stack.plan.cells.size()); ++c)
    zipper.close(c);

  const auto group_of = [&](Index c) { return stack.slabs[filling.slab[c]].group[filling.plan_cell[c]]; };
  const FacetMatch<D> match = match_facets<D>(filling.cells, cells_at_nodes<D>(filling.cells, static_cast<Index>(nodes.place.size())));
  for (Index c = 0; c < static_cast<Index>(filling.cells.size()); ++c) {
    if (group_of(c) == none)
      continue;
    result.cells.push_back(filling.cells[c]);
    result.group.push_back(group_of(c));
    for (int a = 0; a <= D; ++a) {
      const Index other = match.neighbours[c][a];
      if (other != none && group_of(other) != none)
        continue;
      const auto facet = facet_of<D>(filling.cells[c], a);
      if (is_upright<D>(facet, nodes.stand))
        result.sides.push_back({facet, other == none ? none : filling.plan_cell[other], other == none ? none : filling.slab[other]});
    }
  }
  result.nodes = std::move(nodes.place);
  return result;
}

template Real cells_of<2>(const Stack<2>&);
template Real cells_of<3>(const Stack<3>&);
template Columns<2> fill_columns<2>(const Stack<2>&);
template Columns<3> fill_columns<3>(const Stack<3>&);

}  // namespace talus
