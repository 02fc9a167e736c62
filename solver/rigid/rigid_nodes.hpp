#pragma once
// Nodes at which material touches rigid bodies, and the impulses between both.
#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "solver/boundary/velocity_field.hpp"
#include "solver/halo/halo_exchange.hpp"
#include "solver/rigid/sheets.hpp"
#include "solver/strips/particle_strips.hpp"

namespace talus {

/// Where a particle touches a rigid body.
template <int D>
struct Touch {
  Real gap = std::numeric_limits<Real>::infinity();  ///< between both surfaces [m], <= 0; infinite where nothing touches
  Vec<D> normal = Vec<D>::Zero();                    ///< out of the rigid body, unit length
  Vec<D> place = Vec<D>::Zero();                     ///< on its surface [m]
  Mat<D> affine_field = Mat<D>::Zero();              ///< of the particle [1/s]
  bool is_seen() const noexcept { return gap <= 0; }
  /// The deeper one of two; of equally deep ones that with the smaller numbers of place, normal, then field, so that their order does not matter.
  friend bool operator<(const Touch& a, const Touch& b) noexcept
  {
    if (a.gap != b.gap)
      return a.gap < b.gap;
    if (a.place != b.place)
      return std::ranges::lexicographical_compare(a.place, b.place);
    if (a.normal != b.normal)
      return std::ranges::lexicographical_compare(a.normal, b.normal);
    return std::ranges::lexicographical_compare(a.affine_field.reshaped(), b.affine_field.reshaped());
  }
  template <class Self>
  static auto parts(Self& self) noexcept
  {
    return std::tie(self.gap, self.normal, self.place, self.affine_field);
  }
};

/// A node with mass of a velocity field that touches a rigid body.
template <int D>
struct RigidNode {
  Index rigid, field, node;
  Touch<D> touch;                  ///< the deepest one beside it
  Vec<D> offset = Vec<D>::Zero();  ///< by how much the velocity of the material at the node differs from that at the place of contact [m/s]
  bool sticks = false;             ///< whether the material has the velocity of the rigid body in this step
  Vec<D> pressed = Vec<D>::Zero();  ///< impulse on the material along the normal in this step [N s]
  Vec<D> rubbed = Vec<D>::Zero();   ///< across it
  Vec<D> u = Vec<D>::Zero();        ///< mean velocity of the rigid body there while impulses act in this step [m/s]
};

/// Finds in every step where material touches rigid bodies, and exchanges impulses there.
///
/// **Where.**  A particle touches a body if the distance of its centre from the surface is at most its half width along the normal there,
/// |F^T n| V0^(1/D) / 2.  A node touches if it is at most 0.7 mean edges in front of the surface, and if a particle within two rings of cells
/// does whose normal passes the node by half a mean edge at most.  Normal and place of contact are those of the particle that reaches deepest.
/// A sheet acts on the nodes that it parts: on each field from the side of its particles, wherever their centres are.
///
/// **Impulse.**  The velocity of the material at the place of contact c is v_n - C (x_n - c), with the affine field C of the particle that
/// reaches deepest.  Where it approaches the body, it gets the normal velocity of the body there (a plastic impact), and the tangential one
/// unless friction carries less.  The velocity of a free body after the step is the solution of its equations of motion with all these
/// impulses, so that a light body between heavy nodes is stable; Newton's method finds it, with exact sums over the nodes of all ranks.
template <int D>
class RigidNodes {
 public:
  /// Makes room.  Collective.
  void begin(const Mesh<D>& mesh, const Subdomain& subdomain, Communicator& ranks, const RigidScene<D>& scene,
             const std::vector<std::vector<Index>>& groups_of_field);
  bool any() const noexcept { return n_bodies_ > 0; }

  /// Finds the nodes that touch.  Without `with_affine_fields` those of particles count as zero.  Collective.
  void find(const Mesh<D>& mesh, const OwnNodes& own, const ParticleStrips<D>& strips, const RigidScene<D>& scene,
            std::span<const RigidState<D>> states, const Sheets<D>& sheets, std::span<const VelocityField<D>> fields,
            bool with_affine_fields);
  /// Exchanges impulses between the new velocities of nodes and bodies.  Boundary conditions act on nodes that change.  Collective.
  void act(const Kick& kick, Communicator& ranks, const RigidScene<D>& scene, BoundaryConditions<D>& conditions,
           std::span<RigidState<D>> states, std::span<VelocityField<D>> fields, ExactSums<BoundaryWork>& work);
  /// Makes remapped velocities obey the contacts of this step; nodes that slide keep the velocity of the step.
  void hold(Real time, const BoundaryConditions<D>& conditions, std::span<const RigidState<D>> states,
            std::span<VelocityField<D>> fields) const;
  /// Adds the impulses and the work of this step to the sums of each body.
  void add_sums(const Mesh<D>& mesh, std::span<const RigidState<D>> states, std::span<const VelocityField<D>> fields,
                std::span<ExactSums<RigidSums<D>>> sums) const;
  std::span<const RigidNode<D>> nodes() const noexcept { return nodes_; }

 private:
  struct Place {
    const Mesh<D>& mesh;
    const OwnNodes& own;
    const ParticleStrips<D>& strips;
    const RigidShape<D>& shape;
    const RigidState<D>& state;
    Index rigid;
    const Sheets<D>& sheets;
    std::size_t field;
    bool with_affine_fields;
    bool acts_on(Index node) const noexcept
    {
      return !shape.is_sheet() || (sheets.nearest(node) == rigid && sheets.is_parted(field, node));
    }
    SurfaceDistance<D> distance(const Vec<D>& x) const
    {
      const SurfaceDistance<D> to = state.distance(shape, x);
      return shape.is_sheet() && sheets.is_behind(field) ? SurfaceDistance<D>{-to.distance, -to.normal, to.on_rim, -to.rim_normal} : to;
    }
  };
  void find_candidates(const Place& at, const Nodes<D>& nodes);
  void find_touching_particles(const Place& at);
  void find_deepest(const Place& at, std::span<RigidNode<D>> found);

  std::size_t n_bodies_ = 0;
  std::vector<std::vector<Index>> groups_of_field_;
  std::vector<RigidNode<D>> nodes_;  ///< own ones, by rigid body, field and node
  HaloExchange copies_;
  ReturnToOwners<Touch<D>> back_;
  // Of one rigid body and field at a time:
  std::vector<std::uint8_t> candidate_;  ///< by node
  std::vector<Index> candidates_;        ///< held here
  std::vector<Touch<D>> touch_;          ///< by node
  std::vector<Index> marked_;            ///< cells within two rings of candidates
  std::vector<Index> place_of_cell_;     ///< in `marked_`, or none
  /// Touches of particles by place in `marked_`, with the centres of the particles.
  std::vector<std::vector<std::pair<Touch<D>, Vec<D>>>> touching_;
};

}  // namespace talus
