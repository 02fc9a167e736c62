#include "io/gmsh_door.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include "core/error.hpp"

namespace talus {

namespace {

/// Opened once and never closed: gmsh leaves things behind that are called at the end of the program.
const GmshPart& open_gmsh_part()
{
  constexpr auto file = "libtalus_gmsh.so", name = "talus_gmsh_part";
  void* part = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (std::error_code unknown; part == nullptr)  // a sanitizer's dlopen does not look where the program says
    part = dlopen((std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path() / file).c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const functions = part != nullptr ? dlsym(part, name) : nullptr;
  if (functions == nullptr)
    throw EnvironmentError(fmt::format("{}, the part of the program that makes meshes with gmsh, cannot be loaded: {}", file, dlerror()));
  return *static_cast<const GmshPart*>(functions);
}

}  // namespace

const GmshPart& gmsh()
{
  static const GmshPart& part = open_gmsh_part();
  return part;
}

template <int D>
const GmshFunctions<D>& gmsh()
{
  if constexpr (D == 2)
    return gmsh().in_2d;
  else
    return gmsh().in_3d;
}

template const GmshFunctions<2>& gmsh<2>();
template const GmshFunctions<3>& gmsh<3>();

}  // namespace talus
