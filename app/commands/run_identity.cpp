#include "app/commands/run_identity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/parallel/communicator.hpp"
#include "core/print.hpp"
#include "core/version.hpp"

namespace talus {

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
