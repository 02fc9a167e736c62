#pragma once
// Velocities that a script gives particles between two steps.
#include <span>

#include "solver/model/model.hpp"

namespace talus {

/// When velocities are set.
enum class VelocityChange : std::uint8_t {
  at_start,      ///< before the first step: they are those with which the run begins
  between_steps  ///< the change is work of loads, and of momentum it is one as by a stage
};

/// Gives all particles of this rank these velocities, D numbers each [m/s], in the order of their columns, see copy_to_columns().  The balances
/// of energy and momentum stay closed.  For one rank.
template <int D>
void set_velocities(Model<D>& m, std::span<const Real> values, VelocityChange change);

}  // namespace talus
