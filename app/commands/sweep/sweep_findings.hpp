#pragma once
// Statistics over the cases of a study: influence of keys, probability of exceedance, and maps of it.
#include <span>
#include <string>
#include <vector>

#include "app/commands/sweep/sweep_table.hpp"

namespace talus {

/// Spearman's rank correlation of two columns [-]; equal values share their mean rank.  NaN if one of them does not vary.
Real rank_correlation(std::span<const Real> a, std::span<const Real> b);

/// Writes the statistics of the completed cases that the combination of values allows: for samples DIR/correlation.csv and
/// DIR/exceedance_<number>.csv, for one key at a time DIR/tornado_<number>.csv, for maps DIR/exceedance_<map>.tif.  With `pictures` draws
/// charts beside them.  Returns text for the user; reasons for missing results are added to `warnings`.  Throws EnvironmentError.
std::string write_findings(const SweepPlan& plan, const SweepTable& table, bool pictures, std::vector<std::string>& warnings);

}  // namespace talus
