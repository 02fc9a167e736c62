#pragma once
// Memory: a scene that needs more than is available is refused, before the system kills the program.
#include <filesystem>
#include <string>

#include "core/types.hpp"

namespace talus {

/// The memory that this process can still allocate [B]: the least of the free memory of the machine (without swap), the limits of its
/// control groups, and `ulimit -v`; infinity if unknown.  `root` is that of /proc and /sys.
Real available_memory(const std::filesystem::path& root = "/");

/// The largest memory of this process so far [B]; 0 if unknown.
Real peak_memory(const std::filesystem::path& root = "/");

/// From now on memory that is freed stays with the process, for its next use.  For arrays that are made and freed in every step: each page
/// that comes from the system anew costs a fault, ten times as long as the copy that is written into it.
void keep_freed_memory() noexcept;

/// The reason why a number of items needs too much memory, such as "asks for 6e+09 particles, which need at least 2600 GB of memory; 12.3
/// GB are there"; empty if it does not.  `bytes`: least memory of one item.
std::string too_many(Real items, const std::string& what, Real bytes);

}  // namespace talus
