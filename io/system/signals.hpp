#pragma once
// Requests from outside to stop a run.
#include <string>

namespace talus {

/// While this lives, SIGTERM, SIGINT and SIGUSR1 are noted instead of ending the process; a second SIGINT ends it.
class StopRequests {
 public:
  StopRequests();
  ~StopRequests();
  StopRequests(const StopRequests&) = delete;
  StopRequests& operator=(const StopRequests&) = delete;
  /// Name of the signal that came, such as "SIGTERM"; empty while none has.
  static std::string received();
};

}  // namespace talus
