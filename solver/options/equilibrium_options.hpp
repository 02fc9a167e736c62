#pragma once
// How a stage solves for equilibrium.
#include <optional>

#include "core/types.hpp"

namespace talus {

struct EquilibriumOptions {
  int increments = 10;   ///< in which its loads act, unless one is too large
  Real residual = 1e-8;  ///< of the equations of an increment: unbalanced force over the loads [-]
  /// The stage fails if at its end more is out of balance for the steps behind it: unbalanced force over the loads [-].
  std::optional<Real> most_unbalanced{};
  bool keeps_jump_stress = true;  ///< from one increment to the next, see JumpForces
  int most_iterations = 50;       ///< of Newton's method in an increment
  int most_cuts = 10;             ///< of an increment that is not solved, in halves
};

}  // namespace talus
