#pragma once
// Command talus bench, and which settings it runs.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"
#include "io/output/bench_json.hpp"

namespace talus {

struct BenchOptions {
  std::vector<std::string> kernels, transfers, laws;
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

/// A short list of what is used most, without any word from the command line; with words their product, where an axis without a word
/// keeps its usual values, or has all it can have (`all`).  SceneErrors naming words that mean nothing.
std::vector<BenchSetting> bench_settings(const BenchOptions& options, int all_threads);

/// The first word of each axis, or the most usual one.  SceneErrors as above.
BenchSetting one_setting(const BenchOptions& options);

/// One setting alone, twice, then with each option.
std::vector<BenchSetting> option_settings(const BenchOptions& options);

/// "projected aflip neo_hookean 3-D 8 a cell 1 thread", with the option behind.
std::string describe(const BenchSetting& setting);

}  // namespace talus
