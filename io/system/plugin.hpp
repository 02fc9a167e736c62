#pragma once
// Plugins: libraries that are opened only when needed (libtalus_*.so), because each loads a hundred libraries, which takes longer than many
// a command.
#include <string>

namespace talus {

/// The object `symbol` in libtalus_<name>.so, which is beside the program or its libraries.  The plugin is opened once and never closed,
/// since such libraries register functions that are called at the end of the program.  Throws EnvironmentError, with the purpose of the
/// plugin ("makes meshes with gmsh"), if it is missing or cannot be loaded.
const void* open_module(const std::string& name, const std::string& symbol, const std::string& what_it_does);

}  // namespace talus
