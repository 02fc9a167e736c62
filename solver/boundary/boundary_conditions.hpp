#pragma once
// Conditions on nodes, on slaves and on hats: held, moved, sliding, rubbing, giving way.  Each wall keeps the impulse it exerts; the work
// is returned.
#include <algorithm>
#include <cassert>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"
#include "core/parallel/communicator.hpp"
#include "core/parallel/exact_sum.hpp"
#include "core/recorded_motion.hpp"
#include "core/time_table.hpp"
#include "mesh/mesh.hpp"
#include "mesh/part.hpp"
#include "solver/boundary/soil_column.hpp"
#include "solver/state/node_work.hpp"
#include "solver/state/nodes.hpp"

namespace talus {

enum class WallKind : std::uint8_t {
  fixed,           ///< v = 0
  velocity,        ///< v = prescribed
  roller,          ///< v . n = 0, sliding free
  friction,        ///< v . n <= 0 (n points out of the mesh), Coulomb friction, free separation
  compliant_base,  ///< v = 0 while the model seeks its rest, then dashpots to a halfspace that a wave comes up from
  free_field,      ///< a roller while the model seeks its rest, then dashpots to level ground and its stress
};

/// One condition on a group, and what it has done to the bodies.
template <int D>
struct Wall {
  std::string name;
  WallKind kind;
  Real friction{};                   ///< coefficient [-]
  Vec<D> velocity = Vec<D>::Zero();  ///< [m/s], times table(t) or the record; of a compliant base: of the wave that comes up
  Table table;
  std::optional<Record> record;  ///< in the place of the table; begins with the shaking
  Halfspace halfspace;           ///< behind a compliant base
  SoilColumn<D> column;          ///< the ground beside a free field
  Index foot = none;             ///< the wall below that
  SourceLocation where;
  Vec<D> impulse = Vec<D>::Zero();  ///< exerted on the bodies since the start of the run [N s]
  Vec3 angular = Vec3::Zero();      ///< its moment about the origin [N m s]
  static constexpr auto fields() { return std::tuple{saved("impulse", &Wall::impulse), saved("angular", &Wall::angular)}; }
};

/// Since when walls give way that were held while the model sought its rest, and what they carry since.
struct DynamicPhase {
  bool begun = false;  ///< a stage goes on, or is over, that is not geostatic
  bool knows_reactions = false;
  Real begin = 0;                     ///< [s]
  std::vector<Real> reaction;         ///< of the nodes with dashpots in the whole mesh, D numbers each [N]
  std::vector<ColumnMotion> columns;  ///< of the free fields, in the order of the walls
  static constexpr auto fields()
  {
    return std::tuple{saved("begun", &DynamicPhase::begun), saved("knows_reactions", &DynamicPhase::knows_reactions),
                      saved("begin", &DynamicPhase::begin), saved("reaction", &DynamicPhase::reaction),
                      saved("columns", &DynamicPhase::columns)};
  }
};

/// All conditions of a scene, sorted out per node.  Where several meet in a node: `fixed` wins over `velocity` (the earlier one of two),
/// both win over planes; planes (rollers, friction) act together, so edges and corners need no special care.  The dashpots of a base that
/// gives way push before any of these act.
template <int D>
class BoundaryConditions {
 public:
  struct Impulse {
    Vec<D> linear = Vec<D>::Zero();  ///< [N s]
    Vec3 angular = Vec3::Zero();     ///< about the origin [N m s]
  };
  /// A condition that does not act, and keeps its place among the others.
  void add(Wall<D> wall) { walls_.push_back(std::move(wall)); }
  /// Conditions on all components of the nodes given.
  void add(Wall<D> wall, const Mesh<D>& mesh, std::span<const Index> nodes);
  /// Conditions with a normal: facets of one group.  Facets that meet in a node under less than 30 degrees share their mean normal (a
  /// smooth surface); sharper ones stay separate planes (an edge).  A compliant base takes its area from them, and so does a free field, to
  /// be added after what holds its foot.
  void add(Wall<D> wall, const Mesh<D>& mesh, std::span<const Facet> facets);
  /// Of one of several ranks: only conditions on nodes and cells that are held, in their numbers here.
  void restrict_to(const Subdomain& share);
  /// To be called once after the last add() or restrict_to().
  void settle();

  /// A stage begins at this time [s].  A geostatic one holds what others let go; records begin with the first other one after it.
  void begin_stage(bool geostatic, Real time);
  /// Dashpots push the nodes in a step of length dt [s], whose new velocities are of the time `mid` [s].  In the first one after a geostatic
  /// stage it is found what keeps each node in balance, and from then on that force goes on: every rank has to ask.  The work is counted by
  /// apply(), which knows the velocity that comes out.
  void apply_dashpots(Real mid, Real dt, Communicator& ranks, Nodes<D>& nodes);

  /// The new velocities of nodes with active mass obey the walls at their time.  The work done is added to `work`.
  void apply(const Kick& kick, Nodes<D>& nodes, ExactSums<BoundaryWork>& work);
  /// So does what particles read on hats, where it is not that of the node alone: the row of a hat on a wall may reach nodes off it.
  /// `sums` say with which mass a hat moves, and which are seen.
  void apply(const Kick& kick, std::span<const ProjectedNodeSum<D>> sums, std::span<ProjectedNodeMotion<D>> hats,
             ExactSums<BoundaryWork>& work);
  /// And so does a node that follows others: its own mass [kg] gets its part of the walls' pushes.
  void apply(Index node, const Kick& kick, Real mass, NodeMotion<D>& motion, ExactSums<BoundaryWork>& work);
  /// The impulses of the step at hand, by wall, to be summed up over the ranks; then the walls keep them.
  std::span<ExactSums<Impulse>> pushed() noexcept { return pushed_; }
  void keep_impulses();
  /// The kinematic part alone, on remapped velocities (rows: remapped one in `v`, the step's own in `change`).  A node that rubs
  /// keeps the step's own: friction acted on that one, and a strain taken from any other would make energy.
  void hold(Real time, std::span<NodeMotion<D>> remapped) const;
  /// The same for one node.
  Vec<D> held(Index node, Real time, const Vec<D>& v) const;

  std::span<const Wall<D>> walls() const noexcept { return walls_; }
  /// What is kept of the walls becomes that of the same walls in another model of the scene.
  void go_on_from(const BoundaryConditions& earlier)
  {
    assert(walls_.size() == earlier.walls_.size());
    for (std::size_t w = 0; w < walls_.size(); ++w)
      for_each_field<Wall<D>>([&](const auto& field) { walls_[w].*field.member = earlier.walls_[w].*field.member; });
    shaking_ = earlier.shaking_;
  }
  /// Whether what was kept may be of walls like these.
  bool fits() const;
  /// The wall that holds or moves a node in all directions while the model seeks its rest, or none.
  Index holder_of(Index node) const noexcept;
  bool binds(Index node) const noexcept
  {
    return static_cast<std::size_t>(node) < rule_of_node_.size() && rule_of_node_[static_cast<std::size_t>(node)] != none;
  }
  /// Facets of rollers and friction walls, and facets whose nodes are all held or moved: no particle passes them.
  std::vector<Facet> closed_facets(const Mesh<D>& mesh) const;
  static constexpr auto fields()
  {
    return std::tuple{saved("wall", &BoundaryConditions::walls_), saved("shaking", &BoundaryConditions::shaking_)};
  }

 private:
  struct Plane {
    Index wall;
    Vec<D> normal;  ///< out of the mesh, unit length
  };
  struct NodeRule {
    Index node;
    Vec<D> place;
    Index whole = none;          ///< wall that sets all components
    Index base = none;           ///< compliant base, which does so until the shaking begins
    std::vector<Plane> rollers;  ///< normals made orthonormal
    std::vector<Plane> frictions;
    bool sliding = false;  ///< the last apply() found it pressed against a friction wall
    bool counted = true;   ///< by this rank: another one keeps impulses and work of nodes that are not its own
  };
  /// At a node of walls that give way; the first of them keeps its impulses.
  struct Dashpot {
    struct Part {
      Index wall;
      Mat<D> resistance = Mat<D>::Zero();                     ///< force per velocity [N s/m]
      std::vector<std::pair<std::size_t, Vec<D>>> face = {};  ///< of a free field: layer and area vector [m^(D-1)]
    };
    Index node;
    std::size_t row;  ///< of its reaction
    Vec<D> place;
    std::vector<Part> parts;
    bool counted = true;              ///< as that of a rule
    Vec<D> impulse = Vec<D>::Zero();  ///< in the step at hand [N s]
    Real brought{};                   ///< energy, by waves, in the step at hand [J]
  };
  NodeRule& rule(const Mesh<D>& mesh, Index node);
  using Parts = std::map<Index, typename Dashpot::Part>;  // by node
  void add_dashpots(const Mesh<D>& mesh, Parts parts);
  Parts base_parts(Index number, const Mesh<D>& mesh, std::span<const Facet> facets) const;
  Parts side_parts(Index number, const Mesh<D>& mesh, std::span<const Facet> facets) const;
  void find_reactions(Communicator& ranks, const Nodes<D>& nodes);
  void advance_columns(Real mid, Real dt);
  std::size_t free_field_number(Index wall) const noexcept
  {
    return static_cast<std::size_t>(std::find(free_fields_.begin(), free_fields_.end(), wall) - free_fields_.begin());
  }
  /// The velocity of the wave that comes up to a wall which gives way, or of the free field beside it [m/s], and what it does to a node
  /// that does not move [N].
  Vec<D> wave_at(const typename Dashpot::Part& part, const Vec<D>& place, Real mid) const noexcept;
  Vec<D> drive(const typename Dashpot::Part& part, const Vec<D>& wave) const noexcept;
  /// The wall that sets all components of a node now, or none.
  Index whole_of(const NodeRule& rule) const noexcept { return rule.whole == none && !shaking_.begun ? rule.base : rule.whole; }
  bool releases(Index wall) const noexcept { return walls_[static_cast<std::size_t>(wall)].kind == WallKind::free_field; }
  bool holds(const Plane& plane) const noexcept { return !shaking_.begun || !releases(plane.wall); }
  /// What a wall prescribes at a time [s]: its own velocity, or that of the wave which comes up to it.
  Vec<D> prescribed(const Wall<D>& wall, Real time) const noexcept;
  const NodeRule& rule_of(Index node) const noexcept  ///< of a node that is bound
  {
    return rules_[static_cast<std::size_t>(rule_of_node_[static_cast<std::size_t>(node)])];
  }
  /// Pushes a mass [kg] that moves with v and has changed by `change` in this step; walls keep the impulses.
  void act(const NodeRule& rule, const Kick& kick, Real mass, Vec<D>& v, Vec<D>& change, bool& sliding, ExactSums<BoundaryWork>& work);
  Vec<D> constrained(const NodeRule& rule, Real time, const Vec<D>& v) const;
  Vec<D> moves(const NodeRule& rule, const Kick& kick) const;

  std::vector<Wall<D>> walls_;
  std::vector<ExactSums<Impulse>> pushed_;  ///< by each wall in this step
  std::vector<NodeRule> rules_;
  std::vector<Index> rule_of_node_;  ///< or none
  std::vector<Facet> facets_;
  std::vector<Dashpot> dashpots_;
  std::size_t n_dashpots_ = 0;              ///< in the whole mesh
  std::vector<Index> free_fields_;          ///< walls
  std::vector<ColumnMotion> columns_then_;  ///< of these, at the beginning of the step
  DynamicPhase shaking_;
};

extern template class BoundaryConditions<2>;
extern template class BoundaryConditions<3>;

}  // namespace talus
