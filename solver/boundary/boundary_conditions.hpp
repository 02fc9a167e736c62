#pragma once
// The boundary conditions of a scene, applied to nodes, to nodes of small mass and to projected nodes.
#include <vector>

#include "core/parallel/communicator.hpp"
#include "core/parallel/exact_sum.hpp"
#include "mesh/mesh.hpp"
#include "mesh/part.hpp"
#include "solver/boundary/boundary_condition.hpp"
#include "solver/boundary/dashpots.hpp"
#include "solver/state/node_work.hpp"
#include "solver/state/nodes.hpp"

namespace talus {

/// All conditions, sorted by node.  Where several meet in a node, conditions that prescribe all components take precedence over planes; of
/// several such conditions the first one in the list of conditions does, or else the one that was added first.  Planes of all conditions
/// act together, so that edges and corners need no special treatment.  Dashpots act on a node before all others.  Each condition stores the
/// impulse that it exerts; the work is returned.
template <int D>
class BoundaryConditions {
 public:
  struct Impulse {
    Vec<D> linear = Vec<D>::Zero();  ///< impulse [N s]
    Vec3 angular = Vec3::Zero();     ///< moment of the impulse about the origin [N m s]
  };
  /// Adds a condition that does not act, to preserve the numbers of the others.
  void add(BoundaryCondition<D> condition) { conditions_.push_back(std::move(condition)); }
  /// Adds a condition on the given nodes.
  void add(BoundaryCondition<D> condition, const Mesh<D>& mesh, std::span<const Index> nodes);
  /// Adds a condition on the facets of one group.  Facets that meet in a node at less than 30 degrees share their mean normal (a smooth
  /// surface); others stay separate planes (an edge).
  void add(BoundaryCondition<D> condition, const Mesh<D>& mesh, std::span<const Facet> facets);
  /// Keeps the conditions on nodes and cells in the part of the mesh on this rank, with its local numbers.
  void restrict_to(const Subdomain& subdomain);
  /// To be called once after the last add() or restrict_to().
  void finalize();

  /// Begins a stage at this time [s].  In a geostatic stage absorbing boundaries hold the model; the dynamic phase begins with the first
  /// other stage after it.
  void begin_stage(bool geostatic, Real time);
  /// Applies dashpots to the nodes in a step of length dt [s], whose new velocities are those of the time `mid` [s].  The work is counted
  /// by apply(), which knows the resulting velocity.  Collective.
  void apply_dashpots(Real mid, Real dt, Communicator& ranks, Nodes<D>& nodes);

  /// Makes the new velocities of active nodes obey the conditions, and marks those that slide.  The work done is added to `work`.
  void apply(const Kick& kick, Nodes<D>& nodes, ExactSums<BoundaryWork>& work);
  /// Applies the conditions to projected nodes, whose values combine those of several nodes; `sums` has their mass and momentum and tells which
  /// ones particles use.  Velocities obey in full: particles move with them, and take the share `pic` of them.  Changes, the rest of what
  /// particles take, are made only as far as the particles' own mean velocity needs them: where it obeys already, an impulse would put energy
  /// into motion that nodes do not see.
  void apply(const Kick& kick, const Nodes<D>& nodes, std::span<const ProjectedNodeSum<D>> sums,
             std::span<ProjectedNodeMotion<D>> projected, Real pic, ExactSums<BoundaryWork>& work);
  /// Applies the conditions to a node of this mass [kg].
  void apply(NodeOfField at, const Kick& kick, Real mass, NodeMotion<D>& motion, ExactSums<BoundaryWork>& work);
  /// The impulses of the present step by condition, to be summed over the ranks; then the conditions store them.
  std::span<ExactSums<Impulse>> pushed() noexcept { return pushed_; }
  void keep_impulses();
  /// Applies the kinematic part only, to remapped velocities of nodes (remapped velocity in `v`, velocity of the step in `change`).  A node
  /// that `slides` keeps the velocity of the step: friction acted on it, and a strain from any other velocity would create energy.
  void hold(Real time, Nodes<D>& nodes) const;
  /// The kinematic part for one node.
  Vec<D> held(NodeOfField at, Real time, const Vec<D>& v) const;

  /// The changes of a velocity that the conditions leave free at a node which moves with v after they have acted: a projection.  Nothing where
  /// they prescribe all components, or friction holds the node at rest; else what is tangential to planes that hold it or that it presses on.
  Mat<D> free_changes(NodeOfField at, const Vec<D>& v) const;
  /// Adds an impulse [N s] that a condition of the node exerts on it to those of this step.
  void react(Index node, const Vec<D>& impulse);
  /// Calls f(node, condition, share) for the nodes of dashpots that act: the node keeps that share of an impulse in the present step.
  template <class F>
  void for_each_dashpot(const Nodes<D>& nodes, F&& f) const
  {
    if (phase_.begun)
      dashpots_.for_each_share(nodes, f);
  }
  /// Adds an impulse [N s] of the dashpots of a condition on a node to those of this step.
  void dashpots_react(Index condition, const Vec<D>& place, const Vec<D>& impulse)
  {
    pushed_[static_cast<std::size_t>(condition)].add({impulse, moment<D>(place, impulse)});
  }
  /// Calls f(node) for each node with conditions.
  template <class F>
  void for_each_node(F&& f) const
  {
    for (const NodeRule& rule : rules_)
      f(rule.node);
  }

  /// A plane of a wall with gaps.
  struct GapPlane {
    Index node;
    int number;     ///< among the one-sided planes of the node
    Vec<D> normal;  ///< out of the mesh, unit length
  };
  /// Of nodes with more than eight planes the first eight.
  std::vector<GapPlane> gap_planes() const;

  std::span<const BoundaryCondition<D>> conditions() const noexcept { return conditions_; }
  /// Copies the data that a restart needs from the conditions of another stage.
  void continue_from(const BoundaryConditions& earlier);
  /// Whether data read from a checkpoint have the sizes of these conditions.
  bool fits() const;
  /// The condition that prescribes all components of a node before the dynamic phase, or none.
  Index holder_of(Index node) const noexcept { return binds(node) ? rule_of(node).holder : none; }
  bool binds(Index node) const noexcept
  {
    return static_cast<std::size_t>(node) < rule_of_node_.size() && rule_of_node_[static_cast<std::size_t>(node)] != none;
  }
  /// Facets that no particle can pass: those of conditions on facets, and boundary facets all of whose nodes are held.
  std::vector<Facet> closed_facets(const Mesh<D>& mesh) const;
  static constexpr auto fields()
  {
    return std::tuple{saved("wall", &BoundaryConditions::conditions_), saved("phase", &BoundaryConditions::phase_),
                      saved("dashpots", &BoundaryConditions::dashpots_)};
  }

 private:
  struct Plane {
    Index condition;
    Vec<D> normal;  ///< out of the mesh, unit length
  };
  struct NodeRule {
    Index node;
    Vec<D> place;
    Index holder = none;           ///< condition that prescribes all components
    std::vector<Plane> two_sided;  ///< with orthonormal normals
    std::vector<Plane> one_sided;
    bool counted = true;  ///< false on ranks with a copy of the node
  };
  class PushedNode;
  /// Calls f(plane) for the one-sided planes that are not open.
  template <class F>
  static void for_each_touched(const NodeRule& rule, std::uint8_t open, F&& f)
  {
    for (std::size_t k = 0; k < rule.one_sided.size(); ++k)
      if (k >= 8 || (open >> k & 1) == 0)
        f(rule.one_sided[k]);
  }
  NodeRule& rule(const Mesh<D>& mesh, Index node);
  void hold_by(Index condition, const Mesh<D>& mesh, Index node);
  void add_planes(Index condition, bool two_sided, const Mesh<D>& mesh, std::span<const Facet> facets);
  void advance_columns(Real mid, Real dt);
  const AnyCondition<D>& kind(Index condition) const noexcept { return conditions_[static_cast<std::size_t>(condition)].kind; }
  /// Whether dashpots have replaced the other action of the condition.
  bool released(Index condition) const noexcept
  {
    return phase_.begun && std::visit([]<class C>(const C&) { return HasDashpots<C>; }, kind(condition));
  }
  bool is_held(const NodeRule& rule) const noexcept { return rule.holder != none && !released(rule.holder); }
  const NodeRule& rule_of(Index node) const noexcept  ///< of a node with conditions
  {
    return rules_[static_cast<std::size_t>(rule_of_node_[static_cast<std::size_t>(node)])];
  }
  /// Applies the conditions of `rule` to a mass [kg] at a node with velocity v, whose change in this step is `change`.  `open`: see Nodes.
  void push(const NodeRule& rule, std::uint8_t open, const Kick& kick, Real mass, Vec<D>& v, Vec<D>& change, bool& sliding,
            ExactSums<BoundaryWork>& work);
  Vec<D> constrained(const NodeRule& rule, std::uint8_t open, Real time, const Vec<D>& v) const;

  std::vector<BoundaryCondition<D>> conditions_;
  std::vector<ExactSums<Impulse>> pushed_;  ///< impulse of each condition in this step
  std::vector<NodeRule> rules_;
  std::vector<Index> rule_of_node_;  ///< `none` for nodes without conditions
  std::vector<Facet> facets_;
  Dashpots<D> dashpots_;
  DynamicPhase phase_;
};

extern template class BoundaryConditions<2>;
extern template class BoundaryConditions<3>;

}  // namespace talus
