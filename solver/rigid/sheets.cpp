#include "solver/rigid/sheets.hpp"

namespace talus {

namespace {

/// Nodes farther than this from a sheet, in mean edges, have particles of one side only: shape functions reach two rings.
constexpr Real reach = 2;
/// Nodes nearer than this make the cells around them near: all particles that a parted node sees have a side, and those that arrive in a step.
constexpr Real zone = 2 * reach + 1;

/// A sheet by the number of its rigid body, and the distance from it, negative behind it.
template <int D>
struct NearSheet {
  Index sheet = none;
  SurfaceDistance<D> to;
  void take(Index other, const SurfaceDistance<D>& to_other) noexcept
  {
    if (sheet == none || std::abs(to_other.distance) < std::abs(to.distance))
      sheet = other, to = to_other;
  }
};

}  // namespace

template <int D>
void Sheets<D>::begin(const Mesh<D>& mesh, const Subdomain& subdomain, Communicator& ranks, const OwnNodes& own, const RigidScene<D>& scene,
                      std::size_t in_front)
{
  sheets_.clear();
  for (std::size_t r = 0; r < scene.bodies.size(); ++r)
    if (scene.bodies[r].shape->is_sheet())
      sheets_.push_back(static_cast<Index>(r));
  any_ = !sheets_.empty();
  in_front_ = in_front;
  if (!any_)
    return;
  const auto n_nodes = static_cast<std::size_t>(mesh.n_nodes());
  nearest_.assign(n_nodes, none);
  may_part_.assign(n_nodes, 0);
  parted_.assign(in_front, std::vector<std::uint8_t>(n_nodes, 0));
  if (!subdomain.alone())
    copies_ = copies_of_nodes(ranks, subdomain, MessageTag::sheet_nodes, spread_by_rings(mesh, own.owned, 2));
}

template <int D>
void Sheets<D>::find(const Mesh<D>& mesh, const RigidScene<D>& scene, std::span<const RigidState<D>> states)
{
  if (!any_)
    return;
  parallel_for(mesh.n_nodes(), [&](Index node) {
    const auto n = static_cast<std::size_t>(node);
    const Real size = mesh.node_size(node), far = zone * size;
    NearSheet<D> nearest;
    for (const Index r : sheets_) {
      const RigidShape<D>& shape = *scene.bodies[static_cast<std::size_t>(r)].shape;
      const RigidState<D>& state = states[static_cast<std::size_t>(r)];
      const Real around = shape.radius() + far;
      if ((mesh.node(node) - state.x).squaredNorm() > around * around)
        continue;
      const SurfaceDistance<D> to = state.distance(shape, mesh.node(node));
      if (std::abs(to.distance) <= far)
        nearest.take(r, to);
    }
    nearest_[n] = nearest.sheet;
    may_part_[n] = nearest.sheet != none && !nearest.to.on_rim && std::abs(nearest.to.distance) <= reach * size ? 1 : 0;
  });
}

template <int D>
SideOfSheet Sheets<D>::side(const Mesh<D>& mesh, const RigidScene<D>& scene, std::span<const RigidState<D>> states, Index cell,
                            const Vec<D>& x, const SideOfSheet& before) const
{
  NearSheet<D> nearest;
  Index last = none;
  for (const Index n : mesh.cell(cell)) {
    const Index r = this->nearest(n);
    if (r == none || r == last)
      continue;
    last = r;
    nearest.take(r, states[static_cast<std::size_t>(r)].distance(*scene.bodies[static_cast<std::size_t>(r)].shape, x));
  }
  SideOfSheet after;
  if (nearest.sheet != none) {
    after.sheet = nearest.sheet;
    after.kept = !nearest.to.on_rim;
    const bool keeps = before.sheet == after.sheet && before.kept && after.kept;
    after.behind = keeps ? before.behind : nearest.to.distance < 0;
  }
  after.changes = after.behind != before.behind;
  return after;
}

/// Finds the nodes with enough mass for a motion of their own on each side, as far as hosts are sought there: before nodes are united.
template <int D>
void Sheets<D>::find_members(const Mesh<D>& mesh, const OwnNodes& own, std::span<VelocityField<D>> fields, std::size_t f)
{
  const Nodes<D>&front = fields[f].nodes, &behind = fields[f + in_front_].nodes;
  for (std::vector<std::uint8_t>& of_side : moves_)
    of_side.assign(static_cast<std::size_t>(mesh.n_nodes()), 0);
  front.in_use.for_each([&](Index node) {
    const auto n = static_cast<std::size_t>(node);
    if (!own.has(node))
      return;
    if (may_part_[n] != 0) {
      moves_[0][n] = has_own_motion(front.sum[n], front) ? 1 : 0;
      moves_[1][n] = has_own_motion(behind.sum[n], behind) ? 1 : 0;
    } else {
      NodeSum<D> both = front.sum[n];
      both += behind.sum[n];
      moves_[0][n] = has_own_motion(both, front) ? 1 : 0;
    }
  });
  for (std::vector<std::uint8_t>& of_side : moves_) {
    copies_.send(of_side, Numbers{});
    copies_.take(of_side, Numbers{});
  }
}

template <int D>
void Sheets<D>::unite(const Mesh<D>& mesh, const OwnNodes& own, std::span<VelocityField<D>> fields)
{
  for (std::size_t f = 0; any_ && f < in_front_; ++f) {
    find_members(mesh, own, fields, f);
    Nodes<D>&front = fields[f].nodes, &behind = fields[f + in_front_].nodes;
    const auto is_held_up = [&](Index node, const NodeSum<D>& sum, const std::vector<std::uint8_t>& moves) {
      if (!sum.is_seen() || moves[static_cast<std::size_t>(node)] != 0)
        return true;
      for (const Index m : mesh.ring_of_node()[node])
        for (const Index host : mesh.ring_of_node()[m])
          if (moves[static_cast<std::size_t>(host)] != 0)
            return true;
      return false;
    };
    front.in_use.for_each([&](Index node) {
      const auto n = static_cast<std::size_t>(node);
      if (!own.has(node))
        return;
      parted_[f][n] = may_part_[n] != 0 && is_held_up(node, front.sum[n], moves_[0]) && is_held_up(node, behind.sum[n], moves_[1]) ? 1 : 0;
      if (parted_[f][n] == 0)
        front.sum[n] += std::exchange(behind.sum[n], {});
    });
  }
}

template <int D>
void Sheets<D>::unite_momentum(std::span<VelocityField<D>> fields) const
{
  for (std::size_t f = 0; any_ && f < in_front_; ++f) {
    Nodes<D>&front = fields[f].nodes, &behind = fields[f + in_front_].nodes;
    front.in_use.for_each([&](Index node) {
      if (const auto n = static_cast<std::size_t>(node); !is_parted(f, node))
        front.sum[n].add_momentum(std::exchange(behind.sum[n], {}));
    });
  }
}

template class Sheets<2>;
template class Sheets<3>;

}  // namespace talus
