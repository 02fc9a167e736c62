#pragma once
// Parts of a time step that a step of a static stage has as well.
#include "solver/model/model.hpp"

namespace talus {

/// Whether the step can begin on all ranks: every particle has a cell, or a reason to be removed.  Otherwise the particles are in their
/// columns, as they were.
template <int D>
bool locate_particles(Model<D>& m);
/// Unites the fields on both sides of sheets at nodes that no sheet parts.
template <int D>
void unite_sides_of_sheets(Model<D>& m);
/// Adds tractions on facets of the mesh.
template <int D>
void apply_nodal_loads(Model<D>& m);
/// Finds the bodies that take a new reference at the end of the step, by what their particles were at its beginning.  Bodies of one velocity
/// field do so together.
template <int D>
void find_renewed_bodies(Model<D>& m);
/// Averaged volumes are needed before the stress; heat is conducted and strains are averaged after it.
template <int D>
BetweenParts between_parts(Model<D>& m, Real dt);
/// Sets the velocities of the particles in the columns to zero, with their gradients.
template <int D>
void stop_particles(Model<D>& m);
template <int D>
void clear_particle_sums(Model<D>& m);
/// Collects what particles report of their stress and loads.
template <int D>
void record_particle_sums(Model<D>& m);
/// Adds the sums of the step over all ranks to the balances; sets the extremes that bound the next step, and the errors of particles.
template <int D>
void update_balances(Model<D>& m);

}  // namespace talus
