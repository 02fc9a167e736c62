// POSIX: descriptors, signals, and the end of the process.
#include "io/system/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string_view>
#include <thread>

#include "core/library_call.hpp"
#include "core/parallel/communicator.hpp"
#include "core/parallel/threads.hpp"
#include "io/system/law_crash.hpp"

namespace talus {

namespace {

constexpr int law_wrong = 1, environment_wrong = 3;
volatile std::sig_atomic_t leaving = 0;

void write_error(std::string_view text) noexcept
{
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
}

/// The number of processors that this process may use.
int processors() noexcept { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

/// Ends the program with a message after a failure inside a library.
[[noreturn]] void end_in_library() noexcept
{
  write_error("error: the program was ended by a library (");
  write_error(library_at_work().empty() ? std::string_view("none that it called by itself") : library_at_work());
  write_error("), as some do where memory runs out; what is written so far is whole\n");
  ::_exit(environment_wrong);
}

extern "C" [[maybe_unused]] void at_fault(int number)
{
  if (!library_at_work().empty())
    end_in_library();
  if (!write_law_at_work(number)) {
    std::array<char, 8> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    write_error("error: a fault, signal ");
    write_error({digits.data(), static_cast<std::size_t>(end - digits.data())});
    write_error(": a mistake in the program, or in a library that found no memory; what is written so far is whole\n");
  }
  std::signal(number, SIG_DFL);
  std::raise(number);
}

extern "C" void at_exit(int, void*)
{
  if (leaving != 0)
    return;
  if (write_law_at_work(0))
    ::_exit(law_wrong);
  end_in_library();
}

volatile std::sig_atomic_t memory_ran_out = 0;

[[noreturn]] void at_lack_of_memory()
{
  memory_ran_out = 1;
  throw std::bad_alloc();
}

[[noreturn]] void end_without_memory() noexcept
{
  write_error("error: not enough memory\n");
  ::_exit(environment_wrong);
}

/// An exception that leaves a noexcept function of a library, as in some functions of libstdc++ for folders, is not the current exception
/// here.
[[noreturn]] void at_terminate()
{
  if (const std::exception_ptr error = std::current_exception())
    try {
      std::rethrow_exception(error);
    } catch (const std::bad_alloc&) {
      end_without_memory();
    } catch (...) {  // NOLINT(bugprone-empty-catch): the program ends as it would have
    }
  else if (memory_ran_out != 0 && std::uncaught_exceptions() > 0)
    end_without_memory();
  std::abort();
}

}  // namespace

void prepare_process()
{
  for (int handle = ::open("/dev/null", O_RDWR); handle >= 0; handle = ::open("/dev/null", O_RDWR))
    if (handle > STDERR_FILENO) {
      ::close(handle);
      break;
    }
  std::signal(SIGXFSZ, SIG_IGN);  // then the write fails with EFBIG
  std::set_new_handler(at_lack_of_memory);
  std::set_terminate(at_terminate);
  ::on_exit(at_exit, nullptr);
#ifndef __SANITIZE_ADDRESS__  // the sanitizer has its own handlers
  static std::array<char, 65536> stack{};
  stack_t other{};
  other.ss_sp = stack.data(), other.ss_size = stack.size();
  ::sigaltstack(&other, nullptr);
  struct sigaction action {};
  action.sa_handler = at_fault;
  action.sa_flags = SA_ONSTACK | static_cast<int>(SA_RESETHAND);
  for (const int number : {SIGSEGV, SIGBUS, SIGABRT, SIGILL, SIGFPE})
    ::sigaction(number, &action, nullptr);
#endif
  if (threads() > most_threads())
    use_threads(threads(), "OMP_NUM_THREADS");
}

int most_threads() noexcept { return 4 * std::max(4, processors()); }

void use_threads(int wanted, const std::string& asked_by)
{
  const int most = most_threads();
  set_threads(std::min(wanted, most));
  if (wanted > most && world().is_root())
    fmt::print(stderr, "warning: {} asks for {} threads, of which {} are used: this machine has {} processor{}\n", asked_by, wanted, most,
               processors(), processors() == 1 ? "" : "s");
}

void leave_process() noexcept { leaving = 1; }

void end_at_once(int code) noexcept
{
  std::fflush(stdout);
  ::_exit(code);
}

std::string unwritten_output()
{
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  if (flushed && std::ferror(stdout) == 0)
    return {};
  return fmt::format("cannot write to standard output{}{}", errno != 0 ? ": " : "", errno != 0 ? std::strerror(errno) : "");
}

}  // namespace talus
