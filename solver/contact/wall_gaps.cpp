#include "solver/contact/wall_gaps.hpp"

#include "solver/strips/particles_in_cell.hpp"

namespace talus {

template <int D>
void WallGaps<D>::begin(const Mesh<D>& mesh, const Subdomain& subdomain, Communicator& ranks, const BoundaryConditions<D>& conditions,
                        const std::vector<std::vector<Index>>& groups_of_field, std::span<VelocityField<D>> fields)
{
  planes_ = conditions.gap_planes();
  any_ = ranks.sum(static_cast<std::int64_t>(planes_.size())) > 0;
  groups_of_field_ = groups_of_field;
  const auto n_nodes = static_cast<std::size_t>(any_ ? mesh.n_nodes() : 0);
  for (VelocityField<D>& field : fields)
    field.nodes.open.assign(n_nodes, 0);
  if (!any_ || subdomain.alone())
    return;
  std::vector<std::uint8_t> on_wall(n_nodes, 0);
  for (const auto& plane : planes_)
    on_wall[static_cast<std::size_t>(plane.node)] = 1;
  copies_ = copies_of_nodes(ranks, subdomain, MessageTag::wall_nodes, on_wall);
  back_ = ReturnToOwners<std::uint8_t>(ranks, MessageTag::wall_touches, copies_, std::uint8_t{0xff});
}

template <int D>
void WallGaps<D>::find(const Mesh<D>& mesh, const ParticleStrips<D>& strips, std::span<VelocityField<D>> fields)
{
  if (!any_)
    return;
  for (std::size_t f = 0; f < fields.size(); ++f) {
    std::vector<std::uint8_t>& open = fields[f].nodes.open;
    touched_.assign(planes_.size(), 0);
    parallel_for_uneven(static_cast<Index>(planes_.size()), [&](Index k) {
      const auto& plane = planes_[static_cast<std::size_t>(k)];
      const Real reach = reach_beside<D>(strips, groups_of_field_[f], mesh.cells_of_node()[plane.node], mesh.node(plane.node), plane.normal,
                                         mesh.node_size(plane.node) / 2);
      touched_[static_cast<std::size_t>(k)] = reach >= 0 ? 1 : 0;
    });
    for (const auto& plane : planes_)
      open[static_cast<std::size_t>(plane.node)] = 0;
    for (std::size_t k = 0; k < planes_.size(); ++k)
      if (touched_[k] == 0)
        open[static_cast<std::size_t>(planes_[k].node)] |= static_cast<std::uint8_t>(1 << planes_[k].number);
    back_(open, Numbers{}, [](std::uint8_t& own, std::uint8_t other) { own &= other; });
    copies_.send(open, Numbers{});
    copies_.take(open, Numbers{});
  }
}

template class WallGaps<2>;
template class WallGaps<3>;

}  // namespace talus
