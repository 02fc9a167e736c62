#pragma once
// What the cases of a study say together: which key matters how much, how likely a number is exceeded, and where on the map.
#include <span>
#include <string>
#include <vector>

#include "app/commands/sweep/sweep_table.hpp"

namespace talus {

/// Spearman's correlation of the ranks of two columns [-]; equal values share their mean rank.  NaN where one of them does not vary.
Real rank_correlation(std::span<const Real> a, std::span<const Real> b);

/// Writes what the way in which values were combined allows, from the cases that are done: of samples DIR/correlation.csv and
/// DIR/exceedance_<number>.csv, of one key at a time DIR/tornado_<number>.csv, of maps DIR/exceedance_<map>.tif.  With `pictures` draws the curves and
/// bars beside them.  Returns words for people; what keeps something from being made is added to `warnings`.  EnvironmentError.
std::string write_findings(const SweepPlan& plan, const SweepTable& table, bool pictures, std::vector<std::string>& warnings);

}  // namespace talus
