#pragma once
// How much memory there is, so that a scene that asks for more is refused before the system ends the program without a word.
#include <filesystem>
#include <string>

#include "core/types.hpp"

namespace talus {

/// Memory that this process can still take [B]: what the machine has to spare (swap not counted), what its control groups allow, what
/// `ulimit -v` leaves, whichever is least; infinity where nobody tells.  `root` is that of /proc and /sys.
Real available_memory(const std::filesystem::path& root = "/");

/// Most memory that this process has held [B]; 0 where nobody tells.
Real peak_memory(const std::filesystem::path& root = "/");

/// Why so many items are too many, such as "asks for 6e+09 particles, which need at least 2600 GB of memory; 12.3 GB are there"; empty
/// if they are not.  `bytes`: of one, at least.
std::string too_many(Real items, const std::string& what, Real bytes);

}  // namespace talus
