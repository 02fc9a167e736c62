#pragma once
// Velocity fields in front of and behind rigid sheets.
#include <span>
#include <vector>

#include "solver/boundary/velocity_field.hpp"
#include "solver/halo/halo_exchange.hpp"
#include "solver/rigid/rigid_body.hpp"
#include "solver/strips/side_of_sheet.hpp"

namespace talus {

/// Parts the velocities of material in front of a sheet from those behind it.
///
/// **Sides.**  Particles near a sheet are in front of it or behind it (SideOfSheet), and are summed in two fields.
///
/// **Nodes.**  A sheet parts a node that is at most `reach` mean edges away, if its nearest point of the sheet is not on the rim: then the
/// two fields of the node move apart, and the sheet acts on each as a rigid body does.  All other nodes are one: the sums of the field behind
/// are moved to the field in front, whose motion both fields get.  Sums are linear, so material there moves as if no sheet were near.
///
/// The material behind a sheet that moves on becomes one with that in front again: a sheet cuts while it is there.
template <int D>
class Sheets {
 public:
  /// Makes room; `in_front`: the number of fields in front.  Collective.
  void begin(const Mesh<D>& mesh, const Subdomain& subdomain, Communicator& ranks, const OwnNodes& own, const RigidScene<D>& scene,
             std::size_t in_front);
  bool any() const noexcept { return any_; }

  /// Finds the nodes near sheets; without communication, as all ranks know the sheets.
  void find(const Mesh<D>& mesh, const RigidScene<D>& scene, std::span<const RigidState<D>> states);
  /// The side that a particle which was at one has at x [m] in a cell, for the places of sheets that find() had.
  SideOfSheet side(const Mesh<D>& mesh, const RigidScene<D>& scene, std::span<const RigidState<D>> states, Index cell, const Vec<D>& x,
                   const SideOfSheet& before) const;

  /// Unites the sums of nodes that no sheet parts.  A node whose mass in a field is small, and which has no host in it, is not parted either.
  /// Collective.
  void unite(const Mesh<D>& mesh, const OwnNodes& own, std::span<VelocityField<D>> fields);
  /// The same for the momentum alone, after it was summed again.
  void unite_momentum(std::span<VelocityField<D>> fields) const;
  /// Gives the field behind the rows `of(nodes)` of the field in front, at nodes that no sheet parts.
  template <class Of>
  void copy_to_field_behind(std::span<VelocityField<D>> fields, Of&& of) const
  {
    for (std::size_t f = 0; any() && f < in_front_; ++f) {
      auto& front = of(fields[f].nodes);
      auto& behind = of(fields[f + in_front_].nodes);
      fields[f].nodes.in_use.for_each([&](Index node) {
        if (const auto n = static_cast<std::size_t>(node); !is_parted(f, node))
          behind[n] = front[n];
      });
    }
  }

  bool is_behind(std::size_t field) const noexcept { return any() && field >= in_front_; }
  /// The field on the other side of the sheets.
  std::size_t other_field(std::size_t field) const noexcept { return field < in_front_ ? field + in_front_ : field - in_front_; }
  /// Whether a sheet parts an own node of a field, after unite().
  bool is_parted(std::size_t field, Index node) const noexcept
  {
    return parted_[field < in_front_ ? field : field - in_front_][static_cast<std::size_t>(node)] != 0;
  }
  /// The sheet that is nearest to a node near one, or none.
  Index nearest(Index node) const noexcept { return nearest_[static_cast<std::size_t>(node)]; }

 private:
  void find_members(const Mesh<D>& mesh, const OwnNodes& own, std::span<VelocityField<D>> fields, std::size_t f);

  bool any_ = false;
  std::size_t in_front_ = 0;
  std::vector<Index> sheets_;                       ///< numbers of the rigid bodies
  std::vector<Index> nearest_;                      ///< by node: number of the rigid body, none if no sheet is near
  std::vector<std::uint8_t> may_part_;              ///< by node: it is near enough to a sheet, and not beyond its rim
  std::vector<std::vector<std::uint8_t>> parted_;   ///< by field in front and own node
  std::array<std::vector<std::uint8_t>, 2> moves_;  ///< by side and node: enough mass for a motion of its own, in the field at hand
  HaloExchange copies_;
};

extern template class Sheets<2>;
extern template class Sheets<3>;

}  // namespace talus
