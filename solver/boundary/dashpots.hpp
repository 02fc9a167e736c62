#pragma once
// Nodes at absorbing boundaries: the dashpots of all conditions at a node, solved together.
#include <span>
#include <vector>

#include "core/parallel/communicator.hpp"
#include "mesh/mesh.hpp"
#include "mesh/part.hpp"
#include "solver/boundary/boundary_condition.hpp"
#include "solver/state/nodes.hpp"

namespace talus {

/// The impulse of the dashpots on a node in the present step.
template <int D>
struct DashpotImpulse {
  Index node;
  Index condition;  ///< condition to which the impulse is added: the first of the node
  Vec<D> place;
  Vec<D> impulse;  ///< [N s]
  Real waves;      ///< energy of the incident waves [J]
};

template <int D>
class Dashpots {
 public:
  void add(const Mesh<D>& mesh, Index condition, DashpotsOfNodes<D> dashpots);
  void restrict_to(const Subdomain& subdomain);
  /// Returns to the state before the dynamic phase.
  void reset() { reactions_known_ = false, reaction_.clear(); }
  /// Applies the dashpots to the nodes.  In the first step the reaction that keeps each node in equilibrium is computed; it acts from then
  /// on.  Collective.
  void apply(std::span<const BoundaryCondition<D>> conditions, const DynamicPhase& phase, Real mid, Communicator& ranks, Nodes<D>& nodes);
  bool empty() const noexcept { return n_nodes_ == 0; }

  /// Calls f(DashpotImpulse) for the active nodes that are counted on this rank.
  template <class F>
  void for_each_impulse(const Nodes<D>& nodes, F&& f) const
  {
    for (const DashpotNode& at : nodes_)
      if (at.counted && nodes.active[static_cast<std::size_t>(at.node)])
        f(DashpotImpulse<D>{at.node, at.dashpots.front().condition, at.place, at.impulse, at.waves});
  }

  /// Calls f(node, condition, share) for the active nodes on this rank: the node keeps that share of an impulse in the present step.
  template <class F>
  void for_each_share(const Nodes<D>& nodes, F&& f) const
  {
    for (const DashpotNode& at : nodes_)
      if (nodes.active[static_cast<std::size_t>(at.node)])
        f(at.node, at.dashpots.front().condition, at.share);
  }

  /// Whether the reactions read from a checkpoint have the size for these nodes.
  bool fits() const noexcept { return reactions_known_ ? reaction_.size() == D * n_nodes_ : reaction_.empty(); }
  void continue_from(const Dashpots& earlier) { reactions_known_ = earlier.reactions_known_, reaction_ = earlier.reaction_; }
  static constexpr auto fields()
  {
    return std::tuple{saved("reactions_known", &Dashpots::reactions_known_), saved("reaction", &Dashpots::reaction_)};
  }

 private:
  struct DashpotNode {
    Index node;
    std::size_t row;  ///< row of its reaction
    Vec<D> place;
    std::vector<Dashpot<D>> dashpots;
    bool counted = true;              ///< false on ranks with a copy of the node
    Vec<D> impulse = Vec<D>::Zero();  ///< impulse in the present step [N s]
    Mat<D> share = Mat<D>::Zero();    ///< part of an impulse on the node that it keeps in this step; the dashpots take the rest
    Real waves{};                     ///< energy of incident waves in the present step [J]
  };
  void find_reactions(Communicator& ranks, const Nodes<D>& nodes);

  std::vector<DashpotNode> nodes_;
  std::size_t n_nodes_ = 0;  ///< number of nodes of the whole mesh
  bool reactions_known_ = false;
  std::vector<Real> reaction_;  ///< reaction of all nodes of the whole mesh, D numbers each [N]
};

extern template class Dashpots<2>;
extern template class Dashpots<3>;

}  // namespace talus
