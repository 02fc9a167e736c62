#pragma once
// What several ranks hold, shared out anew in slices of the whole: for files.
#include "core/parallel/slices.hpp"
#include "io/output/vtk.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// The rows of a file that this rank has of the particles of all, which stand in the order of bodies and ids.
template <int D>
struct ParticleSlice {
  Particles<D> particles;  ///< in cells of the whole mesh
  std::vector<Body> bodies;
  std::vector<AnyBatch> materials;
  std::vector<Body> whole_bodies;  ///< rows of the file
  Slice rows;
};

/// Every rank has to ask.  `piece`: smaller in tests only.
template <int D>
ParticleSlice<D> slice_of_particles(const RunView<D>& frame, std::int64_t piece = rows_of_a_piece);

/// f(frame, bodies, rows) on all ranks: a frame whose particles are those of the slice, without an order, the bodies of the file and which rows
/// of it the particles are.  The mesh and what is on it are those of each rank.  A rank that is alone has its rows as they stand.
template <int D, class F>
void on_slices(const RunView<D>& frame, F&& f)
{
  if (frame.ranks->alone())
    return f(frame, frame.bodies, Slice{0, frame.particles.size()});
  const ParticleSlice<D> slice = slice_of_particles(frame);
  const CellOrder no_order;
  f(RunView<D>{.mesh = frame.mesh,
               .share = frame.share,
               .particles = slice.particles,
               .bodies = slice.bodies,
               .materials = slice.materials,
               .order = no_order,
               .ranks = frame.ranks,
               .nodes = frame.nodes,
               .walls = frame.walls,
               .loads = frame.loads,
               .clock = frame.clock,
               .stage = frame.stage,
               .stage_name = frame.stage_name,
               .stage_number = frame.stage_number,
               .energy = frame.energy,
               .mass = frame.mass,
               .momentum = frame.momentum,
               .watched = frame.watched,
               .guards = frame.guards,
               .timings = frame.timings,
               .residual = frame.residual,
               .crossing = frame.crossing,
               .migrated = frame.migrated,
               .nodes_as_corners = frame.nodes_as_corners},
    slice.whole_bodies, slice.rows);
}

/// Nodes and cells of the whole mesh.  Every rank has to ask.
template <int D>
MeshSlice slice_of_mesh(const RunView<D>& frame, std::int64_t piece = rows_of_a_piece);

/// Of the nodes of the whole mesh, from a column of the nodes held here.  As above.
template <int D>
Column slice_of_column(const RunView<D>& frame, Column held, std::int64_t piece = rows_of_a_piece);

/// A number that more than one row of all ranks has in `ids`, the least.  Every rank has to ask.
std::optional<std::int64_t> doubled_id(Communicator& ranks, std::span<const std::int64_t> ids);

extern template ParticleSlice<2> slice_of_particles<2>(const RunView<2>&, std::int64_t);
extern template ParticleSlice<3> slice_of_particles<3>(const RunView<3>&, std::int64_t);
extern template MeshSlice slice_of_mesh<2>(const RunView<2>&, std::int64_t);
extern template MeshSlice slice_of_mesh<3>(const RunView<3>&, std::int64_t);
extern template Column slice_of_column<2>(const RunView<2>&, Column, std::int64_t);
extern template Column slice_of_column<3>(const RunView<3>&, Column, std::int64_t);

}  // namespace talus
