#pragma once
// Steps without inertia: increments whose equilibrium is solved for.
#include <optional>
#include <string>

#include "solver/model/model.hpp"
#include "solver/options/equilibrium_options.hpp"

namespace talus {

/// How much of a stage its short increments at the end cover [s], where nothing is cut `full` [s] long: nothing where stress contains rates of
/// strain, which would be large in them, or where there is no stress against jumps to balance.
template <int D>
Real time_of_short_increments(const Model<D>& m, const EquilibriumOptions& options, Real full);

/// Makes the next increment of a stage that is `full` [s] long where nothing is cut and of which `left` [s] are left: shorter where it is
/// not solved, and longer again where it is easy, and very short at the end.  Nothing where it was solved, where particles report errors, or
/// where a short one at the end was not solved and so moves nothing; otherwise why not, and the model as it was.  Collective.
template <int D>
std::optional<std::string> make_increment(Model<D>& m, const EquilibriumOptions& options, Real full, Real left);

}  // namespace talus
