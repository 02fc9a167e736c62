#pragma once
// What `talus bench` prints.
#include "io/output/bench_json.hpp"

namespace talus {

/// Program, machine and its limits.
std::string heading(const BenchReport& report);

/// A line of names, then one per result, then what the columns mean.
std::string table(const std::vector<BenchResult>& results);

/// The same for a case and its options, whose differences to the first one count.
std::string option_table(const std::vector<BenchResult>& results);

/// Time now over time then for each setting that both have, marked where the repeats of the one do not reach those of the other.
std::string comparison(const BenchReport& now, const BenchReport& then);

}  // namespace talus
