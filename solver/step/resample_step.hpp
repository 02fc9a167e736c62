#pragma once
// Splitting and merging of particles between two steps.
#include "solver/model/model.hpp"

namespace talus {

/// Splits and merges particles of bodies whose turn it is after the present step, and books what that changes.  Collective.
template <int D>
void resample_particles(Model<D>& m);

}  // namespace talus
