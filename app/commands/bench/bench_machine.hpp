#pragma once
// What the memory and the cores of this machine can do at best: the scale that `talus bench` measures against.
#include "io/output/bench_json.hpp"

namespace talus {

/// Best of some passes with that many threads.  Takes 400 MB while it runs.
MachineLimit measure_machine(int n_threads);

/// As /proc/cpuinfo names it, or "unknown".
std::string processor_name();

}  // namespace talus
