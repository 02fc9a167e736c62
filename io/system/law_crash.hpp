#pragma once
// Names the law of the user in which the process crashes.

namespace talus {

/// From now on a crash (SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT) in a law of the user writes which law it was, of which library, at which particles
/// and when, before it ends the process.  Signals for which there is a handler keep it.
void name_laws_in_crashes();

}  // namespace talus
