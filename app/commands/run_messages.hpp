#pragma once
// What a run says on the terminal while it goes on.
#include <string>
#include <string_view>
#include <vector>

#include "app/run/simulate.hpp"
#include "app/setup/stage_changes.hpp"

namespace talus {

/// What a stage has changed, as lines for the summary; warnings are added to the others.  Said by the root, the former unless it is `quiet`.
std::vector<std::string> tell_changes(Real time, std::string_view stage, const StageReport& news, bool quiet,
                                      std::vector<std::string>& warnings);

/// By the root.
void say_rebalanced(const Rebalanced& by);

}  // namespace talus
