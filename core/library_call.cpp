#include "core/library_call.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <initializer_list>

namespace talus {

namespace {

// Memory of its own: where it is needed there may be none to be had.
std::array<char, 512> name{};
volatile std::sig_atomic_t length = 0;

}  // namespace

LibraryCall::LibraryCall(std::string_view library, std::string_view does, std::string_view file) noexcept
{
  length = 0;
  std::size_t end = 0;
  for (const std::string_view part : {library, std::string_view(", "), does, std::string_view(" "), file})
    end += part.copy(name.data() + end, name.size() - end);
  length = static_cast<std::sig_atomic_t>(end);
}

LibraryCall::~LibraryCall() { length = 0; }

std::string_view library_at_work() noexcept { return {name.data(), static_cast<std::size_t>(length)}; }

}  // namespace talus
