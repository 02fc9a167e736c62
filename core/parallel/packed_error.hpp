#pragma once
// An error as text, and back: one rank throws what another has caught.
#include <exception>
#include <string>
#include <string_view>

namespace talus {

std::string packed(const std::exception_ptr& error);
[[noreturn]] void throw_packed(std::string_view text);

}  // namespace talus
