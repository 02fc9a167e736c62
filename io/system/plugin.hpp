#pragma once
// Parts of the program that are opened only where they are needed (libtalus_*.so): each brings a hundred libraries, and to load them takes
// longer than many a command.
#include <string>

namespace talus {

/// What `symbol` names in libtalus_<name>.so, which stands beside the program or its libraries; opened once and never closed, since such
/// libraries leave things behind that are called at the end of the program.  EnvironmentError, which says what the part does ("makes meshes
/// with gmsh"): it is not there or cannot be loaded.
const void* open_module(const std::string& name, const std::string& symbol, const std::string& what_it_does);

}  // namespace talus
