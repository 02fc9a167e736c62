#include "io/system/plugin.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "core/error.hpp"

namespace talus {

const void* open_module(const std::string& name, const std::string& symbol, const std::string& what_it_does)
{
  const std::string file = fmt::format("libtalus_{}.so", name);
  void* part = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (std::error_code unknown; part == nullptr)  // the dlopen of a sanitizer does not search the path of the program
    part = dlopen((std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path() / file).c_str(), RTLD_NOW | RTLD_LOCAL);
  const void* const found = part != nullptr ? dlsym(part, symbol.c_str()) : nullptr;
  if (found == nullptr)
    throw EnvironmentError(fmt::format("{}, the part of the program that {}, cannot be loaded: {}", file, what_it_does, dlerror()));
  return found;
}

}  // namespace talus
