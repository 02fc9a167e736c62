#pragma once
// Symmetric affine FLIP: affine fields that follow from the velocities of the nodes, and the transpose of what they add to the momentum, for the
// changes that particles take back (docs/theory/transfers.md).
#include "solver/transfer/projected_nodes.hpp"
#include "solver/transfer/vertex_motion.hpp"

namespace talus {

/// A node for boundary conditions whose one-sided walls do not act.  When affine fields are found it is not known yet which of them material will
/// touch, and what comes back has to be the transpose.
inline NodeOfField without_one_sided_walls(Index node) noexcept { return {node, 0xff}; }

/// The part of a change of velocity that boundary conditions leave free at a node of this mass [kg] that moves with v; the rest is their impulse, which
/// does work where they move.
template <int D>
Vec<D> leave_free(Model<D>& m, Index node, const Vec<D>& v, Real mass, const Vec<D>& change)
{
  if (!m.state.boundary.binds(node))
    return change;
  const Vec<D> kept = m.state.boundary.free_changes(without_one_sided_walls(node), v) * change;
  if (const Vec<D> impulse = mass * (kept - change); m.problem.own.has(node) && !impulse.isZero(0)) {
    m.state.boundary.react(node, impulse);
    m.work.sums.beyond_nodes.add({0, impulse.dot(v), 0, 0, moment<D>(m.problem.mesh.node(node), impulse)});
  }
  return kept;
}

/// Whose momentum is summed.
enum class MomentumOf : std::uint8_t { old_velocities, new_velocities };

/// Adds the momentum of the particles of a block, with affine fields from the gradients of the remapped velocities, to the rows of the block;
/// `pic` is the share of damping of new velocities.
template <int D, Kernel<D> K>
void add_affine_momentum(const Model<D>& m, KernelRows<D, K>& of, Index block, MomentumOf which, Real pic)
{
  struct {
    std::array<const Vec<D>*, D + 1> v, change;
    std::array<const Mat<D>*, D + 1> L;
  } motion;
  const Vec<D> none_of_it = Vec<D>::Zero();
  const bool is_new = which == MomentumOf::new_velocities;
  for_each_cell_with_moments(m, of, block, [&](Index c, const CellMoments<D>& moments, const auto& arms, auto rows, auto slots) {
    for (std::size_t a = 0; a <= D; ++a) {
      const auto n = static_cast<std::size_t>(m.problem.mesh.cell(c)[a]);
      motion.v[a] = is_new ? &of.projected.motion[n].v : &none_of_it;
      motion.change[a] = is_new ? &of.projected.motion[n].change : &none_of_it;
      motion.L[a] = &of.gradient_of_remapped[n];
    }
    add_new_momentum<true>(moments, arms, motion, is_new ? pic : 0, rows, slots);
  });
}

/// Finds the changes of the linear shape functions that particles use, those of the nodes in `remapped` with boundary conditions of their own,
/// and their moments.
template <int D, Kernel<D> K>
void find_changes_on_hats(Model<D>& m, KernelRows<D, K>& of)
{
  const NodeOperators<D>& operators = of.kernel.node_operators();
  Nodes<D>& nodes = nodes_of(m, of);
  of.ghosts.motion.send(nodes.remapped, Whole{});
  for_each_seen_hat(
      nodes.in_use, of.projected, [&] { of.ghosts.motion.take(nodes.remapped, Whole{}); },
      [&](Index n, const ProjectedNodeMotion<D>& motion) {
        ChangeOnHat<D> on_hat{motion.change, Mat<D>::Zero()};
        operators.for_each_in_row(n, [&](Index v, Real S, const Vec<D>&) {
          on_hat.moment += S * nodes.remapped[static_cast<std::size_t>(v)].v * (m.problem.mesh.node(v) - operators.centre(n)).transpose();
        });
        of.changes[static_cast<std::size_t>(n)] = on_hat;
      });
}

/// Adds the changes of the nodes in `remapped` to those of the linear shape functions, where boundary conditions leave them free.
template <int D, Kernel<D> K>
void add_changes_to_hats(Model<D>& m, KernelRows<D, K>& of)
{
  Nodes<D>& nodes = nodes_of(m, of);
  of.ghosts.motion.send(nodes.remapped, Whole{});
  for_each_seen_hat(
      nodes.in_use, of.projected, [&] { of.ghosts.motion.take(nodes.remapped, Whole{}); },
      [&](Index n, ProjectedNodeMotion<D>& motion) {
        Vec<D> change = Vec<D>::Zero();
        of.kernel.node_operators().for_each_in_row(
            n, [&](Index v, Real S, const Vec<D>&) { change += S * nodes.remapped[static_cast<std::size_t>(v)].v; });
        motion.change += change;
        of.changes[static_cast<std::size_t>(n)].change = change;
      });
  m.state.boundary.for_each_node([&](Index n) {
    const auto i = static_cast<std::size_t>(n);
    if (!of.projected.sum[i].is_seen())
      return;
    const Vec<D> change = of.changes[i].change;
    ProjectedNodeMotion<D>& motion = of.projected.motion[i];
    motion.change += leave_free(m, n, motion.v, of.projected.sum[i].mass, change) - change;
  });
}

/// Adds the moments of changes of the particles of a block to its rows.
template <int D, Kernel<D> K>
void add_moment_of_changes(const Model<D>& m, KernelRows<D, K>& of, Index block)
{
  for_each_cell_with_moments(m, of, block, [&](Index c, const CellMoments<D>& moments, const auto& arms, auto rows, auto slots) {
    std::array<const ChangeOnHat<D>*, D + 1> changes;
    for (std::size_t a = 0; a <= D; ++a)
      changes[a] = &of.changes[static_cast<std::size_t>(m.problem.mesh.cell(c)[a])];
    add_moment_of_changes(moments, arms, changes, rows, slots);
  });
}

/// Sets `remapped` of the nodes to the changes that these moments make, sum_n T_n D_nv / m_v, where boundary conditions leave them free: the
/// transpose of what add_affine_momentum() makes of velocities.
template <int D, Kernel<D> K>
void find_changes_of_nodes(Model<D>& m, KernelRows<D, K>& of)
{
  Nodes<D>& nodes = nodes_of(m, of);
  const OwnNodes& own = m.problem.own;
  assemble<MomentumAlone>(of.blocks, own, of.halo, of.ghosts.sums, nodes.in_use, of.projected.sum, [] {});
  std::vector<Vec<D>>& changes = of.changes_of_nodes;  // first momenta
  nodes.in_use.for_each([&](Index v) {
    Vec<D> momentum = Vec<D>::Zero();
    if (own.has(v))
      of.kernel.node_operators().for_each_in_column(v, [&](Index n, Real, const Vec<D>& gradient) {
        const ProjectedNodeSum<D>& on_hat = of.projected.sum[static_cast<std::size_t>(n)];
        if (on_hat.is_seen())
          momentum += pull_of<D>(on_hat.affine, gradient);
      });
    changes[static_cast<std::size_t>(v)] = momentum;
  });
  SmallMassNodes<D>& small = m.work.fields[of.field].small_mass_nodes;
  small.give(
      own, [](Index, const Vec<D>& momentum) { return momentum; }, changes);
  const auto free = [&](Index n, const Vec<D>& change) {
    const auto i = static_cast<std::size_t>(n);
    return leave_free(m, n, nodes.motion[i].v, nodes.sum[i].mass, change);
  };
  nodes.in_use.for_each([&](Index n) {
    const auto i = static_cast<std::size_t>(n);
    changes[i] = nodes.active[i] ? Vec<D>(changes[i] / nodes.sum[i].mass) : Vec<D>(Vec<D>::Zero());
  });
  m.state.boundary.for_each_node([&](Index n) {
    const auto i = static_cast<std::size_t>(n);
    if (nodes.active[i])
      changes[i] = free(n, changes[i]);
  });
  small.take(own, free, changes);
  nodes.in_use.for_each([&](Index n) {
    nodes.remapped[static_cast<std::size_t>(n)] = {changes[static_cast<std::size_t>(n)], Vec<D>::Zero()};
  });
}

}  // namespace talus
