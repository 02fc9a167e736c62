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

/// A node of small mass, or of none, moves with the linear velocity field that fits its host nodes best, by least squares with their
/// masses: the active nodes beside it and those beside them, each as often as there are ways of two steps to it; where none is beside it,
/// all active nodes within two rings.  (So a body across a gap counts only where no other is near.)  Its mass and force go to them in the same
/// shares, some of which may be negative.  Of its momentum p, with its mass m, a host with the velocity v gets the share of
/// p + m (v - v_fit): no host changes its velocity where p = m v_fit.  So momentum is conserved, and the motion of a rigid or linearly
/// deformed body stays one, where the hosts do not lie too close to a line or a plane for a slope across it.  Nodes of negative mass, which
/// the weights of moving least squares cause at the boundary of a mesh, are treated alike.
///
/// A rank treats the nodes that it owns.  Where hosts of a node belong to another rank, its owner receives their masses and
/// velocities, sends them the fit and what they get, and receives their motion.
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
  void lump_momentum(const OwnNodes& own, Nodes<D>& nodes);
  /// Sets the motion of the nodes of small mass: that of the fit to their hosts, under the boundary conditions, which act on the mass of
  /// the node itself.  Their work is added to `work`.
  void extrapolate(const OwnNodes& own, const Kick& kick, BoundaryConditions<D>& conditions, Nodes<D>& nodes,
                   ExactSums<BoundaryWork>& work);
  /// Sets the velocity `v` only, without work.
  void extrapolate_velocity(const OwnNodes& own, const BoundaryConditions<D>& conditions, Real mid, Nodes<D>& nodes);
  /// Adds allowed(n, vector) of each node of small mass n to the vectors of its hosts, in their shares.
  template <class Allowed>
  void give(const OwnNodes& own, Allowed&& allowed, std::vector<Vec<D>>& vectors);
  /// Sets the vector of each node of small mass n to allowed(n, fit to its hosts): the transpose of give().
  template <class Allowed>
  void take(const OwnNodes& own, Allowed&& allowed, std::vector<Vec<D>>& vectors);
  /// Calls f(host, share) for the hosts of a node of small mass.  Other nodes have none, and it has none if no node within two rings is
  /// active.
  template <class F>
  void for_each_host(Index node, F&& f) const;
  Index size() const noexcept { return static_cast<Index>(small_.size()); }

 private:
  struct Host {
    Index node;
    Real share;
  };
  struct HostRange {
    std::size_t begin, end;
  };
  /// The fit to the hosts of a node of small mass, and what they get.  The share of a host at the distance r with the mass m is
  /// m (level + slope . r) for each way to it.
  struct HostFit {
    Real level{};                      ///< [1/kg]
    Vec<D> slope = Vec<D>::Zero();     ///< [1/(kg m)]
    std::uint64_t beside{};            ///< bits of the active nodes beside it, in the order of its ring, of which 64 count
    Real mass{};                       ///< [kg]
    Vec<D> momentum = Vec<D>::Zero();  ///< momentum less mass times velocity of the fit [kg m/s]
  };
  /// Lists the hosts of a node of small mass by the bits of its fit, ascending, each with its mass times the number of ways to it in the
  /// place of its share.  On a rank that does not own the node, hosts of other ranks may be missing.
  void list_hosts(const Mesh<D>& mesh, std::size_t place);
  /// The hosts of a node of small mass.
  std::span<Host> hosts_of(Index small_mass_node) noexcept;
  /// Finds the fit of a node of small mass to its hosts, before it sets their shares; level 0 if there are none.
  void fit_to_hosts(const Mesh<D>& mesh, Index small_mass_node);
  void set_shares(const Mesh<D>& mesh, Index small_mass_node);
  /// Sets the momentum that hosts get from a node of small mass with this momentum.
  void set_momentum(Index small_mass_node, const Vec<D>& momentum);
  /// Calls f(sum of the host, share, sum of the node) for own hosts, with the nodes of small mass in ascending order.
  template <class F>
  void give_to_hosts(const OwnNodes& own, Nodes<D>& nodes, F&& f) const;
  /// Exchanges which nodes near the border between ranks have small mass, and the masses and velocities of the nodes around them.
  void exchange_neighbours(const Mesh<D>& mesh, const Nodes<D>& nodes);
  /// Exchanges messages between the owners of nodes of small mass and the owners of the nodes around them, where there are any.
  template <class What, class Rows>
  void send_to_hosts(Rows&& rows, const What& what);
  template <class What, class Rows>
  void send_from_hosts(Rows&& rows, const What& what);

  std::vector<Index> small_;                            ///< ascending; own nodes, and those of other ranks that may have own hosts
  std::vector<Host> hosts_;                             ///< of all of them, each with its share
  std::vector<HostRange> ranges_;                       ///< of the hosts of each
  SparseRows<std::size_t> place_;                       ///< by node: of those of small mass, in small_
  std::vector<Real> weight_;                            ///< by node: its mass if it is active, else 0 [kg]
  std::vector<std::uint8_t> is_small_;                  ///< by node
  SparseRows<Vec<D>> velocity_;                         ///< by node: of active ones, before they get anything [m/s]
  SparseRows<HostFit> fits_;                            ///< by node: of those of small mass
  std::vector<std::uint8_t> may_host_;                  ///< by node: active within two rings of a node of small mass of another rank
  HaloExchange near_;                                   ///< between nodes within two rings of each other
  std::vector<std::uint8_t> small_here_, small_there_;  ///< by border: whether there are nodes of small mass on either side
};

template <int D>
template <class F>
void SmallMassNodes<D>::for_each_host(Index node, F&& f) const
{
  const auto n = static_cast<std::size_t>(node);
  if (is_small_[n] != 0)
    for (std::size_t i = ranges_[place_[n]].begin; i < ranges_[place_[n]].end; ++i)
      f(hosts_[i].node, hosts_[i].share);
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
void SmallMassNodes<D>::give(const OwnNodes& own, Allowed&& allowed, std::vector<Vec<D>>& vectors)
{
  for (const Index n : small_)
    if (own.has(n))
      vectors[static_cast<std::size_t>(n)] = allowed(n, vectors[static_cast<std::size_t>(n)]);
  send_to_hosts(vectors, OfMarked{itself, is_small_});
  for (const Index n : small_)
    for_each_host(n, [&](Index host, Real share) {
      if (own.has(host))
        vectors[static_cast<std::size_t>(host)] += share * vectors[static_cast<std::size_t>(n)];
    });
}

template <int D>
template <class Allowed>
void SmallMassNodes<D>::take(const OwnNodes& own, Allowed&& allowed, std::vector<Vec<D>>& vectors)
{
  send_from_hosts(vectors, OfMarked{itself, may_host_});
  for (const Index n : small_) {
    if (!own.has(n))
      continue;
    Vec<D> fitted = Vec<D>::Zero();
    for_each_host(n, [&](Index host, Real share) { fitted += share * vectors[static_cast<std::size_t>(host)]; });
    vectors[static_cast<std::size_t>(n)] = allowed(n, fitted);
  }
}

extern template class SmallMassNodes<2>;
extern template class SmallMassNodes<3>;

}  // namespace talus
