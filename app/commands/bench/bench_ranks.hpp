#pragma once
// `talus bench --mpi`: one case on several ranks, to see what sharing it costs.
#include "app/commands/bench/bench_command.hpp"

namespace talus {

/// Runs it on the ranks of this process, prints a table and writes a file if asked to: both on the root.  Every rank has to ask.
void bench_ranks(const BenchOptions& options);

}  // namespace talus
