#pragma once
// Transfer<D> for one kernel.  Included by the units in which the kernels of the list are compiled, one unit per kernel
// (cmake/TalusLists.cmake), and where a kernel is not in the list.
#include <algorithm>
#include <functional>
#include <utility>

#include "solver/state/integrate.hpp"
#include "solver/transfer/join_ranks.hpp"
#include "solver/transfer/make_transfer.hpp"
#include "solver/transfer/remap.hpp"
#include "solver/transfer/sweep.hpp"

namespace talus {

/// Nodes with less than this fraction of the mass of the lightest particle around are nodes of small mass.  Where weights may be negative,
/// sums cancel: there the limit lies above the negative weights that moving least squares reach beside a boundary (0.012 of a particle).
inline constexpr Real least_share = 1e-8, least_share_of_signed_weights = 2e-2;

/// Limit of the ratio of the mass of a node to the sum of absolute masses from single cells.  Cells whose weights have different signs may
/// leave a node next to no mass; velocity and acceleration are then quotients of two small differences.  Of four grids that become 4 or 10
/// times finer from one cell to the next, particles invert on one with 0.1, one gains 35 times its energy with 0.5, none fails with 0.3.
inline constexpr Real least_share_of_cells = 0.3;
/// Limit of the ratio of the mass of a node to the mean mass of the linear shape functions around, for kernels with node operators.  Beside a
/// wall that carries a thin film a node has next to no mass, but the film's stress acts on it.  On a regular lattice the ratio is 0.4 under a
/// film half a cell thick and 0.17 under a fifth of one; nodes at free surfaces have about 0.9.
inline constexpr Real least_share_of_hats = 0.2;

template <int D, Kernel<D> K>
class TransferOf final : public Transfer<D> {
 public:
  using Rows = KernelRows<D, K>;
  TransferOf(const Mesh<D>& mesh, const Options<K>& options) : kernel_(make_kernel<K>(mesh, options))
  {
    fields_.emplace_back(mesh, kernel_, 0);
  }

  std::span<Rows> fields() noexcept { return fields_; }
  Rows& rows() noexcept { return fields_.front(); }

  void join(const Problem<D>& problem) override
  {
    for (Rows& of : fields_)
      join_ranks(problem, of);
  }
  void prepare(const Problem<D>& problem) override
  {
    while (fields_.size() < problem.n_fields()) {
      Rows& of = fields_.emplace_back(problem.mesh, kernel_, fields_.size());
      if (!problem.subdomain.alone())
        join_ranks(problem, of);
    }
  }

  bool keeps_gradients() const override { return Sweep::keeps_gradients; }
  bool averages_gradients() const override { return Rows::projects; }
  void sum_strips(Model<D>& m) override
  {
    for (Rows& of : fields_) {
      of.keep_weights(m.problem.columns.reference ? m.work.strips->keys() * to_size(strips_in_block) : 0);
      const auto is_of_field = [&](Index body) { return m.problem.contacts.field_of(body) == of.field % m.problem.fields_in_front(); };
      if (WeighsVertices<K, D> && m.problem.transfer.uses_musl()) {
        of.gradient_of_remapped.resize(of.projected.motion.size());
        of.moments.resize(static_cast<std::size_t>(m.problem.mesh.n_cells()));
      }
      if constexpr (Rows::projects) {
        if (m.problem.transfer.is_symmetric()) {
          of.changes.resize(of.projected.motion.size());
          of.changes_of_nodes.assign(of.changes.size(), Vec<D>::Zero());
        }
        of.interfaces.begin(m.problem.mesh, m.state.materials, is_of_field);
        if (kernel_.extends_surfaces())
          of.extension.begin(m.problem.mesh);
      }
      of.surfaces.begin(m.problem.loads.on_surfaces, is_of_field, of.blocks, *m.problem.ranks, m.problem.mesh, m.problem.subdomain);
    }
    m.work.on_surfaces.resize(m.problem.loads.on_surfaces.size());
    for_each_reading_block(
        rows().halo, [] {}, [&](Index b) { Sweep(m, fields_, b).sum(); });
  }

  void find_gradients(Model<D>& m, std::size_t key, Index strip, StripColumns<D>& columns) override
  {
    Sweep(m, fields_, m.work.strips->first_cell(key, 0) / block_cells).find_gradients_again(key, strip, columns);
  }

  void particles_to_nodes(Model<D>& m) override
  {
    for_each_own_block(
        rows().halo, [&](Index b) { Sweep(m, fields_, b).add_arrivals(); }, [&] { send_rows<Whole>(std::span(fields_)); });
  }

  void assemble_nodes(Model<D>& m) override
  {
    for (Rows& of : fields_) {
      Nodes<D>& nodes = nodes_of(m, of);
      const auto find_nodes = [&] { nodes.in_use.find(occupied_blocks(m, of), !m.problem.loads.on_mesh.empty()); };
      if constexpr (Rows::projects) {
        assemble<Whole>(of.blocks, m.problem.own, of.halo, of.ghosts.sums, nodes.in_use, of.projected.sum, find_nodes);
        of.interfaces.find_rows(m.problem.mesh, nodes.in_use, of.ghosts.cells);
        project_sums(kernel_.node_operators(), of.interfaces, m.problem.mesh, m.problem.own, of.projected.sum, nodes.in_use, nodes.sum);
      } else {
        assemble<Whole>(of.blocks, m.problem.own, of.halo, of.ghosts.sums, nodes.in_use, nodes.sum, find_nodes);
      }
      add_surface_loads(m, of);
      if constexpr (Rows::projects)
        extend_forces(m, of);
    }
  }

  void add_affine_momentum([[maybe_unused]] Model<D>& m, [[maybe_unused]] Real time) override
  {
    if constexpr (Rows::projects)
      if (m.problem.transfer.is_symmetric())
        Remap<D, K>(m, fields_).add_affine_momentum(time);
  }

  void filter_acceleration([[maybe_unused]] Model<D>& m) override
  {
    if constexpr (Rows::projects) {
      const Sheets<D>& sheets = m.work.sheets;
      for (Rows& of : fields_) {
        std::vector<Vec<D>>& felt = nodes_of(m, of).felt;
        of.ghosts.felt.send(felt, Numbers{});
        project_acceleration(
            kernel_.node_operators(), nodes_of(m, of).in_use, [&] { of.ghosts.felt.take(felt, Numbers{}); }, of.projected, felt);
      }
      for (Rows& of : fields_)
        talus::filter_acceleration(
            kernel_.node_operators(), m.problem.own, nodes_of(m, of).in_use,
            [&](Index v, auto&& f) {
              f(of.projected);
              if (sheets.any() && !sheets.is_parted(of.field, v))
                f(fields_[sheets.other_field(of.field)].projected);
            },
            nodes_of(m, of).felt);
    }
  }

  void send_motion(Model<D>& m) override
  {
    for (Rows& of : fields_)
      of.ghosts.motion.send(nodes_of(m, of).motion, Whole{});
  }

  void nodes_to_particles(Model<D>& m, const Kick& kick, Real dt, const BetweenParts& between) override
  {
    const Real pic = m.problem.transfer.pic_share(dt, m.state.crossing, m.state.stage.seeks_rest);
    const bool musl = m.problem.transfer.uses_musl();
    for (Rows& of : fields_)
      project_to_particles(m, of, kick, m.problem.transfer.increments() ? pic : 1);
    if constexpr (Rows::projects)
      if (m.problem.transfer.is_symmetric())
        Remap<D, K>(m, fields_).add_transposed_changes();
    if (musl)
      Remap<D, K>(m, fields_).find_gradients(kick.to, pic);
    if constexpr (Rows::projects)
      for (Rows& of : fields_)
        of.interfaces.find_gradients(m.problem.mesh, of.extension, musl ? nodes_of(m, of).remapped : nodes_of(m, of).motion);
    m.work.strips->drop_loaded_gradients();
    const auto sweep = [&](const SweepParts& parts) {
      for_each_reading_block(
          rows().halo, [&] { take_motion(m, parts); },
          [&](Index b) {
            if (!parts.moves && parts.updates)
              between.before_stress_of_block(b);
            Sweep(m, fields_, b).advance(parts, dt, pic);
            if (parts.moves && !parts.updates)
              between.after_motion(b);
          });
    };
    const bool before{between.before_stress}, after{between.after_stress};
    sweep({.orders = WeighsVertices<K, D> || !musl, .moves = true, .updates = !before, .deposits = !before && !after});
    if (before) {
      between.before_stress();
      sweep({.updates = true, .deposits = !after});
    }
    if (after) {
      between.after_stress();
      sweep({.deposits = true});
    }
  }

  LeastShares least_shares() const override
  {
    return {.of_particles = kernel_.claims().non_negative ? least_share : least_share_of_signed_weights,
            .of_gross = Rows::projects ? least_share_of_hats : least_share_of_cells};
  }

  void add_nodes_of_cell(const Mesh<D>& mesh, Index cell, std::vector<Index>& nodes) const override
  {
    for (const Index n : kernel_.stencil(mesh, cell))
      if constexpr (Rows::projects)
        kernel_.node_operators().for_each_in_row(n, [&](Index v, Real S, const Vec<D>&) {
          if (S != 0)
            nodes.push_back(v);
        });
      else
        nodes.push_back(n);
  }

  std::int64_t nodes_as_corners([[maybe_unused]] const OwnNodes& own) const override
  {
    if constexpr (requires { kernel_.nodes_as_corners(); })
      return std::ranges::count_if(kernel_.nodes_as_corners(), [&](Index n) { return own.has(n); });
    return 0;
  }

  std::int64_t bytes(const Model<D>& m) const override
  {
    std::int64_t bytes = 0;
    for (const Rows& of : fields_) {
      const Nodes<D>& nodes = nodes_of(m, of);
      NodesInUse in_use = nodes.in_use;
      in_use.find(occupied_blocks(m, of), !m.problem.loads.on_mesh.empty());
      const Real of_nodes = static_cast<Real>(in_use.size()) / static_cast<Real>(m.problem.mesh.n_nodes());
      const Real of_blocks = static_cast<Real>(std::ranges::count(of.blocks.occupied, 1)) / static_cast<Real>(of.blocks.size());
      bytes += of.bytes(of_nodes, of_blocks) +
               static_cast<std::int64_t>(of_nodes * static_cast<Real>(bytes_of_all(nodes.sum, nodes.motion, nodes.remapped)));
    }
    if constexpr (Rows::projects)
      bytes += static_cast<std::int64_t>(kernel_.node_operators().size_bytes());
    return bytes;
  }

  /// Makes the motion that particles read from that of the nodes: a copy, or projected nodes, on which boundary conditions act once more
  /// where their values combine those of several nodes; `pic` is the share of these velocities that particles take.
  void project_to_particles([[maybe_unused]] Model<D>& m, [[maybe_unused]] Rows& of, [[maybe_unused]] const Kick& kick,
                            [[maybe_unused]] Real pic)
  {
    if constexpr (Rows::projects) {
      Nodes<D>& nodes = nodes_of(m, of);
      of.extension.find_velocities(m.problem.own, of.ghosts.near, nodes.motion);
      project_motion(
          kernel_.node_operators(), of.extension, nodes.in_use, nodes.motion, [&] { of.ghosts.motion.take(nodes.motion, Whole{}); },
          of.projected);
      m.state.boundary.apply(kick, nodes, of.projected.sum, of.projected.motion, pic, m.work.sums.beyond_nodes);
    }
  }

 private:
  using Sweep = BlockSweep<D, K>;
  /// Whether blocks hold particles whose sums the nodes of a field get: with sheets those on both sides.  Valid until the next call.
  std::span<const std::uint8_t> occupied_blocks(const Model<D>& m, const Rows& of) const
  {
    if (!m.work.sheets.any())
      return of.blocks.occupied;
    const auto& behind = fields_[m.work.sheets.other_field(of.field)].blocks.occupied;
    occupied_on_both_sides_.resize(behind.size());
    std::ranges::transform(of.blocks.occupied, behind, occupied_on_both_sides_.begin(), std::bit_or());
    return occupied_on_both_sides_;
  }

  /// Finds the tangential extension at surfaces that cut cells, and moves the forces of the stress with it.
  void extend_forces(Model<D>& m, Rows& of) requires Rows::projects
  {
    if (!of.extension.any())
      return;
    const NodeOperators<D>& operators = kernel_.node_operators();
    Nodes<D>& nodes = nodes_of(m, of);
    of.extension.find_rows(m.problem.mesh, operators, m.problem.own, nodes, of.ghosts.near,
                           [&](Index n) { return of.projected.sum[static_cast<std::size_t>(n)].volume; });
    of.extension.move_forces(
        m.problem.mesh, m.problem.own, nodes.in_use, of.ghosts.near, nodes.sum,
        [&](Index v) { return stress_force(operators, of.interfaces, m.problem.mesh, of.projected.sum, v); }, nodes.surface_loads);
  }
  /// Adds the forces of loads on surfaces that cut cells.
  void add_surface_loads(Model<D>& m, Rows& of)
  {
    if (m.problem.loads.on_surfaces.empty())
      return;
    Nodes<D>& nodes = nodes_of(m, of);
    of.surfaces.assemble(of.blocks.occupied, m.problem.own, of.ghosts.sums, nodes.in_use);
    const NodeOperators<D>* operators = nullptr;
    if constexpr (Rows::projects)
      operators = &kernel_.node_operators();
    const Real time = m.state.clock.time;
    apply_surface_loads(m.problem.loads.on_surfaces, time, m.state.stage.ramp(time), m.problem.mesh, m.problem.own, operators, of.surfaces,
                        nodes, m.work.on_surfaces);
    for (const RowsOfLoad<D>& rows : of.surfaces.all())
      m.work.sums.on_mesh.add(m.work.on_surfaces[rows.load]);
  }
  /// Receives the motion of nodes of other ranks that the particles of own blocks read; of projected nodes it has arrived.
  void take_motion([[maybe_unused]] Model<D>& m, [[maybe_unused]] const SweepParts& parts)
  {
    if constexpr (!Rows::projects)
      if (parts.moves)
        for (Rows& of : fields_)
          of.ghosts.motion.take(m.problem.transfer.uses_musl() ? nodes_of(m, of).remapped : nodes_of(m, of).motion, Whole{});
  }

  K kernel_;
  std::vector<Rows> fields_;
  mutable std::vector<std::uint8_t> occupied_on_both_sides_;
};

template <class K, int D>
std::unique_ptr<Transfer<D>> make_transfer_of(const Mesh<D>& mesh, const Options<K>& options)
{
  return std::make_unique<TransferOf<D, K>>(mesh, options);
}

/// A model of one rank without particles, for a kernel known at compile time.
template <class K, int D>
Model<D> make_model(Mesh<D> mesh, const Options<K>& options = {})
{
  auto transfer = std::make_unique<TransferOf<D, K>>(mesh, options);
  return Model<D>(std::move(mesh), std::move(transfer));
}

}  // namespace talus
