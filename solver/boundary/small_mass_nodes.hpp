#pragma once
// Nodes whose mass is too small for a motion of their own.
#include "solver/boundary/boundary_conditions.hpp"
#include "solver/halo/halo_exchange.hpp"
#include "solver/state/owned_nodes.hpp"

namespace talus {

/// Whether a node with this sum has enough mass for a motion of its own.
template <int D>
bool has_own_motion(const NodeSum<D>& sum, const Nodes<D>& nodes) noexcept
{
  return sum.is_seen() && sum.mass > nodes.least_share * sum.lightest && sum.mass > nodes.least_share_of_gross * sum.gross;
}

/// Which nodes have a motion of their own: those with enough mass, or those that had one before, in trials of one increment.
enum class ActiveNodes : std::uint8_t { by_mass, as_before };

/// The mass, momentum and force of a node of small mass, or of none, go to its host nodes: the active nodes of its first ring, or else of its
/// second ring, in proportion to their masses.  It moves with the mean velocity of its hosts.  Because one map is the transpose of the
/// other, momentum is conserved, and a uniform motion stays uniform.  Nodes of negative mass, which the weights of moving least squares
/// cause at the boundary of a mesh, are treated alike.
///
/// A rank treats the nodes that it owns.  Where hosts of a node belong to another rank, its owner receives their masses, sends them their
/// shares and receives their motion.
template <int D>
class SmallMassNodes {
 public:
  /// Construction for a single rank.
  SmallMassNodes() = default;
  /// Construction for one of several ranks.  Collective.
  SmallMassNodes(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& subdomain, const OwnNodes& own);

  /// Finds the nodes of small mass, sets the active flags of own nodes, and gives mass, momentum and force to the hosts.
  void lump(const Mesh<D>& mesh, const OwnNodes& own, Nodes<D>& nodes, ActiveNodes which = ActiveNodes::by_mass);
  /// Gives only the momentum to the hosts, after it was summed again.
  void lump_momentum(const Mesh<D>& mesh, const OwnNodes& own, Nodes<D>& nodes);
  /// Sets the motion of the nodes of small mass: the mean motion of their hosts, under the boundary conditions, which act on the mass of
  /// the node itself.  Their work is added to `work`.
  void extrapolate(const Mesh<D>& mesh, const OwnNodes& own, const Kick& kick, BoundaryConditions<D>& conditions, Nodes<D>& nodes,
                   ExactSums<BoundaryWork>& work);
  /// Sets the velocity `v` only, without work.
  void extrapolate_velocity(const Mesh<D>& mesh, const OwnNodes& own, const BoundaryConditions<D>& conditions, Real mid, Nodes<D>& nodes);
  /// Adds allowed(n, vector) of each node of small mass n to the vectors of its hosts, in their shares.
  template <class Allowed>
  void give(const Mesh<D>& mesh, const OwnNodes& own, Allowed&& allowed, std::vector<Vec<D>>& vectors);
  /// Sets the vector of each node of small mass n to allowed(n, mean of its hosts): the transpose of give().
  template <class Allowed>
  void take(const Mesh<D>& mesh, const OwnNodes& own, Allowed&& allowed, std::vector<Vec<D>>& vectors);
  /// Calls f(host, share) for the hosts of a node of small mass; there are none if no node within two rings is active.
  template <class F>
  void for_each_host(const Mesh<D>& mesh, Index small_mass_node, F&& f) const;
  Index size() const noexcept { return static_cast<Index>(small_.size()); }

 private:
  struct SmallMassNode {
    Index node;
    Real mass;  ///< mass before it was given to the hosts [kg]
  };
  /// Calls f(n, mass) for the active nodes of the first or second ring around a node.
  template <class F>
  void for_each_active_around(const Mesh<D>& mesh, Index node, int ring, F&& f) const;
  void weigh_hosts(const Mesh<D>& mesh, Index small_mass_node);
  /// Calls f(sum of the host, share, sum of the node) for own hosts, with the nodes of small mass in ascending order.
  template <class F>
  void give_to_hosts(const Mesh<D>& mesh, const OwnNodes& own, Nodes<D>& nodes, F&& f) const;
  /// Exchanges which nodes near the border between ranks have small mass, and the masses of the nodes around them.
  void exchange_neighbours(const Mesh<D>& mesh, const Nodes<D>& nodes);
  /// Exchanges messages between the owners of nodes of small mass and the owners of the nodes around them, where there are any.
  template <class What, class Rows>
  void send_to_hosts(Rows&& rows, const What& what);
  template <class What, class Rows>
  void send_from_hosts(Rows&& rows, const What& what);

  std::vector<SmallMassNode> small_;    ///< ascending; own nodes, and those of other ranks that may have own hosts
  std::vector<Real> weight_;            ///< by node: its mass if it is active, minus the mass of its hosts if its mass is small [kg]
  std::vector<std::uint8_t> ring_;      ///< by node: the ring of its hosts, 1 or 2; 0 unless its mass is small
  std::vector<std::uint8_t> may_host_;  ///< by node: active within two rings of a node of small mass of another rank
  HaloExchange near_;                   ///< between nodes within two rings of each other
  std::vector<std::uint8_t> small_here_, small_there_;  ///< by border: whether there are nodes of small mass on either side
};

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
    else  // a node may be visited more than once, which increases its weight
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
template <class What, class Rows>
void SmallMassNodes<D>::send_to_hosts(Rows&& rows, const What& what)
{
  near_.send(
      rows, what, [&](std::size_t border) { return small_here_[border] != 0; },
      [&](std::size_t border) { return small_there_[border] != 0; });
  near_.take(rows, what);
}

template <int D>
template <class What, class Rows>
void SmallMassNodes<D>::send_from_hosts(Rows&& rows, const What& what)
{
  near_.send(
      rows, what, [&](std::size_t border) { return small_there_[border] != 0; },
      [&](std::size_t border) { return small_here_[border] != 0; });
  near_.take(rows, what);
}

template <int D>
template <class Allowed>
void SmallMassNodes<D>::give(const Mesh<D>& mesh, const OwnNodes& own, Allowed&& allowed, std::vector<Vec<D>>& vectors)
{
  for (const SmallMassNode& one : small_)
    if (own.has(one.node))
      vectors[static_cast<std::size_t>(one.node)] = allowed(one.node, vectors[static_cast<std::size_t>(one.node)]);
  send_to_hosts(vectors, OfMarked{itself, ring_});
  for (const SmallMassNode& one : small_)
    for_each_host(mesh, one.node, [&](Index host, Real share) {
      if (own.has(host))
        vectors[static_cast<std::size_t>(host)] += share * vectors[static_cast<std::size_t>(one.node)];
    });
}

template <int D>
template <class Allowed>
void SmallMassNodes<D>::take(const Mesh<D>& mesh, const OwnNodes& own, Allowed&& allowed, std::vector<Vec<D>>& vectors)
{
  send_from_hosts(vectors, OfMarked{itself, may_host_});
  for (const SmallMassNode& one : small_) {
    if (!own.has(one.node))
      continue;
    Vec<D> mean = Vec<D>::Zero();
    for_each_host(mesh, one.node, [&](Index host, Real share) { mean += share * vectors[static_cast<std::size_t>(host)]; });
    vectors[static_cast<std::size_t>(one.node)] = allowed(one.node, mean);
  }
}

extern template class SmallMassNodes<2>;
extern template class SmallMassNodes<3>;

}  // namespace talus
