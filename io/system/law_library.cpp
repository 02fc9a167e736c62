#include "io/system/law_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cfenv>
#include <fstream>
#include <iterator>
#include <span>

#include "core/error.hpp"
#include "io/files/byte_digest.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// Throws Error for what is certainly no library.
void check_extension(const fs::path& file)
{
  static constexpr std::array<std::string_view, 8> sources{".c", ".cc", ".cpp", ".cxx", ".f", ".for", ".f90", ".py"};
  if (std::ranges::find(sources, file.extension().string()) != sources.end())
    throw Error(fmt::format("{} is source text: compile it to a shared library, cc -O2 -shared -fPIC", file.string()));
}

}  // namespace

std::string digest_of_law_file(const fs::path& file)
{
  std::error_code unreadable;
  if (!fs::exists(file, unreadable))
    throw Error(fmt::format("there is no file {}", file.string()));
  if (fs::is_directory(file, unreadable))
    throw Error(fmt::format("{} is a folder", file.string()));
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream)
    throw Error(fmt::format("{} cannot be read", file.string()));
  return fmt::format("{:016x}", digest_of(std::as_bytes(std::span(bytes)), 0));
}

LawLibrary::LawLibrary(const fs::path& file) : digest_(digest_of_law_file(file))
{
  check_extension(file);
  std::fenv_t before;  // a library that was linked with -ffast-math changes how denormal numbers are treated
  std::fegetenv(&before);
  // A path, not a name that would be searched; on every rank and for every material the same library.
  handle_ = dlopen(fs::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  std::fesetenv(&before);
  if (handle_ == nullptr)
    throw Error(fmt::format("the library cannot be opened: {}", dlerror()));
}

void* LawLibrary::function(const std::string& symbol) const
{
  if (void* const found = dlsym(handle_, symbol.c_str()); found != nullptr)
    return found;
  std::string lower = symbol;
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const std::string& other : {symbol + "_", lower + "_", lower, symbol.substr(0, symbol.size() - (symbol.ends_with('_') ? 1 : 0))})
    if (dlsym(handle_, other.c_str()) != nullptr)
      throw Error(fmt::format("the library has no function \"{}\" — did you mean \"{}\"?", symbol, other));
  throw Error(fmt::format("the library has no function \"{}\"; nm -D lists those it has; one in C++ has to be extern \"C\"", symbol));
}

}  // namespace talus
