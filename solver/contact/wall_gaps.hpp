#pragma once
// Where material touches walls with gaps.
#include <span>
#include <vector>

#include "solver/boundary/velocity_field.hpp"
#include "solver/halo/halo_exchange.hpp"
#include "solver/strips/particle_strips.hpp"

namespace talus {

/// Finds in every step which planes of walls no material touches: a wall with a gap acts on a velocity field at a node if a particle of it in
/// the cells around the node reaches the plane, beside the node by at most half a mean edge.  See ContactNodes for the reach of a particle.
template <int D>
class WallGaps {
 public:
  /// Makes room for the walls of these conditions.  Collective.
  void begin(const Mesh<D>& mesh, const Subdomain& subdomain, Communicator& ranks, const BoundaryConditions<D>& conditions,
             const std::vector<std::vector<Index>>& groups_of_field, std::span<VelocityField<D>> fields);
  /// Sets the open planes of the nodes of all fields.  Collective.
  void find(const Mesh<D>& mesh, const ParticleStrips<D>& strips, std::span<VelocityField<D>> fields);

 private:
  bool any_ = false;  ///< on some rank
  std::vector<std::vector<Index>> groups_of_field_;
  std::vector<typename BoundaryConditions<D>::GapPlane> planes_;  ///< by node
  std::vector<std::uint8_t> touched_;                             ///< of one field at a time, by plane
  HaloExchange copies_;
  ReturnToOwners<std::uint8_t> back_;
};

}  // namespace talus
