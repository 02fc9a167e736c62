#pragma once
// Names the law of the user in which the process ends.

namespace talus {

/// Writes to standard error which law of the user this thread was calling: of which library, for which particles, when.  `signal`: the fault; 0
/// if the process ends by exit(); SIGINT if it is ended from outside, for which it looks at other threads as well.  False, and nothing written, if it was calling none.  For handlers of signals: it allocates nothing.
bool write_law_at_work(int signal) noexcept;

}  // namespace talus
