#pragma once
// What a summary says of bodies and of ranks.
#include "io/output/run_summary.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// What body b consists of now.  Collective.
template <int D>
BodySummary summary_of(const RunView<D>& view, std::size_t b);

/// Statistics of the ranks since `begin`, when `step_begin` steps had been done.  Collective.
template <int D>
RanksSummary ranks_of(const RunView<D>& view, const Traffic& begin, std::int64_t step_begin);

}  // namespace talus
