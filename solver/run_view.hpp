#pragma once
// Read-only view of a run for observers.
#include <algorithm>
#include <functional>
#include <span>
#include <string_view>

#include "solver/set_velocities.hpp"
#include "solver/stages.hpp"

namespace talus {

template <int D>
struct RunView {
  const Problem<D>& problem;
  /// Its particles, their ranges in bodies and materials, and the rows of `order` are those of the steps only after fetch_particles();
  /// order.blocks and order.key() always hold.
  const State<D>& state;
  const CellOrder& order;  ///< order of the particles of `state`
  std::span<const VelocityField<D>> fields;
  std::string_view stage_name, stage_kind;
  std::int64_t migrated;          ///< number of particles that moved between this rank and others so far
  std::int64_t nodes_as_corners;  ///< nodes of this rank that the kernel treats as corners, because no positive weights exist there
  /// Loads that acted on particles in the last step, of each group of particles in each block (ParticleStrips::key()); empty in
  /// scenes without such loads.
  std::span<const ParticleLoadSums<D>> loads = {};
  std::span<const ExactSums<ForceAndMoment<D>>> on_surfaces = {};  ///< forces in the last step of each load on a surface, of this rank [N]
  const ParticleStrips<D>* strips = nullptr;                       ///< where the particles are during a stage, if they are in strips
  std::function<void()> fetch_particles = [] {};                   ///< to be called before particles are read during a stage
  /// The particles for a reader of its own, see take_copy(Model): those of `state` are there after fetch_particles() only, again.  Nothing
  /// if they can be read in `state` only.
  std::function<std::optional<ParticleCopy<D>>()> take_copy = [] { return std::optional<ParticleCopy<D>>(); };
  /// Changes the run, see set_velocities(); for its script.  Empty where velocities mean nothing, as in stages without inertia.
  std::function<void(std::span<const Real>, VelocityChange)> set_velocities = {};
};

template <int D>
RunView<D> view_of(const Model<D>& m, const Stage& stage)
{
  return {.problem = m.problem,
          .state = m.state,
          .order = m.work.order,
          .fields = m.work.fields,
          .stage_name = stage.name,
          .stage_kind = stage.kind,
          .migrated = m.work.migration.moved(),
          .nodes_as_corners = m.transfer->nodes_as_corners(m.problem.own),
          .loads = m.work.load_sums,
          .on_surfaces = m.work.on_surfaces,
          .strips = m.work.strips ? &*m.work.strips : nullptr};
}

/// The number of particles on this rank, wherever they are.
template <int D>
Index n_particles(const RunView<D>& view) noexcept
{
  return view.strips != nullptr ? view.strips->size() : view.state.particles.size();
}

/// Memory of a particle [B], of columns and history or of strips; 0 without particles.  Collective.
template <int D>
Real bytes_per_particle(const RunView<D>& view)
{
  std::size_t bytes = bytes_of(view.state.particles);
  for (const Material& material : view.state.materials)
    bytes += material.history.bytes();
  if (view.strips != nullptr)
    bytes = view.strips->bytes();
  return view.problem.ranks->max(static_cast<Real>(bytes) / static_cast<Real>(std::max(n_particles(view), Index{1})));
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
