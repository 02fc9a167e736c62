#pragma once
// The algorithm: one explicit time step.
#include "solver/model/model.hpp"

namespace talus {

/// One step of length dt [s] from t = m.state.clock.time on: a leap-frog, docs/theory/algorithm.md.  Positions, stress and all loads are
/// those of t.  Forces act from the time of the old velocities, t - clock.lag, to that of the new ones, t + dt/2, which is also the time of
/// prescribed velocities.  With the new velocities particles move and strain from t to t + dt.  Afterwards m.work.errors tells whether the
/// state is valid.
template <int D>
void advance(Model<D>& m, Real dt);
/// The same, but afterwards the particles may be in strips, ready for the next step: see begin_sweeps().  The result is bitwise identical.
template <int D>
void make_step(Model<D>& m, Real dt);

}  // namespace talus
