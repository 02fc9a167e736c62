#include "solver/boundary/small_mass_nodes.hpp"

namespace talus {

namespace {

/// Parts of the rows of the nodes that `sends` marks.  Rows of others stay as they are.
template <class Parts>
struct OfMarked {
  Parts parts;
  const std::vector<std::uint8_t>& sends;
  template <class Row>
  bool is_there(const Row&, Index node) const noexcept
  {
    return sends[static_cast<std::size_t>(node)] != 0;
  }
  template <class Row>
  static void clear(const Row&) noexcept
  {}
};
template <class Parts>
OfMarked(Parts, const std::vector<std::uint8_t>&) -> OfMarked<Parts>;

constexpr auto itself = [](auto& row) { return std::tie(row); };

template <int D>
bool takes_part(const NodeSum<D>& sum, const Nodes<D>& nodes) noexcept
{
  return sum.is_seen() && sum.mass > nodes.least_share * sum.lightest && sum.mass > nodes.least_share_of_gross * sum.gross;
}

}  // namespace

template <int D>
SmallMassNodes<D>::SmallMassNodes(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& share, const OwnNodes& own)
    : near_(copies_of_nodes(ranks, share, MessageTag::small_mass_nodes, spread_by_rings(mesh, own.owned, 2)))
{}

template <int D>
template <class F>
void SmallMassNodes<D>::for_each_active_around(const Mesh<D>& mesh, Index node, int ring, F&& f) const
{
  const auto visit = [&](Index n) {
    if (const Real mass = weight_[static_cast<std::size_t>(n)]; mass > 0)
      f(n, mass);
  };
  for (const Index n : mesh.ring_of_node()[node])
    if (ring == 1)
      visit(n);
    else  // a node may be met more than once, which only weighs it
      std::ranges::for_each(mesh.ring_of_node()[n], visit);
}

template <int D>
template <class F>
void SmallMassNodes<D>::for_each_host(const Mesh<D>& mesh, Index small_mass_node, F&& f) const
{
  const auto n = static_cast<std::size_t>(small_mass_node);
  const Real total = -weight_[n];
  if (total > 0)
    for_each_active_around(mesh, small_mass_node, ring_[n], [&](Index host, Real mass) { f(host, mass / total); });
}

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
template <class What, class Rows>
void SmallMassNodes<D>::tell_masters(Rows&& rows, const What& what)
{
  near_.send(
      rows, what, [&](std::size_t border) { return slaves_here_[border] != 0; },
      [&](std::size_t border) { return slaves_there_[border] != 0; });
  near_.take(rows, what);
}

template <int D>
template <class What, class Rows>
void SmallMassNodes<D>::tell_slaves(Rows&& rows, const What& what)
{
  near_.send(
      rows, what, [&](std::size_t border) { return slaves_there_[border] != 0; },
      [&](std::size_t border) { return slaves_here_[border] != 0; });
  near_.take(rows, what);
}

template <int D>
void SmallMassNodes<D>::meet_neighbours(const Mesh<D>& mesh, const Nodes<D>& nodes)
{
  near_.send(ring_, OfMarked{itself, ring_});
  near_.take(ring_, OfMarked{itself, ring_});
  const auto has_small_mass = [&](Index n) { return ring_[static_cast<std::size_t>(n)] != 0; };
  slaves_here_.clear(), slaves_there_.clear();
  asked_.assign(ring_.size(), 0);
  for (const NeighbourRank& border : near_.borders()) {
    slaves_here_.push_back(std::ranges::any_of(border.out, has_small_mass) ? 1 : 0);
    slaves_there_.push_back(std::ranges::any_of(border.in, has_small_mass) ? 1 : 0);
    for (const Index n : border.in)
      if (has_small_mass(n)) {
        slaves_.push_back({n, 0});
        for (const Index between : mesh.ring_of_node()[n])
          for (const Index around : mesh.ring_of_node()[between])
            asked_[static_cast<std::size_t>(around)] = nodes.active[static_cast<std::size_t>(around)];
      }
  }
  tell_slaves(weight_, OfMarked{itself, asked_});
}

namespace {

/// What a slave has for its masters, and what their shares of it are made from.
template <int D>
struct NodeAndHosts {
  NodeSum<D>& sum;
  Real& weight;
  std::uint8_t& ring;
};
template <int D>
struct NodesAndHosts {
  std::vector<NodeSum<D>>& sum;
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
void SmallMassNodes<D>::lump(const Mesh<D>& mesh, const OwnNodes& own, Nodes<D>& nodes)
{
  slaves_.reserve(nodes.sum.size());
  slaves_.clear();
  weight_.resize(nodes.sum.size());
  ring_.resize(nodes.sum.size());
  for (std::size_t n = 0; n < nodes.sum.size(); ++n) {
    const NodeSum<D>& sum = nodes.sum[n];
    nodes.active[n] = takes_part(sum, nodes) ? 1 : 0;
    weight_[n] = nodes.active[n] ? sum.mass : 0;
    ring_[n] = !nodes.active[n] && (sum.is_seen() || !sum.force.isZero(0)) ? 1 : 0;
    if (ring_[n] != 0)
      slaves_.push_back({static_cast<Index>(n), sum.mass});
  }
  const std::size_t n_own = slaves_.size();
  if (!near_.borders().empty())
    meet_neighbours(mesh, nodes);
  for (std::size_t s = 0; s < n_own; ++s)
    weigh_hosts(mesh, slaves_[s].node);
  tell_masters(NodesAndHosts<D>{nodes.sum, weight_, ring_}, OfMarked{[](const auto& row) { return NodesAndHosts<D>::parts(row); }, ring_});
  if (slaves_.size() > n_own)
    std::ranges::sort(slaves_, {}, &Slave::node);
  hand_on(mesh, own, nodes, [](NodeSum<D>& to, Real share, const NodeSum<D>& from) {
    to.mass += share * from.mass;
    to.momentum += share * from.momentum;
    to.force += share * from.force;
  });
}

template <int D>
void SmallMassNodes<D>::lump_momentum(const Mesh<D>& mesh, const OwnNodes& own, Nodes<D>& nodes)
{
  tell_masters(nodes.sum, OfMarked{[](auto& sum) { return NodeSum<D>::momentum_parts(sum); }, ring_});
  hand_on(mesh, own, nodes, [](NodeSum<D>& to, Real share, const NodeSum<D>& from) { to.momentum += share * from.momentum; });
}

template <int D>
template <class F>
void SmallMassNodes<D>::hand_on(const Mesh<D>& mesh, const OwnNodes& own, Nodes<D>& nodes, F&& f) const
{
  for (const Slave& small_mass_node : slaves_)
    for_each_host(mesh, small_mass_node.node, [&](Index host, Real share) {
      if (own.has(host))
        f(nodes.sum[static_cast<std::size_t>(host)], share, nodes.sum[static_cast<std::size_t>(small_mass_node.node)]);
    });
}

template <int D>
void SmallMassNodes<D>::extrapolate(const Mesh<D>& mesh, const OwnNodes& own, const Kick& kick, BoundaryConditions<D>& walls,
                                    std::vector<NodeMotion<D>>& motion, ExactSums<BoundaryWork>& work)
{
  tell_slaves(motion, OfMarked{[](auto& row) { return NodeMotion<D>::parts(row); }, asked_});
  for (const Slave& small_mass_node : slaves_) {
    if (!own.has(small_mass_node.node))
      continue;
    NodeMotion<D> mean;
    for_each_host(mesh, small_mass_node.node, [&](Index host, Real share) {
      mean.v += share * motion[static_cast<std::size_t>(host)].v;
      mean.change += share * motion[static_cast<std::size_t>(host)].change;
    });
    walls.apply(small_mass_node.node, kick, small_mass_node.mass, mean, work);
    motion[static_cast<std::size_t>(small_mass_node.node)] = mean;
  }
}

template <int D>
void SmallMassNodes<D>::extrapolate_velocity(const Mesh<D>& mesh, const OwnNodes& own, const BoundaryConditions<D>& walls, Real mid,
                                             std::vector<NodeMotion<D>>& motion)
{
  tell_slaves(motion, OfMarked{[](auto& row) { return std::tie(row.v); }, asked_});
  for (const Slave& small_mass_node : slaves_) {
    if (!own.has(small_mass_node.node))
      continue;
    Vec<D> mean = Vec<D>::Zero();
    for_each_host(mesh, small_mass_node.node, [&](Index host, Real share) { mean += share * motion[static_cast<std::size_t>(host)].v; });
    motion[static_cast<std::size_t>(small_mass_node.node)].v = walls.held(small_mass_node.node, mid, mean);
  }
}

template class SmallMassNodes<2>;
template class SmallMassNodes<3>;

}  // namespace talus
