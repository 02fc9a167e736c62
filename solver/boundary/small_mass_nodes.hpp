#pragma once
// What happens to nodes with next to no mass.
#include "solver/boundary/boundary_conditions.hpp"
#include "solver/halo/halo_exchange.hpp"
#include "solver/state/owned_nodes.hpp"

namespace talus {

/// Nodes that particles see with next to no mass, or none, become slaves: their mass, momentum and force go to the active nodes of
/// their ring, in proportion to the masters' masses, and they move with the mean of these.  The map back is the transpose of the map
/// there, so momentum is neither made nor lost, and a uniform motion stays one.  Nodes with negative mass (weights of moving least
/// squares turn negative at the boundary of a mesh) are treated alike.
///
/// A rank treats the nodes it owns.  Where a slave hangs on nodes of another rank, its owner is told their masses, tells in turn what they get,
/// and is told how they move.
template <int D>
class SmallMassNodes {
 public:
  /// Of a rank alone.
  SmallMassNodes() = default;
  /// Every rank has to make one.
  SmallMassNodes(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& share, const OwnNodes& own);

  /// Finds the slaves, sets the active flags of own nodes, hands on mass, momentum and force.
  void lump(const Mesh<D>& mesh, const OwnNodes& own, Nodes<D>& nodes);
  /// Hands on momentum alone, after it was summed anew.
  void lump_momentum(const Mesh<D>& mesh, const OwnNodes& own, Nodes<D>& nodes);
  /// Rows of the slaves: the mean motion of their masters, as the walls allow it, which push the mass that is the slave's own; their
  /// work is added.
  void extrapolate(const Mesh<D>& mesh, const OwnNodes& own, const Kick& kick, BoundaryConditions<D>& walls,
                   std::vector<NodeMotion<D>>& motion, ExactSums<BoundaryWork>& work);
  /// The same for `v` alone.
  void extrapolate_velocity(const Mesh<D>& mesh, const OwnNodes& own, const BoundaryConditions<D>& walls, Real mid,
                            std::vector<NodeMotion<D>>& motion);
  Index size() const noexcept { return static_cast<Index>(slaves_.size()); }

 private:
  struct Slave {
    Index node;
    Real mass;  ///< before anything was handed on [kg]
  };
  /// f(n, mass) for the active nodes in the first or second ring around a node.
  template <class F>
  void for_each_active_around(const Mesh<D>& mesh, Index node, int ring, F&& f) const;
  /// f(master, share) for the active nodes a slave hangs on; nothing if there are none within two rings.
  template <class F>
  void for_each_host(const Mesh<D>& mesh, Index small_mass_node, F&& f) const;
  void weigh_hosts(const Mesh<D>& mesh, Index small_mass_node);
  /// f(master's sum, share, slave's sum) for own masters, slaves in ascending order.
  template <class F>
  void hand_on(const Mesh<D>& mesh, const OwnNodes& own, Nodes<D>& nodes, F&& f) const;
  /// Of slaves near a border: they, and the masses of nodes around them.
  void meet_neighbours(const Mesh<D>& mesh, const Nodes<D>& nodes);
  /// Between owners of slaves and owners of nodes around them, where there are any.
  template <class What, class Rows>
  void tell_masters(Rows&& rows, const What& what);
  template <class What, class Rows>
  void tell_slaves(Rows&& rows, const What& what);

  std::vector<Slave> slaves_;        ///< ascending; own ones, and those of others that may hang on own nodes
  std::vector<Real> weight_;         ///< by node: mass if it is active, minus that of its masters if it is a slave, as they were [kg]
  std::vector<std::uint8_t> ring_;   ///< by node: of slaves, the one in which the masters are: 1 or 2
  std::vector<std::uint8_t> asked_;  ///< by node: within two rings of another rank's slave
  HaloExchange near_;                ///< between nodes within two rings of each other
  std::vector<std::uint8_t> slaves_here_, slaves_there_;  ///< by border
};

extern template class SmallMassNodes<2>;
extern template class SmallMassNodes<3>;

}  // namespace talus
