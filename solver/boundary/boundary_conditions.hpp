#pragma once
// The boundary conditions of a scene, applied to nodes, to nodes of small mass and to projected nodes.
#include <algorithm>
#include <cassert>
#include <string>
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

/// All conditions, sorted by node.  Where several meet in a node, those that hold all components win over planes, and of several the first
/// one in the list of conditions, or else the one that was added first.  Planes of all conditions act together, so that edges and corners
/// need no special care.  Dashpots push a node before any of these act.  Each condition keeps the impulse that it exerts; the work is
/// returned.
template <int D>
class BoundaryConditions {
 public:
  struct Impulse {
    Vec<D> linear = Vec<D>::Zero();  ///< [N s]
    Vec3 angular = Vec3::Zero();     ///< about the origin [N m s]
  };
  /// A condition that does not act, and keeps its place among the others.
  void add(BoundaryCondition<D> condition) { conditions_.push_back(std::move(condition)); }
  /// A condition on the given nodes.
  void add(BoundaryCondition<D> condition, const Mesh<D>& mesh, std::span<const Index> nodes);
  /// A condition on the facets of one group.  Facets that meet in a node at less than 30 degrees share their mean normal (a smooth surface);
  /// others stay separate planes (an edge).
  void add(BoundaryCondition<D> condition, const Mesh<D>& mesh, std::span<const Facet> facets);
  /// Keeps the conditions on nodes and cells that one of several ranks holds, with its local numbers.
  void restrict_to(const Subdomain& share);
  /// To be called once after the last add() or restrict_to().
  void finalize();

  /// A stage begins at this time [s].  In a geostatic one absorbing boundaries hold the model; the dynamic phase begins with the first other
  /// stage after it.
  void begin_stage(bool geostatic, Real time);
  /// Dashpots push the nodes in a step of length dt [s], whose new velocities are of the time `mid` [s].  Every rank has to call.  The work
  /// is counted by apply(), which knows the resulting velocity.
  void apply_dashpots(Real mid, Real dt, Communicator& ranks, Nodes<D>& nodes);

  /// Makes the new velocities of active nodes obey the conditions.  The work done is added to `work`.
  void apply(const Kick& kick, Nodes<D>& nodes, ExactSums<BoundaryWork>& work);
  /// The same for projected nodes, whose values mix those of several nodes; `sums` has their mass and tells which ones particles see.
  void apply(const Kick& kick, std::span<const ProjectedNodeSum<D>> sums, std::span<ProjectedNodeMotion<D>> projected,
             ExactSums<BoundaryWork>& work);
  /// The same for a node of small mass [kg].
  void apply(Index node, const Kick& kick, Real mass, NodeMotion<D>& motion, ExactSums<BoundaryWork>& work);
  /// The impulses of the step at hand, by condition, to be summed over the ranks; then the conditions keep them.
  std::span<ExactSums<Impulse>> pushed() noexcept { return pushed_; }
  void keep_impulses();
  /// The kinematic part alone, on remapped velocities (rows: the remapped one in `v`, that of the step in `change`).  A node that slides
  /// keeps that of the step: friction acted on it, and a strain from any other velocity would create energy.
  void hold(Real time, std::span<NodeMotion<D>> remapped) const;
  /// The same for one node.
  Vec<D> held(Index node, Real time, const Vec<D>& v) const;

  std::span<const BoundaryCondition<D>> conditions() const noexcept { return conditions_; }
  /// Takes over what a restart needs from the same conditions of another stage.
  void continue_from(const BoundaryConditions& earlier);
  /// Whether what was read from a checkpoint may be of these conditions.
  bool fits() const;
  /// The condition that holds or moves a node in all directions before the dynamic phase, or none.
  Index holder_of(Index node) const noexcept { return binds(node) ? rule_of(node).holder : none; }
  bool binds(Index node) const noexcept
  {
    return static_cast<std::size_t>(node) < rule_of_node_.size() && rule_of_node_[static_cast<std::size_t>(node)] != none;
  }
  /// Facets of conditions on facets, and boundary facets whose nodes are all held: no particle passes them.
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
    Index holder = none;           ///< condition that sets all components
    std::vector<Plane> two_sided;  ///< with orthonormal normals
    std::vector<Plane> one_sided;
    bool sliding = false;  ///< the last apply() found it pressed against a wall with friction
    bool counted = true;   ///< on this rank, and not on another one that has a copy of the node
  };
  class PushedNode;
  NodeRule& rule(const Mesh<D>& mesh, Index node);
  void hold_by(Index condition, const Mesh<D>& mesh, Index node);
  void add_planes(Index condition, bool two_sided, const Mesh<D>& mesh, std::span<const Facet> facets);
  void advance_columns(Real mid, Real dt);
  const AnyCondition<D>& kind(Index condition) const noexcept { return conditions_[static_cast<std::size_t>(condition)].kind; }
  /// Whether dashpots have taken the place of what the condition does else.
  bool released(Index condition) const noexcept
  {
    return phase_.begun && std::visit([]<class C>(const C&) { return HasDashpots<C>; }, kind(condition));
  }
  bool is_held(const NodeRule& rule) const noexcept { return rule.holder != none && !released(rule.holder); }
  const NodeRule& rule_of(Index node) const noexcept  ///< of a node that is bound
  {
    return rules_[static_cast<std::size_t>(rule_of_node_[static_cast<std::size_t>(node)])];
  }
  /// Pushes a mass [kg] at a node that moves with v and has changed by `change` in this step.
  void push(const NodeRule& rule, const Kick& kick, Real mass, Vec<D>& v, Vec<D>& change, bool& sliding, ExactSums<BoundaryWork>& work);
  Vec<D> constrained(const NodeRule& rule, Real time, const Vec<D>& v) const;

  std::vector<BoundaryCondition<D>> conditions_;
  std::vector<ExactSums<Impulse>> pushed_;  ///< by each condition in this step
  std::vector<NodeRule> rules_;
  std::vector<Index> rule_of_node_;  ///< or none
  std::vector<Facet> facets_;
  Dashpots<D> dashpots_;
  DynamicPhase phase_;
};

extern template class BoundaryConditions<2>;
extern template class BoundaryConditions<3>;

}  // namespace talus
