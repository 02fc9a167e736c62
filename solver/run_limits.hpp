#pragma once
// Limits of a run that no valid state passes: particles faster than anything could make them, energy that no work was done for, mass that
// nodes and particles do not agree on.  What a single particle reports is in core/particle_errors.hpp.
#include <optional>
#include <string>

#include "solver/model/model.hpp"
#include "solver/stable_step.hpp"

namespace talus {

/// A particle in words: `particle 3311 of "dam" (scenes/dam.yaml:31) at (4.2, 0.1)`.
template <int D>
std::string describe(const Particles<D>& particles, const std::vector<Body>& bodies, Index row);

/// Of the particles that the ranks have chosen the one with the least value, in words.  Every rank has to ask.
template <int D>
std::string describe_least(const Model<D>& m, const Chosen& here);

/// Kinetic and strain energy and what the laws dissipated, of deleted particles too, beyond all that was there or was put in, over the
/// largest of the terms. Those of the stages before count there: in a body that is at rest under its stress all terms of a stage are as
/// small as what the last step leaves open.
template <int D>
Real energy_gain(const Model<D>& m, Real kinetic);

enum class Look : std::uint8_t { between_steps, at_end_of_stage };

/// Compares the state after a step with the limits and notes the extremes.  Returns in words the limit that stops the run, nothing if there is
/// none.  Sums over all particles are looked at every so many steps, since errors grow over tens of them, and at the end of a stage.
template <int D>
std::optional<std::string> exceeded_limit(Model<D>& m, Look look);

}  // namespace talus
