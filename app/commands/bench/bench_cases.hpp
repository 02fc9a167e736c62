#pragma once
// Which settings `talus bench` runs.
#include "app/commands/bench/bench_command.hpp"
#include "io/output/bench_json.hpp"

namespace talus {

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
