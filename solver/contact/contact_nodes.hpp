#pragma once
// Nodes at which the bodies of two velocity fields touch, and the impulses between them.
#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <vector>

#include "solver/boundary/velocity_field.hpp"
#include "solver/contact/contacts.hpp"
#include "solver/halo/halo_exchange.hpp"
#include "solver/state/step_sums.hpp"
#include "solver/strips/particle_strips.hpp"

namespace talus {

/// A node with mass of two velocity fields.
template <int D>
struct ContactNode {
  Index node;
  Index law;                        ///< number in Contacts::laws
  Vec<D> normal = Vec<D>::Zero();   ///< from the first field to the second, unit length; zero where it is not known
  Real area = 0;                    ///< of the surface between the fields [m^(D-1)]
  bool touches = false;             ///< whether surfaces meet
  bool sticks = false;              ///< whether both fields have one velocity in this step
  Vec<D> pressed = Vec<D>::Zero();  ///< impulse on the first field along the normal in this step [N s]
  Vec<D> rubbed = Vec<D>::Zero();   ///< impulse on the first field across the normal in this step [N s]
};

/// Finds in every step where fields touch, and exchanges impulses there.
///
/// **Normal.**  Particles fill the share phi_n = sum_p N_n(x_p) V_p / int N_n of the linear shape function of node n.  The normal at a node is
/// the direction of the averaged gradient of phi_second - phi_first, so that both fields have the same one.
///
/// **Gap.**  Fields touch at a node if the particles within two rings of cells leave no gap along its normal n:
/// max over the first field of x_p . n + r_p >= min over the second of x_p . n - r_p, with the half width r_p = |F^T n| V0^(1/D) / 2 of a
/// particle.
///
/// **Impulse.**  Where fields touch and approach, they get equal and opposite impulses, which end the approach (a plastic impact of two
/// masses).  Tangential motion ends too unless friction and cohesion carry less.  No impulse attracts.
template <int D>
class ContactNodes {
 public:
  /// Makes room for these contacts, which hold for the run.  Collective.
  void begin(const Mesh<D>& mesh, const Subdomain& subdomain, Communicator& ranks, const Contacts& contacts);
  bool any() const noexcept { return !contacts_.laws.empty(); }

  /// Finds the nodes with mass of two fields, and where their bodies touch.  The sums of nodes are those of this step.  Collective.
  void find(const Mesh<D>& mesh, const OwnNodes& own, const ParticleStrips<D>& strips, std::span<const VelocityField<D>> fields);
  /// Exchanges impulses between the new velocities of nodes.  Boundary conditions act on what changes.
  void act(const Kick& kick, BoundaryConditions<D>& conditions, std::span<VelocityField<D>> fields, ExactSums<BoundaryWork>& work);
  /// Makes remapped velocities obey the contacts of this step: a node that slides keeps the velocity of the step, as at walls.
  void hold(Real time, const BoundaryConditions<D>& conditions, std::span<VelocityField<D>> fields) const;
  /// Adds the impulses and the work of this step to the sums of each law, once the motion of nodes is known.
  void add_sums(const Mesh<D>& mesh, std::span<const VelocityField<D>> fields, std::span<ExactSums<ContactSums<D>>> sums) const;
  std::span<const ContactNode<D>> nodes() const noexcept { return nodes_; }

 private:
  using Corners = std::array<Real, D + 1>;
  /// What particles of a field fill at the vertices of a cell [m^D].
  struct CellVolumes {
    Corners of{};
    bool is_seen() const noexcept
    {
      return std::ranges::any_of(of, [](Real volume) { return volume != 0; });
    }
    template <class Self>
    static auto parts(Self& volumes) noexcept
    {
      return std::tie(volumes.of);
    }
  };
  /// Sums over the cells around a node, weighted by volume and the fillings of both fields: gradients of these fillings.
  struct NodeGradients {
    Real weight = 0;
    Real area = 0;  ///< of the surface between the fields at the node, as a share of each candidate around [m^(D-1)]
    Vec<D> first = Vec<D>::Zero(), second = Vec<D>::Zero();
  };
  /// How far the particles of both fields reach along a normal, from the node [m].
  struct Reach {
    Real first, second;
  };

  void find_candidates(const OwnNodes& own, std::span<const VelocityField<D>> fields);
  void mark_cells(const Mesh<D>& mesh);
  void sum_volumes(const Mesh<D>& mesh, const ParticleStrips<D>& strips);
  void find_normals(const Mesh<D>& mesh);
  void find_normals_of(const Mesh<D>& mesh, std::size_t law);
  void find_reach(const Mesh<D>& mesh, const ParticleStrips<D>& strips);

  Contacts contacts_;
  std::vector<ContactNode<D>> nodes_;  ///< own ones, by law and node
  HaloExchange copies_, cells_;
  ReturnToOwners<Reach> back_;
  std::vector<std::vector<std::uint8_t>> candidate_;  ///< by law and node
  std::vector<std::vector<Vec<D>>> normal_;           ///< by law and node
  std::vector<std::vector<Reach>> reach_;             ///< by law and node
  std::vector<Real> hats_;                            ///< volume of the linear shape functions [m^D]
  std::vector<std::vector<CellVolumes>> volumes_;     ///< by field and cell
  std::vector<NodeGradients> gradients_;              ///< by node, of one law at a time
  std::vector<std::vector<Real>> fill_;               ///< by field and node
  std::vector<std::uint8_t> ring_;                    ///< by node: rings from a candidate plus 1, 0 beyond
  std::vector<Index> near_nodes_;                     ///< candidates, then the nodes within two rings of them
  std::size_t n_candidates_ = 0;
  std::vector<Index> marked_;               ///< cells around these
  std::vector<std::uint8_t> is_marked_;     ///< by cell
  std::vector<std::vector<Index>> bodies_;  ///< of each field
};

}  // namespace talus
