// The functions that libtalus_gmsh.so exports.
#include "io/mesh/gmsh_plugin.hpp"

extern "C" {
extern const talus::GmshPart talus_gmsh_part;
const talus::GmshPart talus_gmsh_part{
    {talus::mesh_geometry<2>, talus::mesh_regions<2>}, {talus::mesh_geometry<3>, talus::mesh_regions<3>}, talus::mesh_plan};
}
