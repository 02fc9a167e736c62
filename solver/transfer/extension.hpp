#pragma once
// Surfaces that cut cells: velocities of poorly filled nodes for gradients, and the forces that belong to them.
#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "kernels/node_operators.hpp"
#include "kernels/tangential_extension.hpp"
#include "solver/halo/halo_exchange.hpp"
#include "solver/state/nodes.hpp"
#include "solver/state/owned_nodes.hpp"

namespace talus {

/// The tangential extension E (kernels/tangential_extension.hpp) at the poorly filled nodes of a model.  Gradients are taken of E v instead
/// of v, and forces of the stress go through the transpose of E, so that their power is that of the stress:
///
///     L_n = sum_v (E v)_v (x) D_nv          f = -E^T sum_n Z_n D_nv
///
/// Nodes with a boundary condition are not extended.  The sources of a node lie within three rings.  Its row is a function of how far these
/// are filled with particles in this step, in levels, and is found again only if a level has changed.
///
/// The owner of a node finds its row and velocity; the owners of its sources receive the row and the force.
template <int D>
class Extension {
 public:
  static constexpr int rings = 3;  ///< between a node and its sources
  /// Makes room.  Until then no node is extended.
  void begin(const Mesh<D>& mesh)
  {
    const auto n = static_cast<std::size_t>(mesh.n_nodes());
    if (fill_.size() != n) {
      hats_ = hat_volumes(mesh);
      stencil_of_.assign(n, none), seen_from_.assign(n, none);
    }
    fill_.assign(n, 0), changed_.assign(n, 0), extends_.assign(n, 0);
    nodes_.assign(n, {}), velocity_.assign(n, Vec<D>::Zero());
    candidates_.clear(), extended_.clear(), listed_.clear();
  }
  bool any() const noexcept { return !fill_.empty(); }

  /// Finds the rows of the nodes in use; volume(n) is what particles fill of the linear shape function of a node [m^D].
  template <class Volume>
  void find_rows(const Mesh<D>& mesh, const NodeOperators<D>& operators, const OwnNodes& own, const Nodes<D>& nodes, HaloExchange& near,
                 Volume&& volume)
  {
    find_fills(nodes.in_use, near, volume);
    last_.swap(candidates_);
    candidates_.clear(), extended_.clear();
    const auto may_extend = [&](Index n) {
      return own.has(n) && nodes.bound[static_cast<std::size_t>(n)] == 0 && fill_[static_cast<std::size_t>(n)] < well_filled &&
             std::ranges::any_of(mesh.ring_of_node()[n], [&](Index m) { return fill_[static_cast<std::size_t>(m)] > 0; });
    };
    nodes.in_use.for_each_ascending([&](Index n) {
      extends_[static_cast<std::size_t>(n)] = 0;
      if (may_extend(n)) {
        candidates_.push_back(n);
        find_stencil(mesh, n);
      }
    });
    parallel_for(static_cast<Index>(candidates_.size()), [&](Index k) {
      const Index n = candidates_[static_cast<std::size_t>(k)];
      ExtendedNode& node = nodes_[static_cast<std::size_t>(n)];
      const bool is_known = std::ranges::binary_search(last_, n) &&
                            std::ranges::none_of(stencil(n), [&](Index m) { return changed_[static_cast<std::size_t>(m)] != 0; });
      if (!is_known)
        find_row(mesh, operators, n, node.row);
      extends_[static_cast<std::size_t>(n)] = node.row.extends() ? 1 : 0;
    });
    std::ranges::copy_if(candidates_, std::back_inserter(extended_), [&](Index n) { return extends_[static_cast<std::size_t>(n)] != 0; });
  }

  /// Moves forces of the stress from extended nodes to their sources; stress_force(v) is -sum_n Z_n D_nv [N].  So it does with `loads` on
  /// surfaces [N] by node, which may be empty.
  template <class Force>
  void move_forces(const Mesh<D>& mesh, const OwnNodes& own, const NodesInUse& in_use, HaloExchange& near, SparseRows<NodeSum<D>>& sum,
                   Force&& stress_force, SparseRows<Vec<D>>& loads)
  {
    parallel_for(static_cast<Index>(extended_.size()), [&](Index k) {
      const auto n = static_cast<std::size_t>(extended_[static_cast<std::size_t>(k)]);
      ExtendedNode& node = nodes_[n];
      node.force = node.row.tangential(stress_force(extended_[static_cast<std::size_t>(k)]));
      node.load = loads.empty() ? Vec<D>(Vec<D>::Zero()) : node.row.tangential(loads[n]);
    });
    if (!near.borders().empty())
      exchange_rows_of_ghosts(mesh, near);
    if (extended_.empty())
      return;
    if (extended_ != listed_)
      list_targets(own);
    in_use.for_each([&](Index target) {
      NodeSum<D>& to = sum[static_cast<std::size_t>(target)];
      for (const Index entry : targets_[target]) {
        const ExtendedNode& node = nodes_[static_cast<std::size_t>(owner_of_entry_[static_cast<std::size_t>(entry)])];
        to.force += share_[static_cast<std::size_t>(entry)] * node.force;
        if (!loads.empty()) {
          const Vec<D> moved = share_[static_cast<std::size_t>(entry)] * node.load;
          to.force += moved;
          loads[static_cast<std::size_t>(target)] += moved;
        }
      }
    });
  }

  /// Finds the velocities of extended nodes for gradients of this motion.
  void find_velocities(const OwnNodes& own, HaloExchange& near, SparseRows<NodeMotion<D>>& motion)
  {
    if (!any())
      return;
    near.send(motion, VelocityAlone{});
    near.take(motion, VelocityAlone{});
    parallel_for(static_cast<Index>(extended_.size()), [&](Index k) {
      const Index n = extended_[static_cast<std::size_t>(k)];
      if (!own.has(n))
        return;
      Vec<D> u = Vec<D>::Zero();
      auto entry = static_cast<std::size_t>(first_entry(n));
      for (const Index m : stencil(n)) {
        if (share_[entry] != 0)
          u += share_[entry] * motion[static_cast<std::size_t>(m)].v;
        ++entry;
      }
      const auto i = static_cast<std::size_t>(n);
      velocity_[i] = motion[i].v + nodes_[i].row.tangential(u);
    });
    near.send(velocity_, OfMarked{itself, extends_});
    near.take(velocity_, OfMarked{itself, extends_});
  }
  /// The velocity of node n for gradients, where v is its own [m/s].
  const Vec<D>& velocity(Index n, const Vec<D>& v) const noexcept
  {
    return any() && extends_[static_cast<std::size_t>(n)] != 0 ? velocity_[static_cast<std::size_t>(n)] : v;
  }
  /// The extended nodes, those of other ranks with sources here among them, ascending.
  std::span<const Index> extended() const noexcept { return extended_; }
  std::size_t bytes() const noexcept
  {
    const auto of = [](const auto&... column) { return (std::size_t{0} + ... + (column.size() * sizeof(column[0]))); };
    return of(hats_, fill_, changed_, extends_, nodes_, velocity_, stencil_of_, seen_from_, stencils_.item, share_, owner_of_entry_,
              targets_.item);
  }

 private:
  /// The row of a node, and the forces of the stress and of loads on the surface along it there [N].
  struct ExtendedNode {
    ExtensionRow<D> row;
    Vec<D> force = Vec<D>::Zero(), load = Vec<D>::Zero();
  };
  /// What the owners of sources need of an extended node.
  static auto row_and_force(auto& node) noexcept
  {
    return std::tie(node.row.normal, node.row.own, node.row.value, node.row.slope, node.row.size, node.force, node.load);
  }

  template <class Volume>
  void find_fills(const NodesInUse& in_use, HaloExchange& near, Volume&& volume)
  {
    before_ = fill_;
    in_use.for_each([&](Index n) {
      const auto i = static_cast<std::size_t>(n);
      fill_[i] = extension_fill(volume(n) / hats_[i]);
    });
    near.send(fill_, Numbers{});
    near.take(fill_, Numbers{});
    const auto compare = [&](Index n) {
      const auto i = static_cast<std::size_t>(n);
      changed_[i] = fill_[i] == before_[i] ? 0 : 1;
    };
    in_use.for_each(compare);
    for (const NeighbourRank& border : near.borders())
      std::ranges::for_each(border.in, compare);
  }
  ExtensionSource<D> source(const Mesh<D>& mesh, Index n, Index m) const noexcept
  {
    return {mesh.node(m) - mesh.node(n), fill_[static_cast<std::size_t>(m)]};
  }
  void find_row(const Mesh<D>& mesh, const NodeOperators<D>& operators, Index n, ExtensionRow<D>& row)
  {
    thread_local std::vector<ExtensionSource<D>> sources;
    sources.clear();
    for (const Index m : stencil(n))
      if (fill_[static_cast<std::size_t>(m)] > 0)
        sources.push_back(source(mesh, n, m));
    Vec<D> outwards = Vec<D>::Zero();
    operators.for_each_in_row(n, [&](Index k, Real S, const Vec<D>&) {
      if (S != 0)
        operators.for_each_in_row(
            k, [&](Index m, Real, const Vec<D>& gradient) { outwards -= S * fill_[static_cast<std::size_t>(m)] * gradient; });
    });
    row = extension_row(fill_[static_cast<std::size_t>(n)], mesh.node_size(n), std::span<const ExtensionSource<D>>(sources),
                        stencil(n).size(), outwards);
    find_shares(mesh, n, row);
  }
  /// Sets the shares of the sources of n, from which the value of n itself is subtracted.
  void find_shares(const Mesh<D>& mesh, Index n, const ExtensionRow<D>& row)
  {
    auto entry = static_cast<std::size_t>(first_entry(n));
    for (const Index m : stencil(n)) {
      const Real fill = fill_[static_cast<std::size_t>(m)];
      share_[entry++] = (fill > 0 ? row.coefficient(source(mesh, n, m)) : 0) + (m == n ? row.own - 1 : 0);
    }
  }
  void exchange_rows_of_ghosts(const Mesh<D>& mesh, HaloExchange& near)
  {
    for (const NeighbourRank& border : near.borders())
      for (const Index n : border.in)
        nodes_[static_cast<std::size_t>(n)] = {};
    const OfMarked rows{[](auto& node) { return row_and_force(node); }, extends_};
    near.send(nodes_, rows);
    near.take(nodes_, rows);
    for (const NeighbourRank& border : near.borders())
      for (const Index n : border.in) {
        const auto i = static_cast<std::size_t>(n);
        extends_[i] = nodes_[i].row.extends() ? 1 : 0;
        if (extends_[i] == 0)
          continue;
        extended_.push_back(n);
        find_stencil(mesh, n);
        find_shares(mesh, n, nodes_[i].row);
      }
    std::ranges::sort(extended_);
  }

  Index first_entry(Index n) const noexcept { return stencils_.begin[static_cast<std::size_t>(stencil_of_[static_cast<std::size_t>(n)])]; }
  std::span<const Index> stencil(Index n) const noexcept { return stencils_[stencil_of_[static_cast<std::size_t>(n)]]; }
  /// Lists the nodes within three rings of n, ascending; for a node of another rank at least the own ones among them.
  void find_stencil(const Mesh<D>& mesh, Index n)
  {
    if (stencil_of_[static_cast<std::size_t>(n)] != none)
      return;
    stencil_of_[static_cast<std::size_t>(n)] = stencils_.size();
    std::vector<Index>& items = stencils_.item;
    const auto first = static_cast<std::ptrdiff_t>(items.size());
    items.push_back(n);
    seen_from_[static_cast<std::size_t>(n)] = n;
    std::size_t front = items.size() - 1;
    for (int ring = 0; ring < rings; ++ring)
      for (const std::size_t last = items.size(); front < last; ++front)
        for (const Index m : mesh.ring_of_node()[items[front]])
          if (std::exchange(seen_from_[static_cast<std::size_t>(m)], n) != n)
            items.push_back(m);
    std::sort(items.begin() + first, items.end());
    stencils_.begin.push_back(static_cast<Index>(items.size()));
    share_.resize(items.size());
    owner_of_entry_.resize(items.size(), n);
  }
  /// Lists, for every own node, the entries of extended nodes whose source it is, with these ascending.
  void list_targets(const OwnNodes& own)
  {
    listed_ = extended_;
    const auto for_each_target = [&](auto&& f) {
      for (const Index n : extended_) {
        Index entry = first_entry(n);
        for (const Index m : stencil(n)) {
          if (own.has(m))
            f(static_cast<std::size_t>(m), entry);
          ++entry;
        }
      }
    };
    std::vector<Index>& begin = targets_.begin;
    begin.assign(fill_.size() + 1, 0);
    for_each_target([&](std::size_t m, Index) { ++begin[m + 1]; });
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    next_.assign(begin.begin(), begin.end() - 1);
    targets_.item.resize(static_cast<std::size_t>(begin.back()));
    for_each_target([&](std::size_t m, Index entry) { targets_.item[static_cast<std::size_t>(next_[m]++)] = entry; });
  }

  std::vector<Real> hats_, fill_, before_;       ///< by node: volume of the linear shape function [m^D], level of filling now and before
  std::vector<std::uint8_t> changed_, extends_;  ///< by node
  std::vector<ExtendedNode> nodes_;              ///< by node
  std::vector<Vec<D>> velocity_;                 ///< by node, if extended [m/s]
  std::vector<Index> candidates_, last_,
      extended_;                               ///< poorly filled own nodes, those of the step before, and the extended nodes; ascending
  Csr stencils_;                               ///< of all nodes that have been candidates
  std::vector<Index> stencil_of_, seen_from_;  ///< by node
  std::vector<Real> share_;                    ///< by entry of the stencils
  std::vector<Index> owner_of_entry_;          ///< by entry of the stencils: the node that it belongs to
  std::vector<Index> listed_, next_;           ///< the extended nodes for which targets were listed
  Csr targets_;                                ///< by node: entries of which it is the source
};

}  // namespace talus
