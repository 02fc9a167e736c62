#pragma once
// What several ranks hold, shared out anew in slices of the whole: for files.
#include "core/parallel/slices.hpp"
#include "io/output/vtk.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// The rows of a file that this rank has of the particles of all, which stand in the order of bodies and ids.
template <int D>
struct ParticleSlice {
  State<D> state;                  ///< with these particles alone, in cells of the whole mesh
  std::vector<Body> whole_bodies;  ///< rows of the file
  Slice rows;
};

/// Every rank has to ask.  `piece`: smaller in tests only.
template <int D>
ParticleSlice<D> slice_of_particles(const RunView<D>& view, std::int64_t piece = rows_of_a_piece);

/// f(state, bodies, rows) on all ranks: the state with the particles of the slice, the bodies of the file and which rows of it the particles are.
/// A rank that is alone has its rows as they are.
template <int D, class F>
void on_slices(const RunView<D>& view, F&& f)
{
  if (view.problem.ranks->alone())
    return f(view.state, view.state.bodies, Slice{0, view.state.particles.size()});
  const ParticleSlice<D> slice = slice_of_particles(view);
  f(slice.state, slice.whole_bodies, slice.rows);
}

/// Nodes and cells of the whole mesh.  Every rank has to ask.
template <int D>
MeshSlice slice_of_mesh(const RunView<D>& view, std::int64_t piece = rows_of_a_piece);

/// Of the nodes of the whole mesh, from a column of the nodes held here.  As above.
template <int D>
Column slice_of_column(const RunView<D>& view, Column held, std::int64_t piece = rows_of_a_piece);

/// A number that more than one row of all ranks has in `ids`, the least.  Every rank has to ask.
std::optional<std::int64_t> doubled_id(Communicator& ranks, std::span<const std::int64_t> ids);

extern template ParticleSlice<2> slice_of_particles<2>(const RunView<2>&, std::int64_t);
extern template ParticleSlice<3> slice_of_particles<3>(const RunView<3>&, std::int64_t);
extern template MeshSlice slice_of_mesh<2>(const RunView<2>&, std::int64_t);
extern template MeshSlice slice_of_mesh<3>(const RunView<3>&, std::int64_t);
extern template Column slice_of_column<2>(const RunView<2>&, Column, std::int64_t);
extern template Column slice_of_column<3>(const RunView<3>&, Column, std::int64_t);

}  // namespace talus
