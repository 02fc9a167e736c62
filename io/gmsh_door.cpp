#include "io/gmsh_door.hpp"

#include "io/module.hpp"

namespace talus {

template <int D>
const GmshFunctions<D>& gmsh()
{
  static const auto& part = *static_cast<const GmshPart*>(open_module("gmsh", "talus_gmsh_part", "makes meshes with gmsh"));
  if constexpr (D == 2)
    return part.in_2d;
  else
    return part.in_3d;
}

template const GmshFunctions<2>& gmsh<2>();
template const GmshFunctions<3>& gmsh<3>();

}  // namespace talus
