#include "solver/boundary/boundary_conditions.hpp"

#include <algorithm>
#include <bit>
#include <map>

namespace talus {

namespace {

/// Cosine of the angle below which two facets belong to one smooth surface.
constexpr Real smooth = 0.8660254037844387;
/// Sweeps over the planes of an edge or corner; each sweep contracts the violation by the cosine of their angle or better.
constexpr int sweeps = 20;

}  // namespace

template <int D>
typename BoundaryConditions<D>::NodeRule& BoundaryConditions<D>::rule(const Mesh<D>& mesh, Index node)
{
  if (static_cast<std::size_t>(node) >= rule_of_node_.size())
    rule_of_node_.resize(static_cast<std::size_t>(node) + 1, none);
  Index& at = rule_of_node_[static_cast<std::size_t>(node)];
  if (at == none) {
    at = static_cast<Index>(rules_.size());
    rules_.push_back({.node = node, .place = mesh.node(node), .rollers = {}, .frictions = {}});
  }
  return rules_[static_cast<std::size_t>(at)];
}

template <int D>
typename BoundaryConditions<D>::Parts BoundaryConditions<D>::base_parts(Index number, const Mesh<D>& mesh,
                                                                        std::span<const Facet> facets) const
{
  Parts parts;
  for (const Facet facet : facets)
    for (const Index n : mesh.nodes_of(facet))
      parts.try_emplace(n, typename Dashpot::Part{number}).first->second.resistance +=
          impedance<D>(walls_[static_cast<std::size_t>(number)].halfspace, mesh.area_vector(facet)) / D;
  return parts;
}

/// A facet that no ground lies beside, above the column, has no part.
template <int D>
typename BoundaryConditions<D>::Parts BoundaryConditions<D>::side_parts(Index number, const Mesh<D>& mesh,
                                                                        std::span<const Facet> facets) const
{
  const SoilColumn<D>& column = walls_[static_cast<std::size_t>(number)].column;
  Parts parts;
  for (const Facet facet : facets) {
    Real height = 0;
    for (const Index n : mesh.nodes_of(facet))
      height += column.up.dot(mesh.node(n)) / D;
    if (height > column.level.back())
      continue;
    const std::size_t layer = column.layer_at(height);
    const Vec<D> share = mesh.area_vector(facet) / D;
    for (const Index n : mesh.nodes_of(facet)) {
      auto& part = parts.try_emplace(n, typename Dashpot::Part{number}).first->second;
      part.resistance += column.layer[layer].filled * impedance<D>(column.layer[layer].ground, share);
      part.face.emplace_back(layer, share);
    }
  }
  return parts;
}

template <int D>
void BoundaryConditions<D>::add_dashpots(const Mesh<D>& mesh, Parts parts)
{
  std::map<Index, std::size_t> known;
  for (std::size_t k = 0; k < dashpots_.size(); ++k)
    known.emplace(dashpots_[k].node, k);
  for (auto& [node, part] : parts) {
    if (const auto at = known.find(node); at != known.end())
      dashpots_[at->second].parts.push_back(std::move(part));
    else
      dashpots_.push_back({.node = node, .row = n_dashpots_++, .place = mesh.node(node), .parts = {std::move(part)}});
  }
}

template <int D>
Index BoundaryConditions<D>::holder_of(Index node) const noexcept
{
  return !binds(node) ? none : rule_of(node).whole != none ? rule_of(node).whole : rule_of(node).base;
}

template <int D>
void BoundaryConditions<D>::add(Wall<D> wall, const Mesh<D>& mesh, std::span<const Index> nodes)
{
  const auto number = static_cast<Index>(walls_.size());
  const bool fixed = wall.kind == WallKind::fixed;
  walls_.push_back(std::move(wall));
  for (const Index n : nodes) {
    Index& whole = rule(mesh, n).whole;
    if (whole == none || (fixed && walls_[static_cast<std::size_t>(whole)].kind != WallKind::fixed))
      whole = number;
  }
}

template <int D>
void BoundaryConditions<D>::add(Wall<D> wall, const Mesh<D>& mesh, std::span<const Facet> facets)
{
  const auto number = static_cast<Index>(walls_.size());
  const bool roller = wall.kind != WallKind::friction;
  walls_.push_back(std::move(wall));
  facets_.insert(facets_.end(), facets.begin(), facets.end());
  if (walls_.back().kind == WallKind::compliant_base) {
    Parts parts = base_parts(number, mesh, facets);
    for (const auto& [node, part] : parts)
      if (rule(mesh, node).base == none)
        rule(mesh, node).base = number;
    return add_dashpots(mesh, std::move(parts));
  }
  if (walls_.back().kind == WallKind::free_field) {
    free_fields_.push_back(number);
    add_dashpots(mesh, side_parts(number, mesh, facets));
  }
  for (const Facet facet : facets) {
    const Vec<D> area = mesh.area_vector(facet);
    for (const Index n : mesh.nodes_of(facet)) {
      auto& planes = roller ? rule(mesh, n).rollers : rule(mesh, n).frictions;
      // until settle(), a plane's normal is the sum of the area vectors it stands for
      const auto same = std::find_if(planes.begin(), planes.end(), [&](const Plane& plane) {
        return plane.normal.dot(area) > smooth * plane.normal.norm() * area.norm();
      });
      if (same != planes.end())
        same->normal += area;
      else
        planes.push_back({number, area});
    }
  }
}

template <int D>
void BoundaryConditions<D>::restrict_to(const Subdomain& share)
{
  std::erase_if(rules_, [&](NodeRule& rule) {
    rule.node = share.local_node(rule.node);
    rule.counted = rule.node != none && share.owns_node(rule.node);
    return rule.node == none;
  });
  std::erase_if(dashpots_, [&](Dashpot& dashpot) {
    dashpot.node = share.local_node(dashpot.node);
    dashpot.counted = dashpot.node != none && share.owns_node(dashpot.node);
    return dashpot.node == none;
  });
  std::erase_if(facets_, [&](Facet& facet) {
    facet.cell = share.local_cell(facet.cell);
    return facet.cell == none;
  });
  rule_of_node_.assign(share.node.size(), none);
}

template <int D>
void BoundaryConditions<D>::settle()
{
  pushed_.resize(walls_.size());
  for (NodeRule& rule : rules_) {
    for (Plane& plane : rule.frictions)
      plane.normal.normalize();
    // those that let go later come last, so that the others stand without them
    std::stable_partition(rule.rollers.begin(), rule.rollers.end(), [&](const Plane& plane) { return !releases(plane.wall); });
    std::vector<Plane> basis;  // Gram-Schmidt; a normal that the others span already adds nothing
    for (Plane plane : rule.rollers) {
      plane.normal.normalize();
      for (const Plane& other : basis)
        plane.normal -= plane.normal.dot(other.normal) * other.normal;
      if (plane.normal.norm() > 1e-6) {
        plane.normal.normalize();
        basis.push_back(plane);
      }
    }
    rule.rollers = basis;
  }
  std::sort(rules_.begin(), rules_.end(), [](const NodeRule& a, const NodeRule& b) { return a.node < b.node; });
  for (std::size_t r = 0; r < rules_.size(); ++r)
    rule_of_node_[static_cast<std::size_t>(rules_[r].node)] = static_cast<Index>(r);
}

template <int D>
void BoundaryConditions<D>::begin_stage(bool geostatic, Real time)
{
  if (geostatic)
    shaking_ = {};
  else if (!shaking_.begun)
    shaking_ = {.begun = true, .begin = time, .reaction = {}, .columns = {}};
}

template <int D>
void BoundaryConditions<D>::find_reactions(Communicator& ranks, const Nodes<D>& nodes)
{
  std::vector<std::int64_t> bits(D * n_dashpots_, 0);  // each number is told by one rank, the others add nothing to it
  for (const Dashpot& dashpot : dashpots_) {
    const auto n = static_cast<std::size_t>(dashpot.node);
    const Vec<D> reaction = -nodes.sum[n].mass / nodes.kick * nodes.motion[n].change;
    for (int d = 0; d < D && dashpot.counted && nodes.active[n]; ++d)
      bits[D * dashpot.row + static_cast<std::size_t>(d)] = std::bit_cast<std::int64_t>(reaction[d]);
  }
  ranks.sum(bits);
  for (const std::int64_t number : bits)
    shaking_.reaction.push_back(std::bit_cast<Real>(number));
  for (const Index wall : free_fields_)
    shaking_.columns.push_back(walls_[static_cast<std::size_t>(wall)].column.at_rest());
  shaking_.knows_reactions = true;
}

template <int D>
bool BoundaryConditions<D>::fits() const
{
  if (!shaking_.knows_reactions)
    return shaking_.reaction.empty() && shaking_.columns.empty();
  if (shaking_.reaction.size() != D * n_dashpots_ || shaking_.columns.size() != free_fields_.size())
    return false;
  for (std::size_t k = 0; k < free_fields_.size(); ++k) {
    const ColumnMotion of_scene = walls_[static_cast<std::size_t>(free_fields_[k])].column.at_rest(), &kept_one = shaking_.columns[k];
    if (kept_one.velocity.size() != of_scene.velocity.size() || kept_one.traction.size() != of_scene.traction.size())
      return false;
  }
  return true;
}

/// The columns move on by themselves; what they do to the model in this step is what their stress was at its beginning, as that of the
/// particles, and their new velocity, of its middle.
template <int D>
void BoundaryConditions<D>::advance_columns(Real mid, Real dt)
{
  columns_then_ = shaking_.columns;
  for (std::size_t k = 0; k < free_fields_.size(); ++k) {
    const Wall<D>& side = walls_[static_cast<std::size_t>(free_fields_[k])];
    const Wall<D>& below = walls_[static_cast<std::size_t>(side.foot)];
    Foot<D> foot;
    if (below.kind != WallKind::fixed)
      foot.velocity = prescribed(below, mid);
    if (below.kind == WallKind::compliant_base)
      foot.halfspace = below.halfspace;
    advance(side.column, foot, dt, shaking_.columns[k]);
  }
}

template <int D>
Vec<D> BoundaryConditions<D>::wave_at(const typename Dashpot::Part& part, const Vec<D>& place, Real mid) const noexcept
{
  const Wall<D>& wall = walls_[static_cast<std::size_t>(part.wall)];
  if (wall.kind == WallKind::compliant_base)
    return prescribed(wall, mid);
  return wall.column.velocity_at(wall.column.up.dot(place), shaking_.columns[free_field_number(part.wall)]);
}

template <int D>
Vec<D> BoundaryConditions<D>::drive(const typename Dashpot::Part& part, const Vec<D>& wave) const noexcept
{
  const Wall<D>& wall = walls_[static_cast<std::size_t>(part.wall)];
  if (wall.kind == WallKind::compliant_base)
    return part.resistance * (2 * wave);
  Vec<D> force = part.resistance * wave;
  for (const auto& [layer, area] : part.face)
    force += wall.column.force_on(area, layer, columns_then_[free_field_number(part.wall)]);
  return force;
}

/// Implicit in the new velocity, as a node may be lighter than what the dashpot carries off in a step; waves and free fields are of the same
/// time as that, the middle of the step:
///   m (v - v_free) / kick = C (2 v_up - v) + reaction              of a base
///   m (v - v_free) / kick = C (v_ff - v) + s_ff n A + reaction      of a side
/// The halfspace takes C v off and brings 2 C v_up, of which one half is the wave itself and one the wave that it would send back [Joyner &
/// Chen 1975].  Beside, only what differs from the free field (ff) leaves [Zienkiewicz, Bicanic & Shen 1988].
template <int D>
void BoundaryConditions<D>::apply_dashpots(Real mid, Real dt, Communicator& ranks, Nodes<D>& nodes)
{
  if (!shaking_.begun || n_dashpots_ == 0)
    return;
  if (!shaking_.knows_reactions)
    find_reactions(ranks, nodes);
  advance_columns(mid, dt);
  for (Dashpot& dashpot : dashpots_) {
    const auto n = static_cast<std::size_t>(dashpot.node);
    dashpot.impulse.setZero();
    dashpot.brought = 0;
    if (!nodes.active[n])
      continue;
    const Real mass = nodes.sum[n].mass;
    NodeMotion<D>& motion = nodes.motion[n];
    Mat<D> inertia = mass * Mat<D>::Identity();
    Vec<D> momentum = mass * motion.v + nodes.kick * Eigen::Map<const Vec<D>>(&shaking_.reaction[D * dashpot.row]);
    for (const auto& part : dashpot.parts) {
      inertia += nodes.kick * part.resistance;
      const Vec<D> wave = wave_at(part, dashpot.place, mid);
      momentum += nodes.kick * drive(part, wave);
      dashpot.brought += nodes.kick * wave.dot(part.resistance * wave);
    }
    const Vec<D> by = inertia.inverse() * momentum - motion.v;
    motion.v += by, motion.change += by;
    dashpot.impulse = mass * by;
  }
}

template <int D>
Vec<D> BoundaryConditions<D>::prescribed(const Wall<D>& wall, Real time) const noexcept
{
  const bool counts_from_shaking = wall.record || wall.kind == WallKind::compliant_base;
  if (counts_from_shaking && !shaking_.begun)
    return Vec<D>::Zero();
  const Real since = counts_from_shaking ? time - shaking_.begin : time;
  return (wall.record ? (*wall.record)(since) : wall.table(since)) * wall.velocity;
}

/// The mean velocity of the wall that sets all components of a node; planes do not move along their normals.
template <int D>
Vec<D> BoundaryConditions<D>::moves(const NodeRule& rule, const Kick& kick) const
{
  const Index whole = whole_of(rule);
  if (whole == none || walls_[static_cast<std::size_t>(whole)].kind != WallKind::velocity)
    return Vec<D>::Zero();
  const Wall<D>& wall = walls_[static_cast<std::size_t>(whole)];
  return 0.5 * (prescribed(wall, kick.from) + prescribed(wall, kick.to));
}

template <int D>
void BoundaryConditions<D>::act(const NodeRule& rule, const Kick& kick, Real mass, Vec<D>& v, Vec<D>& change, bool& sliding,
                                ExactSums<BoundaryWork>& work)
{
  const Vec<D> v_free = v, v_old = v - change;
  Vec<D> rubbed = Vec<D>::Zero();
  Index pushing = none;  // a wall that has pushed, and by how much up to now
  Vec<D> pushed = Vec<D>::Zero();
  const auto note = [&] {
    if (rule.counted && pushing != none)
      pushed_[static_cast<std::size_t>(pushing)].add({mass * pushed, mass * moment<D>(rule.place, pushed)});
  };
  const auto push = [&](Index wall, const Vec<D>& by) {
    if (wall != pushing) {
      note();
      pushing = wall;
      pushed.setZero();
    }
    pushed += by;
    v += by;
  };
  sliding = false;
  if (const Index whole = whole_of(rule); whole != none) {
    push(whole, constrained(rule, kick.to, v) - v);
  } else {
    for (int sweep = 0; sweep < (rule.frictions.empty() ? 1 : sweeps); ++sweep) {
      bool touched = false;
      for (const Plane& plane : rule.rollers)
        if (holds(plane))
          push(plane.wall, -v.dot(plane.normal) * plane.normal);
      for (const Plane& plane : rule.frictions) {
        const Real into = v.dot(plane.normal);
        if (into <= 0)
          continue;
        push(plane.wall, -into * plane.normal);
        const Real slip = v.norm(), limit = walls_[static_cast<std::size_t>(plane.wall)].friction * into;  // v is tangential now
        const Vec<D> rub = slip <= limit ? Vec<D>(-v) : Vec<D>(-limit / slip * v);
        push(plane.wall, rub);
        rubbed += rub;
        touched = sliding = true;
      }
      if (!touched || rule.rollers.size() + rule.frictions.size() == 1)
        break;
    }
  }
  note();
  const Vec<D> v_mid = 0.5 * (v_old + v);
  const Real friction = mass * rubbed.dot(v_mid), all = mass * (v - v_free).dot(v_mid), moved = mass * (v - v_free).dot(moves(rule, kick));
  change = v - v_old;
  if (rule.counted)
    work.add({friction, moved, all - friction - moved, 0, mass * moment<D>(rule.place, v - v_free)});
}

template <int D>
void BoundaryConditions<D>::apply(const Kick& kick, Nodes<D>& nodes, ExactSums<BoundaryWork>& work)
{
  for (NodeRule& rule : rules_) {
    const auto n = static_cast<std::size_t>(rule.node);
    rule.sliding = false;
    if (nodes.active[n])
      act(rule, kick, nodes.sum[n].mass, nodes.motion[n].v, nodes.motion[n].change, rule.sliding, work);
  }
  for (const Dashpot& dashpot : dashpots_) {
    const auto n = static_cast<std::size_t>(dashpot.node);
    if (!shaking_.begun || !dashpot.counted || !nodes.active[n])
      continue;
    const Vec3 turned = moment<D>(dashpot.place, dashpot.impulse);
    pushed_[static_cast<std::size_t>(dashpot.parts.front().wall)].add({dashpot.impulse, turned});
    work.add({0, dashpot.impulse.dot(nodes.motion[n].v - 0.5 * nodes.motion[n].change), 0, dashpot.brought, turned});
  }
}

template <int D>
void BoundaryConditions<D>::apply(const Kick& kick, std::span<const ProjectedNodeSum<D>> sums, std::span<ProjectedNodeMotion<D>> hats,
                                  ExactSums<BoundaryWork>& work)
{
  for (const NodeRule& rule : rules_) {
    const auto n = static_cast<std::size_t>(rule.node);
    bool sliding{};
    if (sums[n].is_seen())
      act(rule, kick, sums[n].mass, hats[n].v, hats[n].change, sliding, work);
  }
}

template <int D>
void BoundaryConditions<D>::apply(Index node, const Kick& kick, Real mass, NodeMotion<D>& motion, ExactSums<BoundaryWork>& work)
{
  bool sliding{};
  if (binds(node))
    act(rule_of(node), kick, mass, motion.v, motion.change, sliding, work);
}

template <int D>
void BoundaryConditions<D>::keep_impulses()
{
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    const Impulse by = pushed_[w].value();
    walls_[w].impulse += by.linear, walls_[w].angular += by.angular;
    pushed_[w].clear();
  }
}

template <int D>
Vec<D> BoundaryConditions<D>::constrained(const NodeRule& rule, Real time, const Vec<D>& v) const
{
  if (const Index whole = whole_of(rule); whole != none) {
    const Wall<D>& wall = walls_[static_cast<std::size_t>(whole)];
    return wall.kind == WallKind::velocity ? prescribed(wall, time) : Vec<D>(Vec<D>::Zero());
  }
  Vec<D> held = v;
  for (const Plane& plane : rule.frictions)
    held -= std::max(held.dot(plane.normal), Real{0}) * plane.normal;
  for (const Plane& plane : rule.rollers)
    if (holds(plane))
      held -= held.dot(plane.normal) * plane.normal;
  return held;
}

template <int D>
void BoundaryConditions<D>::hold(Real time, std::span<NodeMotion<D>> remapped) const
{
  for (const NodeRule& rule : rules_) {
    NodeMotion<D>& row = remapped[static_cast<std::size_t>(rule.node)];
    row.v = rule.sliding ? row.change : constrained(rule, time, row.v);
  }
}

template <int D>
Vec<D> BoundaryConditions<D>::held(Index node, Real time, const Vec<D>& v) const
{
  return binds(node) ? constrained(rule_of(node), time, v) : v;
}

template <int D>
std::vector<Facet> BoundaryConditions<D>::closed_facets(const Mesh<D>& mesh) const
{
  std::vector<Facet> closed = facets_;
  const auto whole = [&](Index n) { return binds(n) && (rule_of(n).whole != none || rule_of(n).base != none); };
  for (const Facet facet : mesh.boundary_facets()) {
    const auto nodes = mesh.nodes_of(facet);
    if (std::all_of(nodes.begin(), nodes.end(), whole))
      closed.push_back(facet);
  }
  return closed;
}

template class BoundaryConditions<2>;
template class BoundaryConditions<3>;

}  // namespace talus
