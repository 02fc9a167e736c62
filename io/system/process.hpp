#pragma once
// What the process does before the first command and after the last word.
#include <string>

namespace talus {

/// First thing in main(): standard streams that are closed lead nowhere, so that no file gets their numbers and what is printed; a file that
/// grows beyond what the system allows is an error of that write and not the end of the program; more threads than the machine can use are not
/// started; a fault, or a library that ends the program, does not go without a word.
void prepare_process();

/// The program is about to end by itself, with a code of its own.
void leave_process() noexcept;

/// Ends the process without tidying up: a library that found no memory may find its own data in disorder then.
[[noreturn]] void end_at_once(int code) noexcept;

/// Why what was printed has not arrived on standard output; empty if it has.
std::string unwritten_output();

/// As many threads as this machine can have some use of: four a processor, and 16 where it has few, so that what does not depend on their number
/// can be tried anywhere.
int most_threads() noexcept;

/// So many threads from now on, but no more than most_threads(); then a warning says what asked for more.
void use_threads(int wanted, const std::string& asked_by);

}  // namespace talus
