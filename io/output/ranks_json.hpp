#pragma once
// The results of `talus bench --mpi`, and their file.
#include <string>
#include <vector>

#include "io/output/bench_json.hpp"

namespace talus {

struct RanksReport {
  std::string version, commit, compiler, build, processor;
  int cores{};  ///< cores of the root's machine
  BenchSetting setting;
  std::int64_t particles{}, cells{}, nodes{};  ///< numbers of the whole model
  int steps{};                                 ///< steps of a repeat
  Measured seconds;                            ///< time of a step on the slowest rank, over the repeats [s]
  /// Columns for each rank: what it owns, holds and sends in a step; seconds of a step by phase in the repeat with the median time.
  std::vector<std::string> columns;
  std::vector<std::vector<Real>> ranks;
};

/// Writes the file atomically; throws EnvironmentError with its name.
void write_ranks(const std::filesystem::path& file, const RanksReport& report);

}  // namespace talus
