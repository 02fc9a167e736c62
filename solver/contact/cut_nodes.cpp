#include "solver/contact/cut_nodes.hpp"

#include <limits>

#include "solver/contact/exchange.hpp"
#include "solver/strips/particles_in_cell.hpp"

namespace talus {

namespace {

constexpr Real unlimited = std::numeric_limits<Real>::infinity();

/// The cells within two rings of each node of a pair, not around the tips of cuts, where both sides are one.
template <int D>
Csr cells_of_sides(const Mesh<D>& mesh)
{
  Csr all;
  all.begin.assign(1, 0);
  std::vector<Index> cells;
  for (const NodePair<D>& pair : mesh.cuts().pairs)
    for (const Index n : {pair.first, pair.second}) {
      cells.clear();
      for (const Index m : mesh.ring_of_node()[n])
        if (!std::ranges::binary_search(mesh.cuts().tips, m))
          cells.insert(cells.end(), mesh.cells_of_node()[m].begin(), mesh.cells_of_node()[m].end());
      std::ranges::sort(cells);
      cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
      all.item.insert(all.item.end(), cells.begin(), cells.end());
      all.begin.push_back(static_cast<Index>(all.item.size()));
    }
  return all;
}

}  // namespace

template <int D>
void CutNodes<D>::begin(const Mesh<D>& mesh, const Subdomain& subdomain, Communicator& ranks, std::span<const CutLaw> laws)
{
  laws_.assign(laws.begin(), laws.end());
  if (laws.empty())
    return;
  const auto n_nodes = static_cast<std::size_t>(mesh.n_nodes());
  std::vector<std::uint8_t> in_pair(n_nodes, 0);
  pairs_.clear();
  for (const NodePair<D>& pair : mesh.cuts().pairs) {
    pairs_.push_back({.first = pair.first, .second = pair.second, .law = pair.cut, .normal = pair.area.normalized(), .area = pair.measure});
    in_pair[static_cast<std::size_t>(pair.first)] = in_pair[static_cast<std::size_t>(pair.second)] = 1;
  }
  halves_.assign(n_nodes, {});
  reach_.assign(n_nodes, nowhere);
  cells_of_side_ = cells_of_sides(mesh);
  if (subdomain.alone())
    return;
  copies_ = copies_of_nodes(ranks, subdomain, MessageTag::cut_nodes, in_pair);
  back_ = ReturnToOwners<Real>(ranks, MessageTag::cut_reach, copies_, nowhere);
}

template <int D>
void CutNodes<D>::exchange_halves()
{
  copies_.send(halves_, Numbers{});
  copies_.take(halves_, Numbers{});
}

/// Calls f(node) for the own nodes of pairs.
template <int D>
template <class F>
void CutNodes<D>::for_each_own(const OwnNodes& own, F&& f)
{
  for (const CutNode<D>& at : pairs_)
    for (const Index n : {at.first, at.second})
      if (own.has(n))
        f(n);
}

template <int D>
void CutNodes<D>::tie(Real time, Real kick, const OwnNodes& own, Nodes<D>& nodes)
{
  if (!any())
    return;
  for_each_own(own, [&](Index n) {
    const auto i = static_cast<std::size_t>(n);
    Half& mine = halves_[i] = {};
    if (nodes.active[i] != 0)
      mine.mass = nodes.sum[i].mass, mine.momentum = nodes.sum[i].momentum, mine.force = nodes.sum[i].force;
  });
  exchange_halves();
  all_tied_ = std::ranges::all_of(laws_, [&](const CutLaw& law) { return time < law.tied_until; });
  for (CutNode<D>& at : pairs_) {
    at.pressed.setZero(), at.rubbed.setZero();
    at.tied = time < laws_[static_cast<std::size_t>(at.law)].tied_until;
    at.touches = at.sticks = false;
    if (!at.tied || !both_move(at))
      continue;
    Half &first = half(at.first), &second = half(at.second);
    const Real mass = first.mass + second.mass;
    const Vec<D> momentum = first.momentum + second.momentum, force = first.force + second.force, before = first.force;
    for (Half* one : {&first, &second})
      one->momentum = one->mass / mass * momentum, one->force = one->mass / mass * force;
    const Vec<D> impulse = kick * (first.force - before);
    at.pressed = impulse.dot(at.normal) * at.normal, at.rubbed = impulse - at.pressed;
    for (const Index n : {at.first, at.second})
      if (own.has(n))
        nodes.sum[static_cast<std::size_t>(n)].momentum = half(n).momentum, nodes.sum[static_cast<std::size_t>(n)].force = half(n).force;
  }
}

template <int D>
void CutNodes<D>::find_reach(const Mesh<D>& mesh, const OwnNodes& own, const ParticleStrips<D>& strips)
{
  std::vector<Index> bodies(strips.keys() / std::max(to_size(strips.blocks()), std::size_t{1}));
  std::iota(bodies.begin(), bodies.end(), Index{0});
  parallel_for_uneven(static_cast<Index>(2 * pairs_.size()), [&](Index k) {
    const CutNode<D>& at = pairs_[static_cast<std::size_t>(k / 2)];
    const Index n = k % 2 == 0 ? at.first : at.second;
    const Vec<D> outwards = k % 2 == 0 ? at.normal : Vec<D>(-at.normal);
    reach_[static_cast<std::size_t>(n)] = reach_beside<D>(strips, bodies, cells_of_side_[k], mesh.node(n), outwards, mesh.node_size(n) / 2);
  });
  back_(reach_, Numbers{}, [](Real& reach, Real other) { reach = std::max(reach, other); });
  for_each_own(own, [&](Index n) { half(n).reach = reach_[static_cast<std::size_t>(n)]; });
}

template <int D>
void CutNodes<D>::exchange_impulses(CutNode<D>& at, const Kick& kick, BoundaryConditions<D>& conditions, ExactSums<BoundaryWork>& work)
{
  const CutLaw& law = laws_[static_cast<std::size_t>(at.law)];
  Half &first = half(at.first), &second = half(at.second);
  const auto side = [&](Index n) { return Side<D>{conditions, of_field(n), kick.to, half(n).mass, half(n).v}; };
  const Vec<D> relative = first.v - second.v;
  Exchange<D> by;
  if (!at.tied)
    by = exchange(side(at.first), side(at.second), at.normal,
                  [&](Real pressure) { return law.friction * pressure + law.cohesion * at.area * kick.length(); });
  else if (relative.norm() > 0)  // what conditions left, or round-off
    by = exchange(side(at.first), side(at.second), Vec<D>(relative.normalized()), [](Real) { return unlimited; });
  if (by.pressed.isZero(0))
    return;
  const Vec<D> impulse = by.pressed + by.rubbed;
  if (at.tied) {
    const Vec<D> along = impulse.dot(at.normal) * at.normal;
    at.pressed += along, at.rubbed += impulse - along;
  } else {
    at.pressed = by.pressed, at.rubbed = by.rubbed, at.sticks = by.sticks;
  }
  const auto push = [&](Index n, const Vec<D>& given) {
    Half& one = half(n);
    const Vec<D> change = given / one.mass;
    NodeMotion<D> motion{one.v + change, one.change + change};
    conditions.apply(of_field(n), kick, one.mass, motion, work);
    one.v = motion.v, one.change = motion.change;
  };
  push(at.first, impulse);
  push(at.second, -impulse);
}

template <int D>
void CutNodes<D>::act(const Mesh<D>& mesh, const Kick& kick, const OwnNodes& own, const ParticleStrips<D>& strips,
                      BoundaryConditions<D>& conditions, Nodes<D>& nodes, ExactSums<BoundaryWork>& work)
{
  if (!any())
    return;
  if (!all_tied_)
    find_reach(mesh, own, strips);
  for_each_own(own, [&](Index n) {
    half(n).v = nodes.motion[static_cast<std::size_t>(n)].v, half(n).change = nodes.motion[static_cast<std::size_t>(n)].change;
    half(n).open = nodes.of_field(n).open;
  });
  exchange_halves();
  for (CutNode<D>& at : pairs_) {
    if (!both_move(at) || (!own.has(at.first) && !own.has(at.second)))
      continue;
    at.touches = half(at.first).reach + half(at.second).reach >= 0;
    if (!at.tied && !at.touches)
      continue;
    exchange_impulses(at, kick, conditions, work);
    for (const Index n : {at.first, at.second})
      if (own.has(n))
        nodes.motion[static_cast<std::size_t>(n)].v = half(n).v, nodes.motion[static_cast<std::size_t>(n)].change = half(n).change;
  }
}

template <int D>
void CutNodes<D>::hold(Real time, const OwnNodes& own, const BoundaryConditions<D>& conditions, Nodes<D>& nodes)
{
  if (!any())
    return;
  for_each_own(own, [&](Index n) {
    half(n).v = nodes.remapped[static_cast<std::size_t>(n)].v, half(n).change = nodes.remapped[static_cast<std::size_t>(n)].change;
  });
  exchange_halves();
  for (const CutNode<D>& at : pairs_) {
    if (!both_move(at) || (!own.has(at.first) && !own.has(at.second)) || (!at.tied && at.pressed.isZero(0)))
      continue;
    const Half &first = half(at.first), &second = half(at.second);
    const auto keep = [&](Index n, const Vec<D>& v) {
      if (own.has(n))
        nodes.remapped[static_cast<std::size_t>(n)].v = v;
    };
    if (!at.tied && !at.sticks && !at.rubbed.isZero(0)) {  // a node that slides keeps the velocity of the step, as at walls
      keep(at.first, first.change);
      keep(at.second, second.change);
      continue;
    }
    Vec<D> v_first = first.v, v_second = second.v;
    if (at.tied) {
      v_first = v_second = (first.mass * first.v + second.mass * second.v) / (first.mass + second.mass);
    } else {
      const auto side = [&](Index n) { return Side<D>{conditions, of_field(n), time, half(n).mass, half(n).v}; };
      const Exchange<D> by = exchange(side(at.first), side(at.second), at.normal, [&](Real) { return at.sticks ? unlimited : 0; });
      const Vec<D> impulse = by.pressed + by.rubbed;
      v_first += impulse / first.mass, v_second -= impulse / second.mass;
    }
    keep(at.first, conditions.held(of_field(at.first), time, v_first));
    keep(at.second, conditions.held(of_field(at.second), time, v_second));
  }
}

template <int D>
void CutNodes<D>::add_sums(const Mesh<D>& mesh, const OwnNodes& own, const Nodes<D>& nodes, std::span<ExactSums<ContactSums<D>>> sums) const
{
  for (const CutNode<D>& at : pairs_) {
    if (at.pressed.isZero(0) && at.rubbed.isZero(0))
      continue;
    ExactSums<ContactSums<D>>& sum = sums[static_cast<std::size_t>(at.law)];
    const auto mean_velocity = [&](Index n) -> Vec<D> {
      const NodeMotion<D>& motion = nodes.motion[static_cast<std::size_t>(n)];
      return motion.v - 0.5 * motion.change;
    };
    const Vec<D> impulse = at.pressed + at.rubbed;
    if (own.has(at.first)) {
      const Vec<D> v = mean_velocity(at.first);
      sum.add({impulse, moment<D>(mesh.node(at.first), impulse), at.pressed.dot(v), at.rubbed.dot(v)});
    }
    if (own.has(at.second)) {
      const Vec<D> v = mean_velocity(at.second);
      sum.add({Vec<D>::Zero(), Vec3::Zero(), -at.pressed.dot(v), -at.rubbed.dot(v)});
    }
  }
}

template class CutNodes<2>;
template class CutNodes<3>;

}  // namespace talus
