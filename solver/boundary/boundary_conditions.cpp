#include "solver/boundary/boundary_conditions.hpp"

#include "solver/boundary/pushed_node.hpp"

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
    rules_.push_back({.node = node, .place = mesh.node(node), .two_sided = {}, .one_sided = {}});
  }
  return rules_[static_cast<std::size_t>(at)];
}

template <int D>
void BoundaryConditions<D>::hold_by(Index condition, const Mesh<D>& mesh, Index node)
{
  Index& holder = rule(mesh, node).holder;
  if (holder == none || kind(condition).index() < kind(holder).index())
    holder = condition;
}

template <int D>
void BoundaryConditions<D>::add(BoundaryCondition<D> condition, const Mesh<D>& mesh, std::span<const Index> nodes)
{
  const auto number = static_cast<Index>(conditions_.size());
  conditions_.push_back(std::move(condition));
  for (const Index n : nodes)
    hold_by(number, mesh, n);
}

template <int D>
void BoundaryConditions<D>::add(BoundaryCondition<D> condition, const Mesh<D>& mesh, std::span<const Facet> facets)
{
  const auto number = static_cast<Index>(conditions_.size());
  conditions_.push_back(std::move(condition));
  facets_.insert(facets_.end(), facets.begin(), facets.end());
  std::visit(
      [&]<class C>(const C& kind) {
        if constexpr (HasDashpots<C>)
          dashpots_.add(mesh, number, kind.dashpots(mesh, facets));
        if constexpr (HoldsNodes<C>)
          for (const Facet facet : facets)
            for (const Index n : mesh.nodes_of(facet))
              hold_by(number, mesh, n);
        if constexpr (ActsOnPlanes<C>)
          add_planes(number, C::two_sided, mesh, facets);
      },
      kind(number));
}

template <int D>
void BoundaryConditions<D>::add_planes(Index condition, bool two_sided, const Mesh<D>& mesh, std::span<const Facet> facets)
{
  for (const Facet facet : facets) {
    const Vec<D> area = mesh.area_vector(facet);
    for (const Index n : mesh.nodes_of(facet)) {
      auto& planes = two_sided ? rule(mesh, n).two_sided : rule(mesh, n).one_sided;
      // until finalize() the normal of a plane is the sum of its area vectors
      const auto same = std::find_if(planes.begin(), planes.end(), [&](const Plane& plane) {
        return plane.normal.dot(area) > smooth * plane.normal.norm() * area.norm();
      });
      if (same != planes.end())
        same->normal += area;
      else
        planes.push_back({condition, area});
    }
  }
}

template <int D>
void BoundaryConditions<D>::restrict_to(const Subdomain& subdomain)
{
  std::erase_if(rules_, [&](NodeRule& rule) {
    rule.node = subdomain.local_node(rule.node);
    rule.counted = rule.node != none && subdomain.owns_node(rule.node);
    return rule.node == none;
  });
  dashpots_.restrict_to(subdomain);
  std::erase_if(facets_, [&](Facet& facet) {
    facet.cell = subdomain.local_cell(facet.cell);
    return facet.cell == none;
  });
  rule_of_node_.assign(subdomain.node.size(), none);
}

template <int D>
void BoundaryConditions<D>::finalize()
{
  pushed_.resize(conditions_.size());
  const auto is_temporary = [&](const Plane& plane) {
    return std::visit([]<class C>(const C&) { return HasDashpots<C>; }, kind(plane.condition));
  };
  for (NodeRule& rule : rules_) {
    for (Plane& plane : rule.one_sided)
      plane.normal.normalize();
    // planes that are released in the dynamic phase come last, so that the others do not depend on them
    std::stable_partition(rule.two_sided.begin(), rule.two_sided.end(), [&](const Plane& plane) { return !is_temporary(plane); });
    std::vector<Plane> basis;  // Gram-Schmidt; a normal that depends on the others adds nothing
    for (Plane plane : rule.two_sided) {
      plane.normal.normalize();
      for (const Plane& other : basis)
        plane.normal -= plane.normal.dot(other.normal) * other.normal;
      if (plane.normal.norm() > 1e-6) {
        plane.normal.normalize();
        basis.push_back(plane);
      }
    }
    rule.two_sided = basis;
  }
  std::sort(rules_.begin(), rules_.end(), [](const NodeRule& a, const NodeRule& b) { return a.node < b.node; });
  for (std::size_t r = 0; r < rules_.size(); ++r)
    rule_of_node_[static_cast<std::size_t>(rules_[r].node)] = static_cast<Index>(r);
}

template <int D>
void BoundaryConditions<D>::begin_stage(bool geostatic, Real time)
{
  if (geostatic) {
    phase_ = {};
    dashpots_.reset();
    for (BoundaryCondition<D>& condition : conditions_)
      std::visit(
          [](auto& kind) {
            if constexpr (requires { kind.reset(); })
              kind.reset();
          },
          condition.kind);
  } else if (!phase_.begun) {
    phase_ = {.begun = true, .begin = time};
  }
}

template <int D>
void BoundaryConditions<D>::advance_columns(Real mid, Real dt)
{
  const auto base_of = [&](Index condition) {
    return std::visit(
        [&]<class C>(const C& below) {
          if constexpr (CarriesColumn<C>)
            return below.column_base(phase_, mid);
          else
            return ColumnBase<D>{};
        },
        kind(condition));
  };
  for (BoundaryCondition<D>& condition : conditions_)
    std::visit(
        [&]<class C>(C& kind) {
          if constexpr (MovesOnBase<C>)
            kind.advance(base_of(kind.base), dt);
        },
        condition.kind);
}

template <int D>
void BoundaryConditions<D>::apply_dashpots(Real mid, Real dt, Communicator& ranks, Nodes<D>& nodes)
{
  if (!phase_.begun || dashpots_.empty())
    return;
  advance_columns(mid, dt);
  dashpots_.apply(conditions_, phase_, mid, ranks, nodes);
}

template <int D>
void BoundaryConditions<D>::push(const NodeRule& rule, std::uint8_t open, const Kick& kick, Real mass, Vec<D>& v, Vec<D>& change,
                                 bool& sliding, ExactSums<BoundaryWork>& work)
{
  const Vec<D> v_old = v - change;
  PushedNode node(rule, kick, mass, v, pushed_);
  const auto act = [&](const Plane& plane) {
    node.condition = plane.condition;
    std::visit(
        [&]<class C>(const C& kind) {
          if constexpr (ActsOnPlanes<C>)
            kind.act(node, plane.normal);
        },
        kind(plane.condition));
  };
  if (is_held(rule)) {
    node.condition = rule.holder;
    std::visit(
        [&]<class C>(const C& kind) {
          if constexpr (HoldsNodes<C>)
            kind.hold(phase_, node);
        },
        kind(rule.holder));
  } else {
    for (int sweep = 0; sweep < (rule.one_sided.empty() ? 1 : sweeps); ++sweep) {
      for (const Plane& plane : rule.two_sided)
        if (!released(plane.condition))
          act(plane);
      node.pushed = false;
      for_each_touched(rule, open, act);
      if (!node.pushed || rule.two_sided.size() + rule.one_sided.size() == 1)
        break;
    }
  }
  v = node.v;
  change = v - v_old;
  sliding = node.sliding;
  const BoundaryWork done = node.finish(v_old);
  if (rule.counted)
    work.add(done);
}

template <int D>
void BoundaryConditions<D>::apply(const Kick& kick, Nodes<D>& nodes, ExactSums<BoundaryWork>& work)
{
  nodes.slides.resize(nodes.sum.size());
  for (const NodeRule& rule : rules_) {
    const auto n = static_cast<std::size_t>(rule.node);
    bool slides = false;
    if (nodes.active[n])
      push(rule, nodes.of_field(rule.node).open, kick, nodes.sum[n].mass, nodes.motion[n].v, nodes.motion[n].change, slides, work);
    nodes.slides[n] = slides ? 1 : 0;
  }
  if (phase_.begun)
    dashpots_.for_each_impulse(nodes, [&](const DashpotImpulse<D>& by) {
      const NodeMotion<D>& motion = nodes.motion[static_cast<std::size_t>(by.node)];
      const Vec3 turned = moment<D>(by.place, by.impulse);
      pushed_[static_cast<std::size_t>(by.condition)].add({by.impulse, turned});
      work.add({0, by.impulse.dot(motion.v - 0.5 * motion.change), 0, by.waves, turned});
    });
}

template <int D>
void BoundaryConditions<D>::apply(const Kick& kick, const Nodes<D>& nodes, std::span<const ProjectedNodeSum<D>> sums,
                                  std::span<ProjectedNodeMotion<D>> projected, Real pic, ExactSums<BoundaryWork>& work)
{
  for (const NodeRule& rule : rules_) {
    const auto n = static_cast<std::size_t>(rule.node);
    bool sliding{};
    if (!sums[n].is_seen())
      continue;
    const std::uint8_t open = nodes.of_field(rule.node).open;
    ProjectedNodeMotion<D> obeying = projected[n];
    const Vec<D> change = obeying.change;
    push(rule, open, kick, 0, obeying.v, obeying.change, sliding, work);  // to see where it leads
    if (obeying.v == projected[n].v)
      continue;
    const Vec<D> pushed = obeying.change - change, own = sums[n].momentum / sums[n].mass + change;
    const Real length = pushed.squaredNorm();  // zero where a change is lost in rounding
    const Real share = length > 0 ? std::clamp<Real>((obeying.v - own).dot(pushed) / length, 0, 1) : 1;
    push(rule, open, kick, (share + pic * (1 - share)) * sums[n].mass, projected[n].v, projected[n].change, sliding, work);
    projected[n].change = change + share * pushed;
  }
}

template <int D>
void BoundaryConditions<D>::apply(NodeOfField at, const Kick& kick, Real mass, NodeMotion<D>& motion, ExactSums<BoundaryWork>& work)
{
  bool sliding{};
  if (binds(at.node))
    push(rule_of(at.node), at.open, kick, mass, motion.v, motion.change, sliding, work);
}

template <int D>
void BoundaryConditions<D>::keep_impulses()
{
  for (std::size_t c = 0; c < conditions_.size(); ++c) {
    const Impulse by = pushed_[c].value();
    conditions_[c].impulse += by.linear, conditions_[c].angular += by.angular;
    pushed_[c].clear();
  }
}

template <int D>
Vec<D> BoundaryConditions<D>::constrained(const NodeRule& rule, std::uint8_t open, Real time, const Vec<D>& v) const
{
  Vec<D> held = v;
  const auto constrain = [&](const Plane& plane) {
    std::visit(
        [&]<class C>(const C& kind) {
          if constexpr (ActsOnPlanes<C>)
            kind.constrain(held, plane.normal);
        },
        kind(plane.condition));
  };
  if (is_held(rule)) {
    std::visit(
        [&]<class C>(const C& kind) {
          if constexpr (HoldsNodes<C>)
            held = kind.velocity(phase_, time);
        },
        kind(rule.holder));
    return held;
  }
  for_each_touched(rule, open, constrain);
  for (const Plane& plane : rule.two_sided)
    if (!released(plane.condition))
      constrain(plane);
  return held;
}

template <int D>
void BoundaryConditions<D>::hold(Real time, Nodes<D>& nodes) const
{
  for (const NodeRule& rule : rules_) {
    const auto n = static_cast<std::size_t>(rule.node);
    NodeMotion<D>& row = nodes.remapped[n];
    row.v = nodes.slides[n] != 0 ? row.change : constrained(rule, nodes.of_field(rule.node).open, time, row.v);
  }
}

template <int D>
Vec<D> BoundaryConditions<D>::held(NodeOfField at, Real time, const Vec<D>& v) const
{
  return binds(at.node) ? constrained(rule_of(at.node), at.open, time, v) : v;
}

template <int D>
auto BoundaryConditions<D>::gap_planes() const -> std::vector<GapPlane>
{
  const auto has_gap = [&](const Plane& plane) {
    return std::visit(
        []<class C>(const C& kind) {
          if constexpr (requires { kind.gap; })
            return kind.gap;
          else
            return false;
        },
        kind(plane.condition));
  };
  std::vector<GapPlane> planes;
  for (const NodeRule& rule : rules_)
    for (std::size_t k = 0; k < std::min(rule.one_sided.size(), std::size_t{8}); ++k)
      if (has_gap(rule.one_sided[k]))
        planes.push_back({rule.node, static_cast<int>(k), rule.one_sided[k].normal});
  return planes;
}

template <int D>
void BoundaryConditions<D>::continue_from(const BoundaryConditions& earlier)
{
  assert(conditions_.size() == earlier.conditions_.size());
  for (std::size_t c = 0; c < conditions_.size(); ++c) {
    conditions_[c].impulse = earlier.conditions_[c].impulse;
    conditions_[c].angular = earlier.conditions_[c].angular;
    std::visit(
        [&]<class C>(C& kind) {
          if constexpr (HasFields<C>) {
            for_each_field<C>([&](const auto& field) { kind.*field.member = std::get<C>(earlier.conditions_[c].kind).*field.member; });
            if (!kind.fits())  // bodies beside it have appeared or vanished
              kind.reset();
          }
        },
        conditions_[c].kind);
  }
  phase_ = earlier.phase_;
  dashpots_.continue_from(earlier.dashpots_);
}

template <int D>
bool BoundaryConditions<D>::fits() const
{
  return dashpots_.fits() && std::all_of(conditions_.begin(), conditions_.end(), [](const BoundaryCondition<D>& condition) {
           return std::visit(
               []<class C>(const C& kind) {
                 if constexpr (HasFields<C>)
                   return kind.fits();
                 else
                   return true;
               },
               condition.kind);
         });
}

template <int D>
std::vector<Facet> BoundaryConditions<D>::closed_facets(const Mesh<D>& mesh) const
{
  std::vector<Facet> closed = facets_;
  const auto is_held_at_rest = [&](Index n) { return holder_of(n) != none; };
  for (const Facet facet : mesh.boundary_facets()) {
    const auto nodes = mesh.nodes_of(facet);
    if (std::all_of(nodes.begin(), nodes.end(), is_held_at_rest))
      closed.push_back(facet);
  }
  return closed;
}

template class BoundaryConditions<2>;
template class BoundaryConditions<3>;

}  // namespace talus
