#pragma once
// What an observer sees of a run: the model without its kernel, to look at and not to touch.
#include <algorithm>

#include "solver/stages.hpp"

namespace talus {

template <int D>
struct RunView {
  const Mesh<D>& mesh;
  const Subdomain& share;  ///< whose its blocks and nodes are
  const Particles<D>& particles;
  const std::vector<Body>& bodies;
  const std::vector<AnyBatch>& materials;
  const CellOrder& order;
  Communicator* ranks;  ///< that share the run
  const Nodes<D>& nodes;
  const BoundaryConditions<D>& walls;
  const Loads<D>& loads;
  const Clock& clock;
  const StageState& stage;
  std::string_view stage_name;
  Index stage_number;
  const EnergyLedger& energy;  ///< since the beginning of the stage
  const MassLedger<D>& mass;
  const MomentumLedger<D>& momentum;
  const LimitMonitor& watched;
  const RunLimits& guards;
  const Timings& timings;
  Real residual, crossing;
  std::int64_t migrated;          ///< particles that came to this rank or left it so far
  std::int64_t nodes_as_corners;  ///< nodes of this rank that the kernel treats as corners for want of positive weights
};

/// How many nodes of this rank the kernel treats as corners because no positive weights keep linear fields there.
template <int D, Kernel<D> K>
std::int64_t count_nodes_as_corners([[maybe_unused]] const Model<D, K>& m)
{
  if constexpr (requires { m.kernel.nodes_as_corners(); })
    return std::ranges::count_if(m.kernel.nodes_as_corners(), [&](Index n) { return m.own.has(n); });
  else
    return 0;
}

template <int D, Kernel<D> K>
RunView<D> frame_of(const Model<D, K>& m, const Stage& stage)
{
  return {.mesh = m.mesh,
          .share = m.share,
          .particles = m.particles,
          .bodies = m.bodies,
          .materials = m.materials,
          .order = m.order,
          .ranks = m.ranks,
          .nodes = m.nodes,
          .walls = m.walls,
          .loads = m.loads,
          .clock = m.clock,
          .stage = m.stage,
          .stage_name = stage.name,
          .stage_number = m.stage.number,
          .energy = m.energy,
          .mass = m.mass,
          .momentum = m.momentum,
          .watched = m.watched,
          .guards = m.guards,
          .timings = m.timings,
          .residual = m.residual,
          .crossing = m.crossing,
          .migrated = m.migration.moved(),
          .nodes_as_corners = count_nodes_as_corners(m)};
}

/// Columns and history of a particle [B]; 0 where there is none.  Every rank has to ask.
template <int D>
Real bytes_per_particle(const RunView<D>& frame)
{
  std::size_t bytes = 0;
  frame.particles.for_each_column(
      [&](std::string_view, std::string_view, const auto& column) { bytes += column.size() * sizeof(column[0]); });
  for (const AnyBatch& material : frame.materials)
    std::visit([&](const auto& batch) { bytes += batch.history.size() * sizeof(batch.history[0]); }, material);
  return frame.ranks->max(static_cast<Real>(bytes) / static_cast<Real>(std::max(frame.particles.size(), Index{1})));
}

/// The body of a particle row.
inline std::size_t body_of(const std::vector<Body>& bodies, Index row)
{
  std::size_t b = 0;
  while (row >= bodies[b].end)
    ++b;
  return b;
}

}  // namespace talus
