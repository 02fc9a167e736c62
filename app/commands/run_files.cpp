#include "app/commands/run_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/observers/results.hpp"
#include "core/error.hpp"
#include "core/parallel/communicator.hpp"
#include "core/print.hpp"
#include "core/version.hpp"
#include "io/files/atomic_file.hpp"
#include "io/files/manifest.hpp"
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

std::string replaces_source(const fs::path& source, const fs::path& folder)
{
  return fmt::format("{} is among the results in {}, which this run replaces: choose another folder with --out", source.string(),
                     folder.string());
}

void check_start_tables(const Scene& scene, const std::vector<StartStateSummary>& starts, const fs::path& folder)
{
  for (const BodySpec& body : scene.bodies)
    for (const StartStateSummary& start : starts)
      if (body.initial && start.body == body.name && lies_in(start.file, folder))
        throw SceneErrors(body.initial->where, replaces_source(start.file, folder));
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
        "a record or the water table of {}, the table of a body, or the surface of a rigid body is not the one that the checkpoint was "
        "made with: its file has changed since",
        now.scene_file));
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

namespace {

/// The text of a file; nothing if it does not exist.
std::optional<std::string> text_of(const fs::path& file)
{
  if (std::error_code unknown; !fs::is_regular_file(file, unknown))
    return std::nullopt;
  return read_whole(file);
}

}  // namespace

std::string with_changes(const std::string& text, const std::vector<std::string>& changes)
{
  std::string all = text;
  if (!changes.empty())
    all += "\n# Run with changes:\n";
  for (const std::string& change : changes) {
    all += "#   --set '";
    for (const char c : change) {
      all += c;
      if (c == '\n' || c == '\r')
        all += "#   ";  // a new line, which must be a comment too
    }
    all += "'\n";
  }
  return all;
}

void update_scene_copy(const fs::path& folder, const Scene& scene)
{
  const fs::path file = folder / scene_copy_file;
  const auto manifest = Manifest::of(folder);
  const std::string wanted = with_changes(scene.text, scene.overrides);
  const auto there = text_of(file);
  if (!there || (*there != wanted && manifest && manifest->proves(scene_copy_file)))
    write_whole(file, wanted);
}

std::vector<std::string> find_edits(const fs::path& scene_file, const std::optional<fs::path>& folder, const std::string& text,
                                    const std::vector<std::string>& changes)
{
  std::vector<std::string> edits;
  const auto warn = [&](const fs::path& file) {
    edits.push_back(
        fmt::format("{} was edited since the run began: that is ignored, the run goes on with the scene that it began with; --set "
                    "changes what may change, and the edited scene is a run of its own (talus run {} --out DIR)",
                    file.string(), file.string()));
  };
  if (const auto now = text_of(scene_file); now && *now != text)
    warn(scene_file);
  std::error_code not_there;
  if (!folder || fs::equivalent(scene_file, *folder / scene_copy_file, not_there))
    return edits;
  if (const auto copy = text_of(*folder / scene_copy_file); copy && *copy != text && *copy != with_changes(text, changes))
    warn(*folder / scene_copy_file);
  return edits;
}

}  // namespace talus
