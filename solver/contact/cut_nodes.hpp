#pragma once
// Nodes of cuts and their twins, and the impulses between them.
#include <span>
#include <vector>

#include "solver/boundary/boundary_conditions.hpp"
#include "solver/contact/cut_law.hpp"
#include "solver/halo/halo_exchange.hpp"
#include "solver/state/owned_nodes.hpp"
#include "solver/state/step_sums.hpp"
#include "solver/strips/particle_strips.hpp"

namespace talus {

/// A node of a cut and its twin on the other side.
template <int D>
struct CutNode {
  Index first, second;
  Index law;                        ///< number of the cut
  Vec<D> normal;                    ///< from the first side to the second, unit length
  Real area;                        ///< of the cut at the node [m^(D-1)]
  bool tied = false;                ///< whether both move as one in this step
  bool touches = false;             ///< whether the sides leave no gap
  bool sticks = false;              ///< whether both have one velocity in this step
  Vec<D> pressed = Vec<D>::Zero();  ///< impulse on the first side along the normal in this step [N s]
  Vec<D> rubbed = Vec<D>::Zero();   ///< impulse on the first side across the normal in this step [N s]
};

/// Lets the sides of cuts act on each other.
///
/// **Normal.**  That of the facets of the cut around the node, weighted by their areas.
///
/// **Gap.**  Each side reaches as far as its particles within two rings of cells do along the normal; see ContactNodes.
///
/// **Impulse.**  Where the sides touch and approach, as between bodies in contact.
///
/// **Tied.**  Both nodes get the sum of their momenta and forces, in shares of their masses, and so the motion of the node that they would
/// be without the cut.
///
/// With several ranks the owners of both nodes compute the same impulses, each for its own node.
template <int D>
class CutNodes {
 public:
  /// Makes room for these cuts of the mesh, which hold for the run.  Collective.
  void begin(const Mesh<D>& mesh, const Subdomain& subdomain, Communicator& ranks, std::span<const CutLaw> laws);
  bool any() const noexcept { return !laws_.empty(); }

  /// Unites the sums of tied nodes in a step that begins at `time` [s] and in which forces act over `kick` [s].  To be called before the
  /// motion is integrated.  Collective.
  void tie(Real time, Real kick, const OwnNodes& own, Nodes<D>& nodes);
  /// Exchanges impulses between the new velocities of nodes.  Boundary conditions act on what changes.  Collective.
  void act(const Mesh<D>& mesh, const Kick& kick, const OwnNodes& own, const ParticleStrips<D>& strips, BoundaryConditions<D>& conditions,
           Nodes<D>& nodes, ExactSums<BoundaryWork>& work);
  /// Makes remapped velocities obey the cuts of this step, as those of bodies in contact do.  Collective.
  void hold(Real time, const OwnNodes& own, const BoundaryConditions<D>& conditions, Nodes<D>& nodes);
  /// Adds the impulses and the work of this step to the sums of each cut, once the motion of nodes is known.
  void add_sums(const Mesh<D>& mesh, const OwnNodes& own, const Nodes<D>& nodes, std::span<ExactSums<ContactSums<D>>> sums) const;
  std::span<const CutNode<D>> nodes() const noexcept { return pairs_; }

 private:
  /// What one node of a pair brings to it.
  struct Half {
    Real mass = 0;          ///< zero if the node does not move by itself [kg]
    Real reach = 0;         ///< of the particles of its side, out of that side [m]
    std::uint8_t open = 0;  ///< see Nodes
    Vec<D> momentum = Vec<D>::Zero(), force = Vec<D>::Zero();
    Vec<D> v = Vec<D>::Zero(), change = Vec<D>::Zero();
  };
  Half& half(Index node) noexcept { return halves_[static_cast<std::size_t>(node)]; }
  const Half& half(Index node) const noexcept { return halves_[static_cast<std::size_t>(node)]; }
  NodeOfField of_field(Index node) const noexcept { return {node, half(node).open}; }
  bool both_move(const CutNode<D>& at) const noexcept { return half(at.first).mass > 0 && half(at.second).mass > 0; }
  void exchange_halves();
  template <class F>
  void for_each_own(const OwnNodes& own, F&& f);
  void find_reach(const Mesh<D>& mesh, const OwnNodes& own, const ParticleStrips<D>& strips);
  void exchange_impulses(CutNode<D>& at, const Kick& kick, BoundaryConditions<D>& conditions, ExactSums<BoundaryWork>& work);

  std::vector<CutLaw> laws_;
  bool all_tied_ = false;          ///< in this step
  std::vector<CutNode<D>> pairs_;  ///< those of which a rank owns a node or has a copy
  std::vector<Half> halves_;       ///< by node
  std::vector<Real> reach_;        ///< by node: how far particles of its side reach along the normal out of that side [m]
  Csr cells_of_side_;              ///< by pair and side: cells within two rings
  HaloExchange copies_;
  ReturnToOwners<Real> back_;
};

}  // namespace talus
