#pragma once
// Conversion of an error to bytes and back: one rank throws an error that another one has caught.
#include <exception>
#include <string>
#include <string_view>

namespace talus {

std::string packed(const std::exception_ptr& error);
[[noreturn]] void throw_packed(std::string_view text);

}  // namespace talus
