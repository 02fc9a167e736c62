#pragma once
// Preparation of the process before the first command, and its end.
#include <string>

namespace talus {

/// To be called first in main().  Closed standard streams are opened to /dev/null, so that no file gets their numbers and with them the
/// printed text; a file beyond the size limit of the system is an error of that write instead of the end of the program; the number of
/// threads is limited to what the machine can use; a crash, or a library that ends the program, leads to a message.
void prepare_process();

/// To be called when the program is about to end itself, with its own exit code.
void leave_process() noexcept;

/// Ends the process without destructors: after a failed allocation the data of a library may be invalid.
[[noreturn]] void end_at_once(int code) noexcept;

/// The reason why printed text has not reached standard output; empty if it has.
std::string unwritten_output();

/// The largest useful number of threads on this machine: four per processor, but at least 16, so that results for any number of threads can
/// be tested anywhere.
int most_threads() noexcept;

/// Sets the number of threads, limited to most_threads() with a warning that names `asked_by`.
void use_threads(int wanted, const std::string& asked_by);

}  // namespace talus
