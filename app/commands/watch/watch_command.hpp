#pragma once
// Command talus watch.
#include <filesystem>
#include <optional>

#include "core/types.hpp"

namespace talus {

struct WatchOptions {
  std::filesystem::path folder;
  Real interval = 2;  ///< s
  int port = 0;       ///< 0: any that is free
  bool serve = true, once = false;
  std::optional<std::filesystem::path> page;  ///< template, as above
};
/// Follows a run in the terminal until it ends, and serves its page to browsers on this machine.  Returns what the run returns: 0 done (or,
/// with `once`, at work), 1 failed, 4 stopped.  Errors as above.
int watch_run(const WatchOptions& options);

}  // namespace talus
