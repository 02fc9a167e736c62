#pragma once
// Steps without inertia: increments whose equilibrium is solved for.
#include <optional>
#include <string>

#include "solver/model/model.hpp"
#include "solver/options/equilibrium_options.hpp"

namespace talus {

/// Makes the next increment of a stage that is `full` [s] long where nothing is cut and of which `left` [s] are left: shorter where it is
/// not solved, and longer again where it is easy.  Nothing where it was solved, or where particles report errors; otherwise why not, and
/// the model as it was.  Collective.
template <int D>
std::optional<std::string> make_increment(Model<D>& m, const EquilibriumOptions& options, Real full, Real left);

}  // namespace talus
