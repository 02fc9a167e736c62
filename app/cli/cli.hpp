#pragma once
// The command line.

namespace talus {

/// Executes a command line.  Returns 0, 1 (compared results differ) or 2 after a message for an invalid command line; errors of the
/// commands are thrown.
int cli(int argc, const char* const* argv);

}  // namespace talus
