#include "app/run/simulate.hpp"

#include <algorithm>
#include <new>
#include <stdexcept>

#include "app/observers/accounts.hpp"
#include "core/parallel/communicator.hpp"
#include "core/parallel/rebalance_policy.hpp"
#include "core/stop_watch.hpp"
#include "io/equations/petsc_plugin.hpp"
#include "mesh/partition.hpp"
#include "solver/particles/redistribute.hpp"
#include "solver/stable_step.hpp"
#include "solver/transfer/make_transfer.hpp"

namespace talus {

namespace {

KernelOptions kernel_options_of(const Scene& scene)
{
  return {scene.umls.value_or(UmlsOptions{}), scene.projected.value_or(ProjectedOptions{})};
}

/// How many particles of all ranks there are in each block of the whole mesh, from their cells there.  Every rank has to ask.
std::vector<std::int64_t> particles_in_blocks(std::span<const Index> whole_cell, Index n_cells)
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

/// The model of a rank, of its part of the mesh and with a set-up in the numbers of that.  Adds the time of the set-up of the kernel [s].
/// Every rank has to call it.
template <int D>
Model<D> build(const Scene& scene, Part<D> part, Setup<D> setup, Real& kernel_seconds)
{
  std::unique_ptr<Transfer<D>> transfer;
  StopWatch watch;
  world().agree(Communicator::caught([&] {
    try {
      transfer = make_transfer(scene.kernel, kernel_options_of(scene), part.mesh);
    } catch (const std::invalid_argument& e) {
      throw SceneErrors(scene.mesh.where, fmt::format("kernel \"{}\": {}", scene.kernel, e.what()));
    }
  }));
  watch.lap(kernel_seconds);
  Model<D> m(std::move(part.mesh), std::move(transfer));
  if (!part.subdomain.alone())
    m.join(world(), std::move(part.subdomain));
  if (std::ranges::any_of(setup.stages, [](const Stage& stage) { return stage.equilibrium.has_value(); }))
    m.problem.equations = &petsc();
  m.state = std::move(setup.state);
  static_cast<SceneConditions<D>&>(m.problem) = std::move(setup.conditions);
  m.state.energy.largest_seen = m.problem.limits.least_energy * least_energy_factor;
  make_ready(m, setup.laws);
  return m;
}

/// The same of the whole mesh and a set-up by parts: subdomains are made by the particles, which go to their owners.
template <int D>
Model<D> build(const Scene& scene, Mesh<D> mesh, Setup<D> setup, Real& kernel_seconds)
{
  Part<D> part{std::move(mesh), {}};
  if (!world().alone()) {
    State<D>& state = setup.state;
    part = part_of(part.mesh, particles_in_blocks(state.particles.cell, part.mesh.n_cells()));
    receive_owned_particles(world(), part.subdomain, state.bodies, state.materials, state.particles);
    restrict_to(part.subdomain, setup);
  }
  return build(scene, std::move(part), std::move(setup), kernel_seconds);
}

}  // namespace

template <int D>
Real first_step(const Mesh<D>& mesh, const Setup<D>& setup)
{
  return std::min(setup.limits.cfl * shortest_crossing(mesh, setup.state.materials, setup.state.particles), setup.limits.longest);
}

namespace {

/// All of a set-up but its particles, for models to come.
template <int D>
Setup<D> without_particles(Setup<D>& setup)
{
  Particles<D> particles = std::exchange(setup.state.particles, {});
  std::vector<Material> materials = std::exchange(setup.state.materials, {});
  Setup<D> rest = setup;
  for (Body& body : rest.state.bodies)
    body.begin = body.end = 0;
  for (const Material& material : materials)
    rest.state.materials.push_back(material.without_particles());
  setup.state.particles = std::move(particles);
  setup.state.materials = std::move(materials);
  return rest;
}

/// Thrown before a step, for ranks to share their work out anew: the state is that of a checkpoint then.
struct RebalanceRequest {};

/// All stages on one model, or on several, one after the other, where ranks share their work out anew: as if the run was stopped and went on,
/// but for what has been seen of it.
template <int D>
class Simulation {
 public:
  Simulation(const Scene& scene, Mesh<D> mesh, Setup<D> setup, const RunCallbacks<D>& callbacks, const LoadBalancing<D>& moves)
      : scene_(scene),
        callbacks_(callbacks),
        moves_(moves),
        stages_(setup.stages),
        changes_(std::exchange(setup.changes, {})),
        laws_(setup.laws),
        limits_(setup.limits)
  {
    if (may_move())
      rest_ = without_particles(setup);
    StopWatch watch;
    Real kernel = 0;
    model_.emplace(build(scene, std::move(mesh), std::move(setup), kernel));
    watch.lap(build_seconds_);
    callbacks_.kernel_made(kernel);
  }

  void operator()()
  {
    if (callbacks_.take_over) {
      callbacks_.take_over(model_->state);
      adopt();
    }
    callbacks_.ready(view());
    begin_shares(world().max(moves_.mesh_seconds + build_seconds_));
    Index number = 0;
    if (callbacks_.take_over) {
      if (!model_->state.stage.done)
        run_on({});
      number = model_->state.stage.number + 1;
    }
    for (; number < static_cast<Index>(stages_.size()); ++number) {
      enter(number);
      run_on(number);
    }
  }

 private:
  bool may_move() const { return !world().alone() && moves_.every != 0; }
  const Stage& stage_at_hand() const { return stages_[static_cast<std::size_t>(model_->state.stage.number)]; }
  RunView<D> view()
  {
    RunView<D> all = view_of(*model_, stage_at_hand());
    all.fetch_particles = [this] {
      if (model_->work.strips && model_->state.particles.id.empty())
        callbacks_.before_copy();
      copy_to_columns(*model_);
    };
    all.take_copy = [this] { return take_copy(*model_); };
    if (!stage_at_hand().equilibrium)
      all.set_velocities = [this](std::span<const Real> values, VelocityChange change) { set_velocities(*model_, values, change); };
    return all;
  }

  /// All that the stage of that number changes between two steps.
  void enter(Index number)
  {
    const auto n = static_cast<std::size_t>(number);
    if (n >= changes_.size() || !changes_[n].any())
      return;
    const StageReport news = talus::enter(*model_, changes_[n], laws_[n], stages_[n]);
    callbacks_.changed(view(), stages_[n], news);
  }

  /// A state that has been put into the model, which was built for the first stage.
  void adopt()
  {
    adopt_state(*model_);
    const auto n = static_cast<std::size_t>(model_->state.stage.number);
    if (n < changes_.size() && changes_[n].boundary)
      take_boundary(*model_, *changes_[n].boundary);
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
    callbacks_.stage_done(view(), *result);
  }

  std::optional<StageResult> run_until_shares_move(std::optional<Index> begins)
  {
    const Watch<D> watch(
        [&](const Model<D>&, RunEvent event) {
          if (event == RunEvent::step_begins && should_move())
            throw RebalanceRequest();
          callbacks_.watch(view(), event);
        },
        true);
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
    const Timings& t = model_->state.timings;
    return t.locate + t.scatter + t.nodes + t.gather + t.stress;
  }

  /// The shares are those that have been made just now, which took so long [s].
  void begin_shares(Real cost)
  {
    if (!may_move())
      return;
    const std::int64_t step = model_->state.clock.step;
    if (rule_)
      rule_->moved(step, cost);
    else
      rule_.emplace(moves_.every, step, cost);
    looked_at_ = step, seconds_then_ = seconds_in_steps();
    own_cells_ = 0;
    for (Index c = 0; c < model_->problem.mesh.n_cells(); ++c)
      own_cells_ += model_->problem.subdomain.owns_cell(c) ? 1 : 0;
  }

  /// Every rank asks, and has the same answer.
  bool should_move()
  {
    const Model<D>& m = *model_;
    const std::int64_t step = m.state.clock.step;
    if (!rule_ || !rule_->looks(step))
      return false;
    if (rule_->always_moves())
      return true;
    const Real here = (seconds_in_steps() - seconds_then_) / static_cast<Real>(step - looked_at_);
    looked_at_ = step, seconds_then_ = seconds_in_steps();
    const std::int64_t work = cells_per_particle * n_particles(m) + own_cells_, all = world().sum(work), most = world().max(work);
    const Real busiest_over_mean = static_cast<Real>(most) * world().size() / static_cast<Real>(all);
    if (!rule_->has_lost_enough(step, world().max(here), busiest_over_mean))
      return false;
    copy_to_columns(*model_);
    const auto costs =
        costs_of_blocks(particles_in_blocks(whole_cells(), m.problem.subdomain.whole_cells), m.problem.subdomain.whole_cells);
    return rule_->gains(imbalance(costs, m.problem.subdomain.rank_of_whole_block, world().size()),
                        imbalance_in_reach(costs, world().size()));
  }

  std::vector<Index> whole_cells() const
  {
    std::vector<Index> cells;
    for (const Index cell : model_->state.particles.cell)
      cells.push_back(model_->problem.subdomain.whole_cell(cell));
    return cells;
  }

  /// The whole mesh goes before the old model does, and that before the new one comes.
  void move_shares()
  {
    StopWatch watch;
    Real seconds = 0;
    model_->state.particles.cell = whole_cells();
    const auto weights = particles_in_blocks(model_->state.particles.cell, model_->problem.subdomain.whole_cells);
    std::optional<Part<D>> made;
    try {
      world().agree(Communicator::caught([&] { made = part_of(moves_.whole_mesh(), weights); }));
    } catch (const Error& e) {
      return stay(e.what());
    } catch (const std::bad_alloc&) {
      return stay("not enough memory");
    }
    Part<D>& part = *made;
    const auto costs = costs_of_blocks(weights, part.subdomain.whole_cells);
    Rebalanced told{.clock = model_->state.clock,
                    .before = imbalance(costs, model_->problem.subdomain.rank_of_whole_block, world().size()),
                    .after = imbalance(costs, part.subdomain.rank_of_whole_block, world().size())};
    const std::int64_t migrated = model_->work.migration.moved();
    State<D> state = std::move(model_->state);
    state.empty_cells = state.empty_cells.of_all_ranks(world(), model_->problem.subdomain);
    model_.reset();
    Setup<D> setup = rest_;
    restrict_to(part.subdomain, setup);
    Real kernel = 0;  // part of the time of the redistribution
    model_.emplace(build(scene_, std::move(part), std::move(setup), kernel));
    BoundaryConditions<D> boundary = std::move(model_->state.boundary);  // those of the new part of the mesh
    boundary.continue_from(state.boundary);
    state.boundary = std::move(boundary);
    model_->state = std::move(state);
    adopt();
    model_->work.migration.count_from(migrated);
    watch.lap(seconds);
    told.seconds = world().max(seconds);
    begin_shares(told.seconds);
    moves_.moved(told);
  }

  /// The run can do without.
  void stay(const std::string& why)
  {
    for (Index& cell : model_->state.particles.cell)
      cell = model_->problem.subdomain.local_cell(cell);
    rule_->abort_run();
    moves_.stayed(why);
  }

  const Scene& scene_;
  const RunCallbacks<D>& callbacks_;
  const LoadBalancing<D>& moves_;
  std::vector<Stage> stages_;
  std::vector<StageChange<D>> changes_;
  std::vector<std::vector<Material>> laws_;
  StepLimits limits_;
  Setup<D> rest_;  // of the whole mesh, where shares may move
  std::optional<Model<D>> model_;
  Real build_seconds_ = 0;
  std::optional<RebalancePolicy> rule_;
  std::int64_t looked_at_ = 0;  // steps done at the last look
  Real seconds_then_ = 0;       // in steps
  Index own_cells_ = 0;
};

}  // namespace

template <int D>
void simulate(const Scene& scene, Mesh<D> mesh, Setup<D> setup, const RunCallbacks<D>& callbacks, const LoadBalancing<D>& moves)
{
  Simulation<D>(scene, std::move(mesh), std::move(setup), callbacks, moves)();
}

template <int D>
Estimate estimate(const Scene& scene, Mesh<D> mesh, Setup<D> setup)
{
  Estimate cost{};
  cost.dt = first_step(mesh, setup);
  const Stage first_stage = setup.stages.front();
  Real kernel = 0;  // of no interest here
  Model<D> m = build(scene, std::move(mesh), std::move(setup), kernel);
  const auto bytes = [](const auto& column) { return static_cast<std::int64_t>(column.size() * sizeof(column[0])); };
  cost.particle_bytes = static_cast<std::int64_t>(bytes_of(m.state.particles));
  for (const Material& material : m.state.materials)
    cost.particle_bytes += static_cast<std::int64_t>(material.history.bytes());
  begin_sweeps(m);  // columns are there where particles are read, beside the strips
  cost.particle_bytes += static_cast<std::int64_t>(m.work.strips->bytes());
  cost.node_bytes = m.transfer->bytes(m);
  end_sweeps(m);
  const Mesh<D>& whole = m.problem.mesh;
  cost.mesh_bytes = static_cast<std::int64_t>(whole.nodes().size_bytes() + whole.cells().size_bytes()) +
                    whole.n_cells() * static_cast<std::int64_t>((2 + D * (D + 1)) * sizeof(Real)) + bytes(whole.cells_of_node().item) +
                    bytes(whole.ring_of_node().item);
  cost.shared_nodes = find_shared_nodes<D>(whole, m.state.particles, m.state.bodies, [&m](Index c, std::vector<Index>& nodes) {
    m.transfer->add_nodes_of_cell(m.problem.mesh, c, nodes);
  });
  std::erase_if(cost.shared_nodes, [&m](const SharedNodes& pair) {
    return m.problem.contacts.field_of(pair.first) != m.problem.contacts.field_of(pair.second);
  });
  cost.nodes_as_corners = m.transfer->nodes_as_corners(m.problem.own);
  cost.files = file_sizes(view_of(m, first_stage), scene.outputs);
  return cost;
}

template Real first_step<2>(const Mesh<2>&, const Setup<2>&);
template void simulate<2>(const Scene&, Mesh<2>, Setup<2>, const RunCallbacks<2>&, const LoadBalancing<2>&);
template Estimate estimate<2>(const Scene&, Mesh<2>, Setup<2>);
template Real first_step<3>(const Mesh<3>&, const Setup<3>&);
template void simulate<3>(const Scene&, Mesh<3>, Setup<3>, const RunCallbacks<3>&, const LoadBalancing<3>&);
template Estimate estimate<3>(const Scene&, Mesh<3>, Setup<3>);

}  // namespace talus
