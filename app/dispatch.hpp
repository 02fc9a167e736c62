#pragma once
// Bodies of the functions in simulate.hpp; simulate_2d.cpp and simulate_3d.cpp compile them for every kernel of one dimension.
#include <stdexcept>

#include "app/simulate.hpp"
#include "core/exchange.hpp"
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

/// Blocks are shared out by their particles, which stand in cells of the whole mesh.  Every rank has to ask.
template <int D>
Part<D> part_of(const Mesh<D>& mesh, const Particles<D>& particles, int rings)
{
  std::vector<std::int64_t> weights(static_cast<std::size_t>(blocks_of(mesh.n_cells())), 0);
  for (const Index cell : particles.cell)
    ++weights[static_cast<std::size_t>(cell / block_cells)];
  world().sum(weights);
  return cut(mesh, partition(mesh, weights, world().size()), world().rank(), rings);
}

/// The model of a rank: of the whole where it is alone.
template <int D, Kernel<D> K>
Model<D, K> build(const Scene& scene, Mesh<D> mesh, Setup<D> setup)
{
  Options<K> options;
  options_of(scene, options);
  Share share;
  if (!world().alone()) {
    Part<D> part = part_of(mesh, setup.particles, rings_held<D, K>);
    share = std::move(part.share);
    mesh = std::move(part.mesh);
    send_home(world(), share, setup.bodies, setup.materials, setup.particles);
    restrict_to(share, setup);
  }
  std::optional<Model<D, K>> built;
  world().agree(Exchange::caught([&] {
    try {
      built.emplace(std::move(mesh), options);
    } catch (const std::invalid_argument& e) {
      throw SceneErrors(scene.mesh.where, fmt::format("kernel \"{}\": {}", scene.kernel, e.what()));
    }
  }));
  Model<D, K>& m = *built;
  if (!world().alone())
    m.join(world(), std::move(share));
  m.particles = std::move(setup.particles);
  m.bodies = std::move(setup.bodies);
  m.materials = std::move(setup.materials);
  m.walls = std::move(setup.walls);
  m.loads = std::move(setup.loads);
  m.transfer = setup.transfer;
  m.exits = std::move(setup.exits);
  m.guards = setup.guards;
  make_ready(m);
  return std::move(m);
}

template <int D>
Real first_step(const Mesh<D>& mesh, const Setup<D>& setup)
{
  return std::min(setup.limits.cfl * shortest_crossing(mesh, setup.materials, setup.particles), setup.limits.longest);
}

template <int D>
void simulate(const Scene& scene, Mesh<D> mesh, Setup<D> setup, const Audience<D>& audience)
{
  const auto stages = setup.stages;
  const auto limits = setup.limits;
  with_kernel<D>(scene.kernel, [&]<class K>() {
    auto m = build<D, K>(scene, std::move(mesh), std::move(setup));
    const auto stage_at_hand = [&](const Model<D, K>& model) -> const Stage& {
      return stages[static_cast<std::size_t>(model.stage.number)];
    };
    const auto watch = [&](const Model<D, K>& model, Moment moment) { audience.watch(frame_of(model, stage_at_hand(model)), moment); };
    const auto stage_done = [&](const StageResult& result) { audience.stage_done(frame_of(m, stage_at_hand(m)), result); };
    Index number = 0;
    if (audience.take_over) {
      audience.take_over(state_of(m));
      adopt_state(m);
    }
    audience.ready(frame_of(m, stage_at_hand(m)));
    if (audience.take_over) {
      if (!m.stage.done)
        stage_done(finish_stage(m, stage_at_hand(m), limits, watch));
      number = m.stage.number + 1;
    }
    for (; number < static_cast<Index>(stages.size()); ++number)
      stage_done(run_stage(m, stages[static_cast<std::size_t>(number)], limits, watch, number));
  });
}

template <int D>
Estimate estimate(const Scene& scene, Mesh<D> mesh, Setup<D> setup)
{
  Estimate cost{};
  cost.dt = first_step(mesh, setup);
  for (const Stage& stage : setup.stages)
    cost.steps += static_cast<std::int64_t>(std::ceil(stage.duration / cost.dt));
  with_kernel<D>(scene.kernel, [&]<class K>() {
    const auto m = build<D, K>(scene, std::move(mesh), std::move(setup));
    const auto bytes = [](const auto& column) { return static_cast<std::int64_t>(column.size() * sizeof(column[0])); };
    m.particles.for_each_column([&](std::string_view, std::string_view, const auto& column) { cost.particle_bytes += bytes(column); });
    for (const AnyBatch& material : m.materials)
      std::visit([&](const auto& batch) { cost.particle_bytes += bytes(batch.history); }, material);
    cost.mesh_bytes = static_cast<std::int64_t>(m.mesh.nodes().size_bytes() + m.mesh.cells().size_bytes()) +
                      m.mesh.n_cells() * static_cast<std::int64_t>((2 + D * (D + 1)) * sizeof(Real)) + bytes(m.mesh.cells_of_node().item) +
                      bytes(m.mesh.ring_of_node().item);
    cost.node_bytes =
        bytes(m.nodes.sum) + bytes(m.nodes.motion) + bytes(m.hats.sum) + bytes(m.hats.motion) + bytes(m.blocks.row) + bytes(m.blocks.slot);
    if constexpr (HasNodePart<K, D>)
      cost.node_bytes += static_cast<std::int64_t>(m.kernel.node_part().size_bytes());
  });
  return cost;
}

}  // namespace talus
