#include "app/commands/run_files.hpp"

#include <fmt/format.h>

#include "app/observers/checkpoints.hpp"
#include "app/observers/results.hpp"
#include "io/files/atomic_file.hpp"
#include "io/mesh/gmsh_write.hpp"
#include "io/output/summary_json.hpp"
#include "io/output/vtk.hpp"

namespace talus {

namespace fs = std::filesystem;

bool goes_on_in_place(const CheckpointList* from, const fs::path& folder)
{
  std::error_code not_there;
  return from != nullptr && from->folder() && fs::equivalent(folder, *from->folder(), not_there);
}

template <int D>
void write_first_files(const fs::path& place, const RunSummary& summary, const Mesh<D>& mesh, const std::optional<fs::path>& initial)
{
  write_summary(place / "summary.json", summary);
  if (!fs::exists(place / "mesh.msh"))
    write_msh(place / "mesh.msh", mesh);
  if (!fs::exists(place / "mesh.vtu"))
    write_mesh<D>(place / "mesh.vtu", 0, mesh, {}, {}, summary.made_by());
  if (const fs::path copy = place / initial_file; initial && fs::weakly_canonical(copy) != fs::weakly_canonical(*initial))
    write_whole(copy, [&](const fs::path& temporary) {
      std::error_code trouble;
      fs::copy_file(*initial, temporary, trouble);
      if (trouble)
        throw EnvironmentError(fmt::format("{} cannot be copied to {}: {}", initial->string(), copy.string(), trouble.message()));
    });
}

template void write_first_files<2>(const fs::path&, const RunSummary&, const Mesh<2>&, const std::optional<fs::path>&);
template void write_first_files<3>(const fs::path&, const RunSummary&, const Mesh<3>&, const std::optional<fs::path>&);

}  // namespace talus
