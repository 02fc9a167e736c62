#pragma once
// Particles dealt out anew among the ranks, whoever has them: for files, and for a start from files.
#include "core/parallel/communicator.hpp"
#include "core/particles.hpp"
#include "materials/interface/material.hpp"
#include "mesh/part.hpp"

namespace talus {

/// Gives each row to a rank, with all that is its: columns and history.  Every rank has to take part.  Afterwards rows stand in the order of
/// bodies and ids, whoever had them, and columns that any rank keeps are kept by all; cells are what they were, numbers of the whole mesh
/// as a rule.  Column by column: besides the particles there is room needed for one column only.
template <int D>
void redistribute(Communicator& ranks, std::span<const int> rank_of_row, std::vector<Body>& bodies, std::vector<Material>& materials,
                  Particles<D>& particles);

/// Gives each row, of a cell of the whole mesh, to the rank whose cell it is, and to the cell of its part.  As above.
template <int D>
void receive_owned_particles(Communicator& ranks, const Subdomain& subdomain, std::vector<Body>& bodies, std::vector<Material>& materials,
                             Particles<D>& particles);

}  // namespace talus
