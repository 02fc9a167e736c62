#include "app/commands/run_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/observers/checkpoints.hpp"
#include "app/observers/results.hpp"
#include "core/parallel/communicator.hpp"
#include "core/print.hpp"
#include "core/version.hpp"
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

RunIdentity identity_of(const Scene& scene, bool quick, std::uint64_t mesh, std::uint64_t from_files, const std::string& initial)
{
  const Version v = version();
  return {std::string(v.number),
          std::string(v.commit),
          std::string(v.compiler),
          build_of(v),
          std::filesystem::absolute(scene.file).lexically_normal().string(),
          scene.text,
          scene.overrides,
          quick,
          static_cast<std::int64_t>(mesh),
          static_cast<std::int64_t>(from_files),
          initial};
}

void compare(const RunIdentity& then, const RunIdentity& now)
{
  if (then.mesh != now.mesh)
    throw EnvironmentError(
        fmt::format("the mesh of {} is not the one that the checkpoint was made with: its file has changed since", now.scene_file));
  if (then.from_files != now.from_files)
    throw EnvironmentError(fmt::format(
        "a record or the water table of {} is not the one that the checkpoint was made with: its file has changed since", now.scene_file));
  std::vector<std::string> maker, here;  // differing parts
  for (const auto& [what, part] :
       {std::pair("commit", &RunIdentity::commit), std::pair("compiler", &RunIdentity::compiler), std::pair("build", &RunIdentity::build)})
    if (then.*part != now.*part) {
      maker.push_back(fmt::format("{} {}", what, then.*part));
      here.push_back(fmt::format("{} {}", what, now.*part));
    }
  if (!maker.empty() && world().is_root())
    say(stderr, "warning: the checkpoint was made by {}; this program is {}: results may differ in the last digits\n",
        fmt::join(maker, ", "), fmt::join(here, ", "));
}

}  // namespace talus
