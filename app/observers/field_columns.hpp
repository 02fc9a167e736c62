#pragma once
// Output fields of particles and nodes as columns of files.
#include "io/output/vtk.hpp"
#include "io/scene/scene_output.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// The fields in particle files: the requested ones, the one of the pictures, body and volume.
std::vector<std::string> particle_fields_of(const OutputSpec& outputs);

/// A field of all particles of a state in the order of `rows`.  Names: those of particle_fields() in io/output/output_fields.hpp, and every history
/// variable of a law in the run, which is 0 for bodies whose law does not have it.  Throws std::invalid_argument for any other name.
template <int D>
Column particle_column(const Problem<D>& problem, const State<D>& state, std::span<const Index> rows, std::string_view name);

/// A field of all nodes.  Names: those of node_fields(); throws std::invalid_argument for any other.
template <int D>
Column node_column(const RunView<D>& view, std::string_view name);

/// Rows in the order of their ids, which does not change during a run.
template <int D>
std::vector<Index> rows_by_id(const Particles<D>& particles);

/// The positions, three numbers per particle [m].
template <int D>
std::vector<Real> positions(const Particles<D>& particles, std::span<const Index> rows);

}  // namespace talus
