#pragma once
// The command line.

namespace talus {

/// Does what the words say.  0, 1 (what was compared differs) or 2 with a message for words that make no sense; the errors of the commands pass through.
int cli(int argc, const char* const* argv);

}  // namespace talus
