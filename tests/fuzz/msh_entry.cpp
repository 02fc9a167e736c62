#include "core/error.hpp"
#include "io/load_mesh.hpp"
#include "tests/fuzz/entries.hpp"
#include "tests/fuzz/memory_file.hpp"

namespace talus {

void fuzz_msh(std::string_view bytes)
{
  const MemoryFile file(bytes);
  MeshSpec spec;
  spec.file = file.path().string();
  try {
    load_mesh<2>(spec, "");
  } catch (const SceneErrors&) {
  }
  try {
    load_mesh<3>(spec, "");
  } catch (const SceneErrors&) {
  }
}

}  // namespace talus
