#include "core/library_call.hpp"

#include <array>
#include <csignal>

namespace talus {

namespace {

// Static memory, because the name may be needed when memory has run out; of each thread, because files are written beside the steps and the
// handler of a fault runs on the thread that has it.
thread_local std::array<char, 512> call_name{};
thread_local volatile std::sig_atomic_t call_length = 0;

}  // namespace

LibraryCall::LibraryCall(std::string_view library, std::string_view does, std::string_view file) noexcept
{
  call_length = 0;
  std::size_t end = 0;
  for (const std::string_view part : {library, std::string_view(", "), does, std::string_view(" "), file})
    end += part.copy(call_name.data() + end, call_name.size() - end);
  call_length = static_cast<std::sig_atomic_t>(end);
}

LibraryCall::~LibraryCall() { call_length = 0; }

std::string_view library_at_work() noexcept { return {call_name.data(), static_cast<std::size_t>(call_length)}; }

}  // namespace talus
