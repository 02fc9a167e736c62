#pragma once
// Conditions on nodes, on slaves and on hats: held, moved, sliding, rubbing.  Each wall keeps the impulse it exerts; the work is returned.
#include <cassert>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/exact_sum.hpp"
#include "core/exchange.hpp"
#include "core/fields.hpp"
#include "core/table.hpp"
#include "mesh/mesh.hpp"
#include "mesh/part.hpp"
#include "solver/ledger.hpp"
#include "solver/nodes.hpp"

namespace talus {

enum class WallKind : std::uint8_t {
  fixed,     ///< v = 0
  velocity,  ///< v = prescribed
  roller,    ///< v . n = 0, sliding free
  friction,  ///< v . n <= 0 (n points out of the mesh), Coulomb friction, free separation
};

/// One condition on a group, and what it has done to the bodies.
template <int D>
struct Wall {
  std::string name;
  WallKind kind;
  Real friction{};                   ///< coefficient [-]
  Vec<D> velocity = Vec<D>::Zero();  ///< [m/s], times table(t)
  Table table;
  Where where;
  Vec<D> impulse = Vec<D>::Zero();  ///< exerted on the bodies since the last reset [N s]
  Vec3 angular = Vec3::Zero();      ///< its moment about the origin [N m s]
  static constexpr auto fields() { return std::tuple{kept("impulse", &Wall::impulse), kept("angular", &Wall::angular)}; }
};

/// What walls did to the energy of the bodies in a step [J].
struct WallWork {
  Real friction{};  ///< of tangential impulses of friction walls, <= 0
  Real other{};     ///< of all other impulses: prescribed motion, inelastic arrival
};

/// All conditions of a scene, sorted out per node.  Where several meet in a node: `fixed` wins over `velocity` (the earlier
/// one of two), both win over planes; planes (rollers, friction) act together, so edges and corners need no special care.
template <int D>
class Walls {
 public:
  struct Impulse {
    Vec<D> linear = Vec<D>::Zero();  ///< [N s]
    Vec3 angular = Vec3::Zero();     ///< about the origin [N m s]
  };
  /// A condition that does not act, and keeps its place among the others.
  void add(Wall<D> wall) { walls_.push_back(std::move(wall)); }
  /// Conditions on all components of the nodes given.
  void add(Wall<D> wall, const Mesh<D>& mesh, std::span<const Index> nodes);
  /// Conditions with a normal: facets of one group.  Facets that meet in a node under less than 30 degrees share their mean
  /// normal (a smooth surface); sharper ones stay separate planes (an edge).
  void add(Wall<D> wall, const Mesh<D>& mesh, std::span<const Facet> facets);
  /// Of one of several ranks: only conditions on nodes and cells that are held, in their numbers here.
  void restrict_to(const Share& share);
  /// To be called once after the last add() or restrict_to().
  void settle();

  /// The new velocities of nodes with active mass obey the walls at the end of the step [s].  The work done is added to `work`.
  void apply(Real end, Nodes<D>& nodes, ExactSums<WallWork>& work);
  /// So does what particles read on hats, where it is not that of the node alone: the row of a hat on a wall may reach nodes off it.
  /// `sums` say with which mass a hat moves, and which are seen.
  void apply(Real end, std::span<const HatSum<D>> sums, std::span<HatMotion<D>> hats, ExactSums<WallWork>& work);
  /// And so does a node that follows others: its own mass [kg] gets its part of the walls' pushes.
  void apply(Index node, Real end, Real mass, NodeMotion<D>& motion, ExactSums<WallWork>& work);
  /// The impulses of the step at hand, by wall, to be summed up over the ranks; then the walls keep them.
  std::span<ExactSums<Impulse>> pushed() noexcept { return pushed_; }
  void keep_impulses();
  /// The kinematic part alone, on remapped velocities (rows: remapped one in `v`, the step's own in `change`).  A node that rubs
  /// keeps the step's own: friction acted on that one, and a strain taken from any other would make energy.
  void hold(Real time, std::span<NodeMotion<D>> remapped) const;
  /// The same for one node.
  Vec<D> held(Index node, Real time, const Vec<D>& v) const;

  std::span<const Wall<D>> walls() const noexcept { return walls_; }
  void reset_impulses() noexcept;
  /// What is kept of the walls becomes that of the same walls in another model of the scene.
  void go_on_from(const Walls& earlier)
  {
    assert(walls_.size() == earlier.walls_.size());
    for (std::size_t w = 0; w < walls_.size(); ++w)
      for_each_field<Wall<D>>([&](const auto& field) { walls_[w].*field.member = earlier.walls_[w].*field.member; });
  }
  bool binds(Index node) const noexcept
  {
    return static_cast<std::size_t>(node) < rule_of_node_.size() && rule_of_node_[static_cast<std::size_t>(node)] != none;
  }
  /// Facets of rollers and friction walls, and facets whose nodes are all held or moved: no particle passes them.
  std::vector<Facet> closed_facets(const Mesh<D>& mesh) const;
  static constexpr auto fields() { return std::tuple{kept("wall", &Walls::walls_)}; }

 private:
  struct Plane {
    Index wall;
    Vec<D> normal;  ///< out of the mesh, unit length
  };
  struct NodeRule {
    Index node;
    Vec<D> place;
    Index whole = none;          ///< wall that sets all components
    std::vector<Plane> rollers;  ///< normals made orthonormal
    std::vector<Plane> frictions;
    bool rubs = false;    ///< the last apply() found it pressed against a friction wall
    bool counted = true;  ///< by this rank: another one keeps impulses and work of nodes that are not its own
  };
  NodeRule& rule(const Mesh<D>& mesh, Index node);
  const NodeRule& rule_of(Index node) const noexcept  ///< of a node that is bound
  {
    return rules_[static_cast<std::size_t>(rule_of_node_[static_cast<std::size_t>(node)])];
  }
  /// Pushes a mass [kg] that moves with v and has changed by `change` in this step; walls keep the impulses.
  void act(const NodeRule& rule, Real end, Real mass, Vec<D>& v, Vec<D>& change, bool& rubs, ExactSums<WallWork>& work);
  Vec<D> constrained(const NodeRule& rule, Real time, const Vec<D>& v) const;

  std::vector<Wall<D>> walls_;
  std::vector<ExactSums<Impulse>> pushed_;  ///< by each wall in this step
  std::vector<NodeRule> rules_;
  std::vector<Index> rule_of_node_;  ///< or none
  std::vector<Facet> facets_;
};

extern template class Walls<2>;
extern template class Walls<3>;

}  // namespace talus
