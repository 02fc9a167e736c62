#pragma once
// What `talus bench --mpi` measured, and its file.
#include <string>
#include <vector>

#include "io/output/bench_json.hpp"

namespace talus {

struct RanksReport {
  std::string version, commit, compiler, build, processor;
  int cores{};  ///< of the machine of the root
  BenchSetting setting;
  std::int64_t particles{}, cells{}, nodes{};  ///< of the whole
  int steps{};                                 ///< of a repeat
  Measured seconds;                            ///< of a step on the slowest rank, over the repeats
  /// Of each rank: what it owns, holds, sends in a step; seconds of a step by phase in the repeat whose time is the median.
  std::vector<std::string> columns;
  std::vector<std::vector<Real>> ranks;
};

/// Writes the file as a whole or not at all; EnvironmentError naming it.
void write_ranks(const std::filesystem::path& file, const RanksReport& report);

}  // namespace talus
