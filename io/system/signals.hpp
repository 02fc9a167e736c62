#pragma once
// Requests from outside to stop a run.
#include <string>

namespace talus {

/// While it exists, SIGTERM, SIGINT and SIGUSR1 are recorded instead of ending the process; a second SIGINT ends it.
class StopRequests {
 public:
  StopRequests();
  ~StopRequests();
  StopRequests(const StopRequests&) = delete;
  StopRequests& operator=(const StopRequests&) = delete;
  /// The name of the received signal, such as "SIGTERM"; empty if there was none.
  static std::string received();
};

}  // namespace talus
