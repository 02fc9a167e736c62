#include "solver/boundary/small_mass_nodes.hpp"

namespace talus {

template <int D>
SmallMassNodes<D>::SmallMassNodes(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& subdomain, const OwnNodes& own)
    : near_(copies_of_nodes(ranks, subdomain, MessageTag::small_mass_nodes, spread_by_rings(mesh, own.owned, 2)))
{}

template <int D>
void SmallMassNodes<D>::weigh_hosts(const Mesh<D>& mesh, Index small_mass_node)
{
  const auto n = static_cast<std::size_t>(small_mass_node);
  Real total = 0;
  for (std::uint8_t ring = 1; ring <= 2 && !(total > 0); ++ring) {
    ring_[n] = ring;
    for_each_active_around(mesh, small_mass_node, ring, [&](Index, Real mass) { total += mass; });
  }
  weight_[n] = -total;
}

template <int D>
void SmallMassNodes<D>::exchange_neighbours(const Mesh<D>& mesh, const Nodes<D>& nodes)
{
  near_.send(ring_, OfMarked{itself, ring_});
  near_.take(ring_, OfMarked{itself, ring_});
  const auto has_small_mass = [&](Index n) { return ring_[static_cast<std::size_t>(n)] != 0; };
  small_here_.clear(), small_there_.clear();
  may_host_.assign(ring_.size(), 0);
  for (const NeighbourRank& border : near_.borders()) {
    small_here_.push_back(std::ranges::any_of(border.out, has_small_mass) ? 1 : 0);
    small_there_.push_back(std::ranges::any_of(border.in, has_small_mass) ? 1 : 0);
    for (const Index n : border.in)
      if (has_small_mass(n)) {
        small_.push_back({n, 0});
        for (const Index between : mesh.ring_of_node()[n])
          for (const Index around : mesh.ring_of_node()[between])
            may_host_[static_cast<std::size_t>(around)] = nodes.active[static_cast<std::size_t>(around)];
      }
  }
  send_from_hosts(weight_, OfMarked{itself, may_host_});
}

namespace {

/// The data that a node of small mass gives to its hosts, and from which their shares are computed.
template <int D>
struct NodeAndHosts {
  NodeSum<D>& sum;
  Real& weight;
  std::uint8_t& ring;
};
template <int D>
struct NodesAndHosts {
  SparseRows<NodeSum<D>>& sum;
  std::vector<Real>& weight;
  std::vector<std::uint8_t>& ring;
  NodeAndHosts<D> operator[](std::size_t n) const noexcept { return {sum[n], weight[n], ring[n]}; }

  template <int E>
  static auto parts(const NodeAndHosts<E>& row) noexcept
  {
    return std::tie(row.sum.mass, row.sum.momentum, row.sum.force, row.weight, row.ring);
  }
};

}  // namespace

template <int D>
void SmallMassNodes<D>::lump(const Mesh<D>& mesh, const OwnNodes& own, Nodes<D>& nodes, ActiveNodes which)
{
  small_.reserve(nodes.sum.size());
  small_.clear();
  weight_.resize(nodes.sum.size());
  ring_.resize(nodes.sum.size());
  for (const NeighbourRank& border : near_.borders())
    for (const Index n : border.in)  // which may be in use on another rank alone
      ring_[static_cast<std::size_t>(n)] = 0, weight_[static_cast<std::size_t>(n)] = 0;
  nodes.in_use.for_each_ascending([&](Index node) {
    const auto n = static_cast<std::size_t>(node);
    const NodeSum<D>& sum = nodes.sum[n];
    if (which == ActiveNodes::by_mass)
      nodes.active[n] = has_own_motion(sum, nodes) ? 1 : 0;
    weight_[n] = nodes.active[n] ? sum.mass : 0;
    ring_[n] = !nodes.active[n] && (sum.is_seen() || !sum.force.isZero(0)) ? 1 : 0;
    if (ring_[n] != 0)
      small_.push_back({node, sum.mass});
  });
  const std::size_t n_own = small_.size();
  if (!near_.borders().empty())
    exchange_neighbours(mesh, nodes);
  for (std::size_t s = 0; s < n_own; ++s)
    weigh_hosts(mesh, small_[s].node);
  send_to_hosts(NodesAndHosts<D>{nodes.sum, weight_, ring_}, OfMarked{[](const auto& row) { return NodesAndHosts<D>::parts(row); }, ring_});
  if (small_.size() > n_own)
    std::ranges::sort(small_, {}, &SmallMassNode::node);
  give_to_hosts(mesh, own, nodes, [](NodeSum<D>& to, Real share, const NodeSum<D>& from) {
    to.mass += share * from.mass;
    to.momentum += share * from.momentum;
    to.force += share * from.force;
  });
}

template <int D>
void SmallMassNodes<D>::lump_momentum(const Mesh<D>& mesh, const OwnNodes& own, Nodes<D>& nodes)
{
  send_to_hosts(nodes.sum, OfMarked{[](auto& sum) { return NodeSum<D>::momentum_parts(sum); }, ring_});
  give_to_hosts(mesh, own, nodes, [](NodeSum<D>& to, Real share, const NodeSum<D>& from) { to.momentum += share * from.momentum; });
}

template <int D>
template <class F>
void SmallMassNodes<D>::give_to_hosts(const Mesh<D>& mesh, const OwnNodes& own, Nodes<D>& nodes, F&& f) const
{
  for (const SmallMassNode& small_mass_node : small_)
    for_each_host(mesh, small_mass_node.node, [&](Index host, Real share) {
      if (own.has(host))
        f(nodes.sum[static_cast<std::size_t>(host)], share, nodes.sum[static_cast<std::size_t>(small_mass_node.node)]);
    });
}

template <int D>
void SmallMassNodes<D>::extrapolate(const Mesh<D>& mesh, const OwnNodes& own, const Kick& kick, BoundaryConditions<D>& conditions,
                                    Nodes<D>& nodes, ExactSums<BoundaryWork>& work)
{
  SparseRows<NodeMotion<D>>& motion = nodes.motion;
  send_from_hosts(motion, OfMarked{[](auto& row) { return NodeMotion<D>::parts(row); }, may_host_});
  for (const SmallMassNode& small_mass_node : small_) {
    if (!own.has(small_mass_node.node))
      continue;
    NodeMotion<D> mean;
    for_each_host(mesh, small_mass_node.node, [&](Index host, Real share) {
      mean.v += share * motion[static_cast<std::size_t>(host)].v;
      mean.change += share * motion[static_cast<std::size_t>(host)].change;
    });
    conditions.apply(nodes.of_field(small_mass_node.node), kick, small_mass_node.mass, mean, work);
    motion[static_cast<std::size_t>(small_mass_node.node)] = mean;
  }
}

template <int D>
void SmallMassNodes<D>::extrapolate_velocity(const Mesh<D>& mesh, const OwnNodes& own, const BoundaryConditions<D>& conditions, Real mid,
                                             Nodes<D>& nodes)
{
  SparseRows<NodeMotion<D>>& motion = nodes.remapped;
  send_from_hosts(motion, OfMarked{[](auto& row) { return std::tie(row.v); }, may_host_});
  for (const SmallMassNode& small_mass_node : small_) {
    if (!own.has(small_mass_node.node))
      continue;
    Vec<D> mean = Vec<D>::Zero();
    for_each_host(mesh, small_mass_node.node, [&](Index host, Real share) { mean += share * motion[static_cast<std::size_t>(host)].v; });
    motion[static_cast<std::size_t>(small_mass_node.node)].v = conditions.held(nodes.of_field(small_mass_node.node), mid, mean);
  }
}

template class SmallMassNodes<2>;
template class SmallMassNodes<3>;

}  // namespace talus
