#pragma once
#include <span>

#include "app/commands/fos/fos_search.hpp"
#include "app/commands/fos/fos_trials.hpp"

namespace talus {

/// Draws displacement and its growth over the factor, and the bodies at the lowest factor that fails.  Throws Error.
void draw_fos(const FosPlan& plan, std::span<const FosTrial> trials, const Bracket& bracket);

}  // namespace talus
