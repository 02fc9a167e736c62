#pragma once
// Velocities and gradients of the nodes from momentum that particles have summed on them again: MUSL, and symmetric affine FLIP.
#include "solver/transfer/sweep.hpp"
#include "solver/transfer/symmetric_affine.hpp"

namespace talus {

/// Lives on the stack, within a step.
template <int D, Kernel<D> K>
class Remap {
 public:
  using Rows = KernelRows<D, K>;
  /// `fields`: the rows of all velocity fields.
  Remap(Model<D>& m, std::span<Rows> fields) : m_(m), fields_(fields) {}

  /// MUSL: velocities of the nodes at the time `mid` from the momentum of the new velocities of the particles, and what the gradients of these
  /// need; `pic` is the share of damping.
  void find_gradients(Real mid, Real pic)
  {
    if constexpr (!Rows::projects)  // blocks that use nodes of other ranks have rows for them, to be sent first
      for (Rows& of : fields_)
        of.ghosts.motion.take(nodes_of(m_, of).motion, Whole{});
    sum_momentum([&](Index b) {
      if constexpr (WeighsVertices<K, D>)
        for (Rows& of : fields_)
          add_new_momentum(m_, of, b, m_.problem.transfer.increments() ? pic : 1);
      else
        BlockSweep<D, K>(m_, fields_, b).return_momentum(pic);
    });
    find_velocities(mid);
    if constexpr (Rows::projects)
      if (m_.problem.transfer.is_symmetric()) {
        find_gradients_of_affine_fields();
        sum_momentum([&](Index b) { add_affine_momentum(b, MomentumOf::new_velocities, pic); });
        find_velocities(mid);
      }
    for (const Rows& of : fields_)
      add_ranges(nodes_of(m_, of).in_use.own(), m_.work.sums.remap, [&](Index n) {
        const Nodes<D>& nodes = nodes_of(m_, of);
        return remap_work<D>(nodes, n, nodes.sum[to_size(n)].force);
      });
    if constexpr (Rows::projects)
      for (Rows& of : fields_) {
        of.extension.find_velocities(m_.problem.own, of.ghosts.near, nodes_of(m_, of).remapped);
        find_gradients(of, of.extension);
      }
  }

  /// Symmetric affine FLIP, at the beginning of a step: adds to the momentum of the nodes that of affine fields which fit their velocities at
  /// this time [s].
  void add_affine_momentum(Real time) requires Rows::projects
  {
    for (VelocityField<D>& field : m_.work.fields) {
      divide_momentum(field.nodes);
      m_.state.boundary.for_each_node([&](Index n) {
        Vec<D>& v = field.nodes.remapped[static_cast<std::size_t>(n)].v;
        v = m_.state.boundary.held(without_one_sided_walls(n), time, v);
      });
    }
    send_velocities(time);
    find_gradients_of_affine_fields();
    sum_momentum([&](Index b) { add_affine_momentum(b, MomentumOf::old_velocities, 0); });
  }
  /// And at its end: adds to the changes that particles take back the transpose of what the affine fields have added to the momentum.
  void add_transposed_changes() requires Rows::projects
  {
    for (VelocityField<D>& field : m_.work.fields)
      field.nodes.in_use.for_each([&](Index n) {
        const auto i = static_cast<std::size_t>(n);
        field.nodes.remapped[i] = {field.nodes.motion[i].change, Vec<D>::Zero()};
      });
    for (Rows& of : fields_)
      find_changes_on_hats(m_, of);
    const auto add_moments = [&](Index b) {
      for (Rows& of : fields_)
        add_moment_of_changes(m_, of, b);
    };
    for_each_own_block(fields_.front().halo, add_moments, [&] { send_rows<MomentumAlone>(fields_); });
    for (Rows& of : fields_)
      find_changes_of_nodes(m_, of);
    for (Rows& of : fields_)
      add_changes_to_hats(m_, of);
  }

 private:
  /// Sums momentum, which add(block) adds to the rows of a block, on the nodes.
  template <class Add>
  void sum_momentum(Add&& add)
  {
    for_each_own_block(fields_.front().halo, add, [&] { send_rows<MomentumAlone>(fields_); });
    for (Rows& of : fields_) {
      Nodes<D>& nodes = nodes_of(m_, of);
      if constexpr (Rows::projects) {
        assemble<MomentumAlone>(of.blocks, m_.problem.own, of.halo, of.ghosts.sums, nodes.in_use, of.projected.sum, [] {});
        project_momentum(of.kernel.node_operators(), m_.problem.mesh, m_.problem.own, of.projected.sum, nodes.in_use, nodes.sum);
      } else {
        assemble<MomentumAlone>(of.blocks, m_.problem.own, of.halo, of.ghosts.sums, nodes.in_use, nodes.sum, [] {});
      }
    }
    m_.work.sheets.unite_momentum(m_.work.fields);
    for (VelocityField<D>& field : m_.work.fields)
      field.small_mass_nodes.lump_momentum(m_.problem.own, field.nodes);
  }
  /// The velocities of this momentum under boundary conditions and contacts, which start to go to other ranks.
  void find_velocities(Real mid)
  {
    for (VelocityField<D>& field : m_.work.fields) {
      divide_momentum(field.nodes);
      m_.state.boundary.hold(mid, field.nodes);
    }
    m_.work.contact.hold(mid, m_.state.boundary, m_.work.fields);
    m_.work.cuts.hold(mid, m_.problem.own, m_.state.boundary, m_.work.fields.front().nodes);
    m_.work.rigid.hold(mid, m_.state.boundary, m_.state.rigid, m_.work.fields);
    send_velocities(mid);
  }
  /// The velocities of momentum.
  void divide_momentum(Nodes<D>& nodes)
  {
    nodes.in_use.for_each([&](Index n) {
      const auto i = static_cast<std::size_t>(n);
      const Vec<D> v = nodes.active[i] ? Vec<D>(nodes.sum[i].momentum / nodes.sum[i].mass) : Vec<D>(Vec<D>::Zero());
      nodes.remapped[i] = {v, nodes.motion[i].v};
    });
  }
  /// Finds the velocities of nodes of small mass, and starts to send all.
  void send_velocities(Real time)
  {
    for (VelocityField<D>& field : m_.work.fields)
      field.small_mass_nodes.extrapolate_velocity(m_.problem.own, m_.state.boundary, time, field.nodes);
    m_.work.sheets.copy_to_field_behind(
        std::span(m_.work.fields), [](Nodes<D> & nodes) -> auto& { return nodes.remapped; });
    for (Rows& of : fields_)
      of.ghosts.motion.send(nodes_of(m_, of).remapped, Whole{});
  }
  /// Gradients of the velocities that were sent, at surfaces those of their extension if there is one.
  template <class OfSurfaces>
  void find_gradients(Rows& of, const OfSurfaces& extension) requires Rows::projects
  {
    Nodes<D>& nodes = nodes_of(m_, of);
    project_gradient(
        of.kernel.node_operators(), extension, nodes.in_use, nodes.remapped, [&] { of.ghosts.motion.take(nodes.remapped, Whole{}); },
        of.projected, of.gradient_of_remapped);
  }
  /// Affine fields are those of the velocities themselves.
  void find_gradients_of_affine_fields() requires Rows::projects
  {
    for (Rows& of : fields_)
      find_gradients(of, NotExtended{});
  }
  void add_affine_momentum(Index block, MomentumOf which, Real pic) requires Rows::projects
  {
    for (Rows& of : fields_)
      talus::add_affine_momentum(m_, of, block, which, pic);
  }

  Model<D>& m_;
  std::span<Rows> fields_;
};

}  // namespace talus
