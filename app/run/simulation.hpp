#pragma once
// Bodies of the functions in simulate.hpp; simulate_2d.cpp and simulate_3d.cpp compile them for every kernel of one dimension.
#include <new>
#include <stdexcept>

#include "app/observers/balance_errors.hpp"
#include "app/run/simulate.hpp"
#include "core/parallel/communicator.hpp"
#include "core/parallel/rebalance_policy.hpp"
#include "kernels/kernels.hpp"
#include "mesh/partition.hpp"

namespace talus {

/// f.template operator()<K>() for the kernel of that name, which the reader has found in the list.
template <int D, class F>
void with_kernel(std::string_view name, F&& f)
{
  for_each_type(Kernels<D>{}, [&]<class K>() {
    if (K::name == name)
      f.template operator()<K>();
  });
}

inline void options_of(const Scene&, NoOptions&) {}
inline void options_of(const Scene& scene, UmlsOptions& options) { options = scene.umls.value_or(options); }
inline void options_of(const Scene& scene, ProjectedOptions& options) { options = scene.projected.value_or(options); }

/// How many particles of all ranks there are in each block of the whole mesh, from their cells there.  Every rank has to ask.
inline std::vector<std::int64_t> particles_in_blocks(std::span<const Index> whole_cell, Index n_cells)
{
  std::vector<std::int64_t> count(static_cast<std::size_t>(blocks_of(n_cells)), 0);
  for (const Index cell : whole_cell)
    ++count[static_cast<std::size_t>(cell / block_cells)];
  world().sum(count);
  return count;
}

/// What this rank holds of a mesh whose blocks have so many particles.
template <int D>
Part<D> part_of(const Mesh<D>& mesh, std::span<const std::int64_t> particles_in_block)
{
  return cut(mesh, partition(mesh, particles_in_block, world().size()), world().rank(), rings_held);
}

/// The model of a rank, of its part of the mesh and with a set-up in the numbers of that.  Every rank has to ask.
template <int D, Kernel<D> K>
Model<D, K> build(const Scene& scene, Part<D> part, Setup<D> setup)
{
  Options<K> options;
  options_of(scene, options);
  std::optional<Model<D, K>> built;
  world().agree(Communicator::caught([&] {
    try {
      built.emplace(std::move(part.mesh), options);
    } catch (const std::invalid_argument& e) {
      throw SceneErrors(scene.mesh.where, fmt::format("kernel \"{}\": {}", scene.kernel, e.what()));
    }
  }));
  Model<D, K>& m = *built;
  if (!part.share.alone())
    m.join(world(), std::move(part.share));
  m.particles = std::move(setup.particles);
  m.bodies = std::move(setup.bodies);
  m.materials = std::move(setup.materials);
  m.walls = std::move(setup.walls);
  m.loads = std::move(setup.loads);
  m.water = std::move(setup.water);
  m.transfer = setup.transfer;
  m.exits = std::move(setup.exits);
  m.guards = setup.guards;
  m.clock.lag = setup.lag;
  m.energy.largest_before = setup.largest_before;
  m.energy.largest_seen = m.guards.least_energy * least_energy_factor;
  make_ready(m, setup.laws);
  return std::move(m);
}

/// The same of the whole mesh and a set-up by parts: shares are made by the particles, which go to their owners.
template <int D, Kernel<D> K>
Model<D, K> build(const Scene& scene, Mesh<D> mesh, Setup<D> setup)
{
  Part<D> part{std::move(mesh), {}};
  if (!world().alone()) {
    part = part_of(part.mesh, particles_in_blocks(setup.particles.cell, part.mesh.n_cells()));
    receive_owned_particles(world(), part.share, setup.bodies, setup.materials, setup.particles);
    restrict_to(part.share, setup);
  }
  return build<D, K>(scene, std::move(part), std::move(setup));
}

template <int D>
Real first_step(const Mesh<D>& mesh, const Setup<D>& setup)
{
  return std::min(setup.limits.cfl * shortest_crossing(mesh, setup.materials, setup.particles), setup.limits.longest);
}

/// All of a set-up but its particles, for models to come.
template <int D>
Setup<D> without_particles(Setup<D>& setup)
{
  Particles<D> particles = std::exchange(setup.particles, {});
  std::vector<AnyBatch> materials = std::exchange(setup.materials, {});
  Setup<D> rest = setup;
  rest.particles.keep_in(particles.precision());
  for (Body& body : rest.bodies)
    body.begin = body.end = 0;
  for (AnyBatch& material : materials)
    std::visit(
        [&](auto& batch) {
          auto history = std::exchange(batch.history, {});
          auto bare = batch;
          bare.begin = bare.end = 0;
          rest.materials.push_back(std::move(bare));
          batch.history = std::move(history);
        },
        material);
  setup.particles = std::move(particles);
  setup.materials = std::move(materials);
  return rest;
}

/// Thrown before a step, for ranks to share their work out anew: the state is that of a checkpoint then.
struct RebalanceRequest {};

/// All stages on one model, or on several, one after the other, where ranks share their work out anew: as if the run was stopped and went on,
/// but for what has been seen of it.
template <int D, Kernel<D> K>
class Simulation {
 public:
  Simulation(const Scene& scene, Mesh<D> mesh, Setup<D> setup, const RunCallbacks<D>& audience, const LoadBalancing<D>& moves)
      : scene_(scene),
        audience_(audience),
        moves_(moves),
        stages_(setup.stages),
        changes_(std::exchange(setup.changes, {})),
        laws_(setup.laws),
        limits_(setup.limits)
  {
    if (may_move())
      rest_ = without_particles(setup);
    StopWatch watch;
    model_.emplace(build<D, K>(scene, std::move(mesh), std::move(setup)));
    watch.lap(build_seconds_);
  }

  void operator()()
  {
    if (audience_.take_over) {
      audience_.take_over(state_of(*model_));
      adopt();
    }
    audience_.ready(frame());
    begin_shares(world().max(moves_.mesh_seconds + build_seconds_));
    Index number = 0;
    if (audience_.take_over) {
      if (!model_->stage.done)
        run_on({});
      number = model_->stage.number + 1;
    }
    for (; number < static_cast<Index>(stages_.size()); ++number) {
      enter(number);
      run_on(number);
    }
  }

 private:
  bool may_move() const { return !world().alone() && moves_.every != 0; }
  const Stage& stage_at_hand() const { return stages_[static_cast<std::size_t>(model_->stage.number)]; }
  RunView<D> frame() const { return frame_of(*model_, stage_at_hand()); }

  /// All that the stage of that number changes between two steps.
  void enter(Index number)
  {
    const auto n = static_cast<std::size_t>(number);
    if (n >= changes_.size() || !changes_[n].any())
      return;
    const StageReport news = talus::enter(*model_, changes_[n], laws_[n], stages_[n]);
    audience_.changed(frame(), stages_[n], news);
  }

  /// A state that has been put into the model, which was built for the first stage.
  void adopt()
  {
    adopt_state(*model_);
    const auto n = static_cast<std::size_t>(model_->stage.number);
    if (n < changes_.size() && changes_[n].walls)
      take_walls(*model_, *changes_[n].walls);
    if (n < changes_.size() && changes_[n].table)
      take_table(*model_, *changes_[n].table);
  }

  /// To the end of the stage of that number, which begins; without a number, of that which is on its way.
  void run_on(std::optional<Index> begins)
  {
    std::optional<StageResult> result = run_until_shares_move(begins);
    while (!result) {
      move_shares();
      result = run_until_shares_move({});
    }
    audience_.stage_done(frame(), *result);
  }

  std::optional<StageResult> run_until_shares_move(std::optional<Index> begins)
  {
    const auto watch = [&](const Model<D, K>&, RunEvent moment) {
      if (moment == RunEvent::step_begins && should_move())
        throw RebalanceRequest();
      audience_.watch(frame(), moment);
    };
    try {
      if (begins)
        return run_stage(*model_, stages_[static_cast<std::size_t>(*begins)], limits_, watch, *begins);
      return finish_stage(*model_, stage_at_hand(), limits_, watch);
    } catch (const RebalanceRequest&) {
      return std::nullopt;
    }
  }

  /// Seconds in steps so far.
  Real seconds_in_steps() const
  {
    const Timings& t = model_->timings;
    return t.locate + t.scatter + t.nodes + t.gather + t.stress;
  }

  /// The shares are those that have been made just now, which took so long [s].
  void begin_shares(Real cost)
  {
    if (!may_move())
      return;
    const std::int64_t step = model_->clock.step;
    if (rule_)
      rule_->moved(step, cost);
    else
      rule_.emplace(moves_.every, step, cost);
    looked_at_ = step, seconds_then_ = seconds_in_steps();
    own_cells_ = 0;
    for (Index c = 0; c < model_->mesh.n_cells(); ++c)
      own_cells_ += model_->share.owns_cell(c) ? 1 : 0;
  }

  /// Every rank asks, and has the same answer.
  bool should_move()
  {
    const Model<D, K>& m = *model_;
    const std::int64_t step = m.clock.step;
    if (!rule_ || !rule_->looks(step))
      return false;
    if (rule_->always_moves())
      return true;
    const Real here = (seconds_in_steps() - seconds_then_) / static_cast<Real>(step - looked_at_);
    looked_at_ = step, seconds_then_ = seconds_in_steps();
    const std::int64_t work = cells_per_particle * m.particles.size() + own_cells_, all = world().sum(work), most = world().max(work);
    const Real busiest_over_mean = static_cast<Real>(most) * world().size() / static_cast<Real>(all);
    if (!rule_->has_lost_enough(step, world().max(here), busiest_over_mean))
      return false;
    const auto costs = costs_of_blocks(particles_in_blocks(whole_cells(), m.share.whole_cells), m.share.whole_cells);
    return rule_->gains(imbalance(costs, m.share.rank_of_whole_block, world().size()), imbalance_in_reach(costs, world().size()));
  }

  std::vector<Index> whole_cells() const
  {
    std::vector<Index> cells;
    for (const Index cell : model_->particles.cell)
      cells.push_back(model_->share.whole_cell(cell));
    return cells;
  }

  /// The whole mesh goes before the old model does, and that before the new one comes.
  void move_shares()
  {
    StopWatch watch;
    Real seconds = 0;
    model_->particles.cell = whole_cells();
    const auto weights = particles_in_blocks(model_->particles.cell, model_->share.whole_cells);
    std::optional<Part<D>> made;
    try {
      world().agree(Communicator::caught([&] { made = part_of(moves_.whole_mesh(), weights); }));
    } catch (const Error& e) {
      return stay(e.what());
    } catch (const std::bad_alloc&) {
      return stay("not enough memory");
    }
    Part<D>& part = *made;
    const auto costs = costs_of_blocks(weights, part.share.whole_cells);
    Rebalanced told{.clock = model_->clock,
                    .before = imbalance(costs, model_->share.rank_of_whole_block, world().size()),
                    .after = imbalance(costs, part.share.rank_of_whole_block, world().size())};
    const std::int64_t migrated = model_->migration.moved();
    LooseState<D> state = take_out(state_of(*model_));
    model_.reset();
    Setup<D> setup = rest_;
    restrict_to(part.share, setup);
    model_.emplace(build<D, K>(scene_, std::move(part), std::move(setup)));
    put_into(state_of(*model_), std::move(state));
    adopt();
    model_->migration.count_from(migrated);
    watch.lap(seconds);
    told.seconds = world().max(seconds);
    begin_shares(told.seconds);
    moves_.moved(told);
  }

  /// The run can do without.
  void stay(const std::string& why)
  {
    for (Index& cell : model_->particles.cell)
      cell = model_->share.local_cell(cell);
    rule_->abort_run();
    moves_.stayed(why);
  }

  const Scene& scene_;
  const RunCallbacks<D>& audience_;
  const LoadBalancing<D>& moves_;
  std::vector<Stage> stages_;
  std::vector<StageChange<D>> changes_;
  std::vector<std::vector<AnyBatch>> laws_;
  StepLimits limits_;
  Setup<D> rest_;  // of the whole mesh, where shares may move
  std::optional<Model<D, K>> model_;
  Real build_seconds_ = 0;
  std::optional<RebalancePolicy> rule_;
  std::int64_t looked_at_ = 0;  // steps done at the last look
  Real seconds_then_ = 0;       // in steps
  Index own_cells_ = 0;
};

template <int D>
void simulate(const Scene& scene, Mesh<D> mesh, Setup<D> setup, const RunCallbacks<D>& audience, const LoadBalancing<D>& moves)
{
  with_kernel<D>(scene.kernel, [&]<class K>() { Simulation<D, K>(scene, std::move(mesh), std::move(setup), audience, moves)(); });
}

template <int D>
Estimate estimate(const Scene& scene, Mesh<D> mesh, Setup<D> setup)
{
  Estimate cost{};
  cost.dt = first_step(mesh, setup);
  const Stage first_stage = setup.stages.front();
  with_kernel<D>(scene.kernel, [&]<class K>() {
    const auto m = build<D, K>(scene, std::move(mesh), std::move(setup));
    const auto bytes = [](const auto& column) { return static_cast<std::int64_t>(column.size() * sizeof(column[0])); };
    m.particles.for_each_column([&](std::string_view, std::string_view, const auto& column) { cost.particle_bytes += bytes(column); });
    for (const AnyBatch& material : m.materials)
      std::visit([&](const auto& batch) { cost.particle_bytes += bytes(batch.history); }, material);
    cost.mesh_bytes = static_cast<std::int64_t>(m.mesh.nodes().size_bytes() + m.mesh.cells().size_bytes()) +
                      m.mesh.n_cells() * static_cast<std::int64_t>((2 + D * (D + 1)) * sizeof(Real)) + bytes(m.mesh.cells_of_node().item) +
                      bytes(m.mesh.ring_of_node().item);
    cost.node_bytes = bytes(m.nodes.sum) + bytes(m.nodes.motion) + bytes(m.projected.sum) + bytes(m.projected.motion) +
                      bytes(m.blocks.row) + bytes(m.blocks.slot);
    if constexpr (HasNodeOperators<K, D>)
      cost.node_bytes += static_cast<std::int64_t>(m.kernel.node_operators().size_bytes());
    cost.shared_nodes = find_shared_nodes<D>(m.mesh, m.particles, m.bodies, [&m](Index c, std::vector<Index>& nodes) {
      for (const Index n : m.kernel.stencil(m.mesh, c))
        if constexpr (HasNodeOperators<K, D>)
          m.kernel.node_operators().for_each_in_row(n, [&](Index v, Real S, const Vec<D>&) {
            if (S != 0)
              nodes.push_back(v);
          });
        else
          nodes.push_back(n);
    });
    cost.nodes_as_corners = count_nodes_as_corners(m);
    cost.files = file_sizes(frame_of(m, first_stage), scene.outputs);
  });
  return cost;
}

}  // namespace talus
