#include "io/system/law_crash.hpp"

#include <unistd.h>

#include <array>
#include <charconv>
#include <csignal>
#include <string_view>

#include "materials/interface/own_law_code.hpp"

namespace talus {

namespace {

// A handler may call very few functions: these write to the descriptor and allocate nothing.
void write_words(std::string_view text) noexcept
{
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
}

template <class Number>
void write_number(Number number) noexcept
{
  std::array<char, 32> text{};
  const auto [end, code] = std::to_chars(text.data(), text.data() + text.size(), number);
  if (code == std::errc{})
    write_words({text.data(), static_cast<std::size_t>(end - text.data())});
}

std::string_view name_of_signal(int signal) noexcept
{
  switch (signal) {
    case SIGSEGV: return "SIGSEGV, memory that is not its own";
    case SIGBUS: return "SIGBUS, memory that is not there";
    case SIGILL: return "SIGILL, an instruction that this processor does not have";
    case SIGFPE: return "SIGFPE, an operation that cannot be done";
    default: return "SIGABRT, it has given up";
  }
}

}  // namespace

bool write_law_at_work(int signal) noexcept
{
  const LawCall& call = signal == SIGINT ? law_call_of_any_thread() : law_call_of_thread();
  if (call.law == nullptr)
    return false;
  write_words("error: law ");
  write_words(call.law);
  if (signal == 0)
    write_words(" ended the process");
  else if (signal == SIGINT)
    write_words(" had not returned");
  else {
    write_words(" crashed (");
    write_words(name_of_signal(signal));
    write_words(")");
  }
  if (call.last >= 0) {
    write_words(" in a block of particles, from ");
    write_number(call.first);
    write_words(" to ");
    write_number(call.last);
    write_words(", t = ");
    write_number(call.time);
    write_words(" s");
  }
  write_words("; what is written so far is whole\n");
  return true;
}

}  // namespace talus
