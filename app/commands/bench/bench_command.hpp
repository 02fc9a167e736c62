#pragma once
// Command talus bench.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct BenchOptions {
  std::vector<std::string> kernels, transfers, laws, precisions;
  std::vector<int> dimensions, threads, per_cell;
  bool all = false;      ///< the whole product
  bool options = false;  ///< what one case costs with each option of a scene
  bool ranks = false;    ///< one case on the ranks that this process is one of
  Index particles = 1'000'000;
  int warm_up = 10, repeats = 3, steps = 5;
  std::optional<std::filesystem::path> json, from, compare;
};
/// Measures the speed of whole steps and prints a table; with `from` shows what a file has.  SceneErrors for words and files that mean
/// nothing.
void bench(const BenchOptions& options);

/// `talus bench --mpi`: one case on the ranks of this process, to see what sharing it costs.  Prints a table and writes a file if asked to: both
/// on the root.  Every rank has to ask.
void bench_ranks(const BenchOptions& options);

/// The processor as /proc/cpuinfo names it, or "unknown".
std::string processor_name();

}  // namespace talus
