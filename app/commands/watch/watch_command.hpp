#pragma once
// Command talus watch.
#include <filesystem>
#include <optional>

#include "core/types.hpp"

namespace talus {

struct WatchOptions {
  std::filesystem::path folder;
  Real interval = 2;  ///< seconds between updates
  int port = 0;       ///< 0: any free port
  bool serve = true, once = false;
  std::optional<std::filesystem::path> page;  ///< template, as for `talus report`
};
/// Follows a run in the terminal until it ends, and serves its page to browsers on this machine.  Returns the exit code of the run: 0 done
/// (or, with `once`, at work), 1 failed, 4 stopped.  Errors as for write_report().
int watch_run(const WatchOptions& options);

}  // namespace talus
