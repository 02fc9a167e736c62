#pragma once
// Transfer<D> for one kernel.  Included by the units in which the kernels of the list are compiled, one unit per kernel
// (cmake/TalusLists.cmake), and where a kernel is not in the list.
#include <algorithm>
#include <utility>

#include "solver/state/integrate.hpp"
#include "solver/transfer/make_transfer.hpp"
#include "solver/transfer/sweep.hpp"

namespace talus {

/// Nodes with less than this fraction of the mass of the lightest particle around are nodes of small mass.  Where weights may be negative,
/// sums cancel and a small mass gives no information on the momentum: there the limit lies above the negative weights that moving least
/// squares reach beside a boundary (0.012 of a particle).
inline constexpr Real least_share = 1e-8, least_share_of_signed_weights = 2e-2;

/// Limit of the ratio of the mass of a node to the sum of absolute masses from single cells.  Cells whose weights have different signs may
/// leave a node next to no mass; velocity and acceleration are then quotients of two small differences.  Measured on two grids that become
/// 4 and two that become 10 times finer from one cell to the next: with 0.1 particles invert on one, with 0.5 one gains 35 times its
/// energy, with 0.3 none fails.  Without effect where all weights are positive.
inline constexpr Real least_share_of_cells = 0.3;
/// Limit of the ratio of the mass of a node to the mean mass of the linear shape functions around, for kernels with node operators.  Rows
/// of nodes on a wall contain nodes on the wall only, so a node beside a wall that carries a thin film has next to no mass, but the film's
/// stress acts on it.  On a regular lattice the ratio is 0.4 under a film half a cell thick and 0.17 under a fifth of one; nodes at free
/// surfaces have about 0.9.
inline constexpr Real least_share_of_hats = 0.2;

template <int D, Kernel<D> K>
class TransferOf final : public Transfer<D> {
 public:
  using Rows = KernelRows<D, K>;
  TransferOf(const Mesh<D>& mesh, const Options<K>& options) : rows_(mesh, options) {}

  Rows& rows() noexcept { return rows_; }
  const Rows& rows() const noexcept { return rows_; }

  void join(const Problem<D>& problem) override
  {
    Communicator& ranks = *problem.ranks;
    rows_.halo = Halo(ranks, problem.mesh, problem.subdomain, rows_.blocks);
    const auto copy = [&](MessageTag topic, const std::vector<std::uint8_t>& wanted) {
      return copies_of_nodes(ranks, problem.subdomain, topic, wanted);
    };
    const std::vector<std::uint8_t> read = nodes_read(problem.subdomain, rows_.blocks);
    if constexpr (Rows::projects) {
      const auto both = [](std::vector<std::uint8_t> marked, const std::vector<std::uint8_t>& others) {
        for (std::size_t n = 0; n < marked.size(); ++n)
          marked[n] |= others[n];
        return marked;
      };
      const auto around_own = [&](int rings) { return spread_by_rings(problem.mesh, problem.own.owned, rings); };
      const std::vector<std::uint8_t> moving = spread_by_rings(problem.mesh, read, 1);
      rows_.ghosts.sums = copy(MessageTag::sums, both(around_own(1), read));
      rows_.ghosts.motion = copy(MessageTag::motion, moving);
      rows_.ghosts.felt = copy(MessageTag::felt, around_own(2));
      if (rows_.kernel.extends_surfaces())
        rows_.ghosts.near = copy(MessageTag::near, both(around_own(Extension<D>::rings), moving));
      rows_.ghosts.cells = copies_of_cells(ranks, problem.subdomain, MessageTag::cells, problem.mesh.n_cells());
      rows_.projected.find_late(problem.mesh, problem.own);
    } else {
      rows_.ghosts.motion = copy(MessageTag::motion, read);
    }
  }

  void prepare(const TransferOptions& options) override
  {
    if (options.uses_musl())
      rows_.remapped.resize(static_cast<std::size_t>(rows_.blocks.rows_of_node.size()));
  }

  bool keeps_gradients() const override { return BlockSweep<D, K>::keeps_gradients; }

  void sum_strips(Model<D>& m) override
  {
    if (WeighsVertices<K, D> && m.problem.transfer.uses_musl()) {
      rows_.gradient_of_remapped.resize(rows_.projected.motion.size());
      rows_.moments.resize(static_cast<std::size_t>(m.problem.mesh.n_cells()));
    }
    if constexpr (Rows::projects) {
      rows_.interfaces.begin(m.problem.mesh, m.state.materials, rows_.kernel.separates_materials());
      if (rows_.kernel.extends_surfaces())
        rows_.extension.begin(m.problem.mesh);
    }
    for_each_reading_block(
        rows_.halo, [] {}, [&](Index b) { BlockSweep<D, K>(m, rows_, b).sum(); });
  }

  void find_gradients(Model<D>& m, std::size_t key, Index strip, StripColumns<D>& columns) override
  {
    BlockSweep<D, K>(m, rows_, m.work.strips->first_cell(key, 0) / block_cells).find_gradients_again(key, strip, columns);
  }

  void particles_to_nodes(Model<D>& m) override
  {
    for_each_own_block<Whole>(rows_.blocks, rows_.halo, [&](Index b) { BlockSweep<D, K>(m, rows_, b).add_arrivals(); });
  }

  void assemble_nodes(Model<D>& m) override
  {
    Nodes<D>& nodes = m.work.nodes;
    const auto find_nodes = [&] { nodes.in_use.find(rows_.blocks.occupied, !m.problem.loads.on_mesh.empty()); };
    if constexpr (Rows::projects) {
      assemble<Whole>(rows_.blocks, m.problem.own, rows_.halo, rows_.ghosts.sums, nodes.in_use, rows_.projected.sum, find_nodes);
      rows_.interfaces.find_rows(m.problem.mesh, nodes.in_use, rows_.ghosts.cells);
      project_sums(rows_.kernel.node_operators(), rows_.interfaces, m.problem.mesh, m.problem.own, rows_.projected.sum, nodes.in_use,
                   nodes.sum);
      extend_forces(m);
    } else {
      assemble<Whole>(rows_.blocks, m.problem.own, rows_.halo, rows_.ghosts.sums, nodes.in_use, nodes.sum, find_nodes);
    }
  }

  void filter_acceleration([[maybe_unused]] Model<D>& m) override
  {
    if constexpr (Rows::projects) {
      std::vector<Vec<D>>& felt = m.work.nodes.felt;
      rows_.ghosts.felt.send(felt, Numbers{});
      talus::filter_acceleration(
          rows_.kernel.node_operators(), m.problem.own, m.work.nodes.in_use, [&] { rows_.ghosts.felt.take(felt, Numbers{}); },
          rows_.projected, felt);
    }
  }

  void send_motion(Model<D>& m) override { rows_.ghosts.motion.send(m.work.nodes.motion, Whole{}); }

  void nodes_to_particles(Model<D>& m, const Kick& kick, Real dt, const BetweenParts& between) override
  {
    const Real pic = m.problem.transfer.pic_share(dt, m.state.crossing, m.state.stage.seeks_rest);
    const bool musl = m.problem.transfer.uses_musl();
    project_to_particles(m, kick);
    if (musl)
      find_remapped_gradient(m, kick.to, pic);
    if constexpr (Rows::projects)
      rows_.interfaces.find_gradients(m.problem.mesh, rows_.extension, musl ? rows_.remapped : m.work.nodes.motion);
    m.work.strips->drop_loaded_gradients();
    const auto sweep = [&](const SweepParts& parts) {
      for_each_reading_block(
          rows_.halo, [&] { take_motion(m, parts); },
          [&](Index b) {
            if (!parts.moves && parts.updates)
              between.before_stress_of_block(b);
            BlockSweep<D, K>(m, rows_, b).advance(parts, dt, pic);
            if (parts.moves && !parts.updates)
              between.after_motion(b);
          });
    };
    const bool before = static_cast<bool>(between.before_stress), after = static_cast<bool>(between.after_stress);
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
    return {.of_particles = rows_.kernel.claims().non_negative ? least_share : least_share_of_signed_weights,
            .of_gross = Rows::projects ? least_share_of_hats : least_share_of_cells};
  }

  void add_nodes_of_cell(const Mesh<D>& mesh, Index cell, std::vector<Index>& nodes) const override
  {
    for (const Index n : rows_.kernel.stencil(mesh, cell))
      if constexpr (Rows::projects)
        rows_.kernel.node_operators().for_each_in_row(n, [&](Index v, Real S, const Vec<D>&) {
          if (S != 0)
            nodes.push_back(v);
        });
      else
        nodes.push_back(n);
  }

  std::int64_t nodes_as_corners([[maybe_unused]] const OwnNodes& own) const override
  {
    if constexpr (requires { rows_.kernel.nodes_as_corners(); })
      return std::ranges::count_if(rows_.kernel.nodes_as_corners(), [&](Index n) { return own.has(n); });
    else
      return 0;
  }

  std::int64_t bytes() const override { return rows_.bytes(); }

  /// Makes the motion that particles read from that of the nodes: a copy, or projected nodes, on which boundary conditions act once more
  /// where their values combine those of several nodes.
  void project_to_particles([[maybe_unused]] Model<D>& m, [[maybe_unused]] const Kick& kick)
  {
    if constexpr (Rows::projects) {
      rows_.extension.find_velocities(m.problem.own, rows_.ghosts.near, m.work.nodes.motion);
      project_motion(
          rows_.kernel.node_operators(), rows_.extension, m.work.nodes.in_use, m.work.nodes.motion,
          [&] { rows_.ghosts.motion.take(m.work.nodes.motion, Whole{}); }, rows_.projected);
      m.state.boundary.apply(kick, rows_.projected.sum, rows_.projected.motion, m.work.sums.beyond_nodes);
    }
  }

 private:
  /// Finds the tangential extension at surfaces that cut cells, and moves the forces of the stress with it.
  void extend_forces(Model<D>& m) requires Rows::projects
  {
    if (!rows_.extension.any())
      return;
    const NodeOperators<D>& operators = rows_.kernel.node_operators();
    Nodes<D>& nodes = m.work.nodes;
    rows_.extension.find_rows(m.problem.mesh, operators, m.problem.own, nodes, rows_.ghosts.near,
                              [&](Index n) { return rows_.projected.sum[static_cast<std::size_t>(n)].volume; });
    rows_.extension.move_forces(m.problem.mesh, m.problem.own, nodes.in_use, rows_.ghosts.near, nodes.sum,
                                [&](Index v) { return stress_force(operators, rows_.interfaces, m.problem.mesh, rows_.projected.sum, v); });
  }
  /// Receives the motion of nodes of other ranks that the particles of own blocks read; of projected nodes it has arrived.
  void take_motion([[maybe_unused]] Model<D>& m, [[maybe_unused]] const SweepParts& parts)
  {
    if constexpr (!Rows::projects)
      if (parts.moves)
        rows_.ghosts.motion.take(m.problem.transfer.uses_musl() ? rows_.remapped : m.work.nodes.motion, Whole{});
  }

  /// MUSL: velocities of the nodes from the momentum of the new velocities of the particles, and what the gradients of these need.
  void find_remapped_gradient(Model<D>& m, Real mid, Real pic)
  {
    if constexpr (!Rows::projects)  // blocks that use nodes of other ranks have rows for them, to be sent first
      rows_.ghosts.motion.take(m.work.nodes.motion, Whole{});
    for_each_own_block<MomentumAlone>(rows_.blocks, rows_.halo, [&](Index b) {
      if constexpr (WeighsVertices<K, D>)
        add_new_momentum(m, rows_, b, m.problem.transfer.increments() ? pic : 1);
      else
        BlockSweep<D, K>(m, rows_, b).return_momentum(pic);
    });
    find_remapped_velocity(m, mid);
    if constexpr (Rows::projects) {
      rows_.extension.find_velocities(m.problem.own, rows_.ghosts.near, rows_.remapped);
      project_gradient(
          rows_.kernel.node_operators(), rows_.extension, m.work.nodes.in_use, rows_.remapped,
          [&] { rows_.ghosts.motion.take(rows_.remapped, Whole{}); }, rows_.projected, rows_.gradient_of_remapped);
    }
  }

  /// MUSL: puts the momentum of the new particle velocities, which is in the rows of blocks, on the nodes, under the boundary conditions.
  void find_remapped_velocity(Model<D>& m, Real mid)
  {
    Problem<D>& problem = m.problem;
    State<D>& state = m.state;
    Workspace<D>& work = m.work;
    const Mesh<D>& mesh = problem.mesh;
    const OwnNodes& own = problem.own;
    Nodes<D>& nodes = work.nodes;
    std::vector<NodeMotion<D>>& remapped = rows_.remapped;
    if constexpr (Rows::projects) {
      assemble<MomentumAlone>(rows_.blocks, own, rows_.halo, rows_.ghosts.sums, nodes.in_use, rows_.projected.sum, [] {});
      project_momentum(rows_.kernel.node_operators(), mesh, own, rows_.projected.sum, nodes.in_use, nodes.sum);
    } else {
      assemble<MomentumAlone>(rows_.blocks, own, rows_.halo, rows_.ghosts.sums, nodes.in_use, nodes.sum, [] {});
    }
    work.small_mass_nodes.lump_momentum(mesh, own, nodes);
    nodes.in_use.for_each([&](Index n) {
      const auto i = static_cast<std::size_t>(n);
      const Vec<D> v = nodes.active[i] ? Vec<D>(nodes.sum[i].momentum / nodes.sum[i].mass) : Vec<D>(Vec<D>::Zero());
      remapped[i] = {v, nodes.motion[i].v};
    });
    state.boundary.hold(mid, remapped);
    work.small_mass_nodes.extrapolate_velocity(mesh, own, state.boundary, mid, remapped);
    rows_.ghosts.motion.send(remapped, Whole{});
    add_ranges(nodes.in_use.own(), work.sums.remap, [&](Index n) { return remap_work(nodes, remapped, n); });
  }

  Rows rows_;
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
