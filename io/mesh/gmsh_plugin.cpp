#include "io/mesh/gmsh_plugin.hpp"

#include "io/system/plugin.hpp"

namespace talus {

const GmshPart& gmsh()
{
  static const auto& part = *static_cast<const GmshPart*>(open_module("gmsh", "talus_gmsh_part", "makes meshes with gmsh"));
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
