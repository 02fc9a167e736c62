#pragma once
// Redistribution of the data of several ranks into slices of the whole, for files.
#include "core/parallel/slices.hpp"
#include "io/output/vtk.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// The rows of a file on this rank: a slice of the particles of all ranks, in the order of bodies and ids.
template <int D>
struct ParticleSlice {
  State<D> state;                  ///< with these particles only, in cells of the whole mesh
  std::vector<Body> whole_bodies;  ///< ranges of bodies in rows of the file
  Slice rows;
};

/// Makes the slice.  `piece`: smaller in tests only.  Collective.
template <int D>
ParticleSlice<D> slice_of_particles(const RunView<D>& view, std::int64_t piece = rows_of_a_piece);

/// Calls f(state, bodies, rows) on all ranks: the state with the particles of the slice, the bodies of the file, and the rows of these
/// particles in the file.  A single rank passes its rows directly.
template <int D, class F>
void on_slices(const RunView<D>& view, F&& f)
{
  if (view.problem.ranks->alone())
    return f(view.state, view.state.bodies, Slice{0, view.state.particles.size()});
  const ParticleSlice<D> slice = slice_of_particles(view);
  f(slice.state, slice.whole_bodies, slice.rows);
}

/// The part of the mesh that this rank writes, in the numbers of the whole.  Collective.
template <int D>
MeshSlice slice_of_mesh(const RunView<D>& view, std::int64_t piece = rows_of_a_piece);

/// A column of the nodes of the whole mesh for the slice of this rank, from a column of the nodes on this rank.  Collective.
template <int D>
Column slice_of_column(const RunView<D>& view, Column held, std::int64_t piece = rows_of_a_piece);

/// The smallest number that occurs in more than one row of all ranks.  Collective.
std::optional<std::int64_t> doubled_id(Communicator& ranks, std::span<const std::int64_t> ids);

}  // namespace talus
