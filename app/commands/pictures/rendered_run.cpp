#include "app/commands/pictures/rendered_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/observers/results.hpp"
#include "core/error.hpp"
#include "io/output/vtk.hpp"
#include "io/scene/reader.hpp"

namespace talus {

namespace fs = std::filesystem;

namespace {

/// The fields of the first file that can be read.  Throws the EnvironmentError of the last one if there is none.
std::vector<std::pair<std::string, int>> fields_of_first(const std::vector<std::pair<Real, fs::path>>& files)
{
  for (std::size_t f = 0;; ++f)
    try {
      return stored_particle_fields(files[f].second);
    } catch (const EnvironmentError&) {
      if (f + 1 == files.size())
        throw;
    }
}

}  // namespace

RenderedRun read_rendered_run(const fs::path& folder)
{
  require_run(folder);
  RenderedRun run{read_scene(folder / "scene.yaml"), {}};
  const fs::path series = folder / "particles.pvd";
  if (!fs::exists(series))
    throw EnvironmentError(fmt::format("{} is not there: the scene asks for no outputs.particles", series.string()));
  const auto files = read_pvd(series);
  if (files.empty())
    throw EnvironmentError(fmt::format("{} lists no file", series.string()));
  run.facts = {run.scene.dimension, files.size(), {}};
  for (const auto& [name, components] : fields_of_first(files))
    run.facts.fields.push_back({name, components});
  return run;
}

bool has_option(const std::vector<std::string>& words, std::string_view option)
{
  return std::find(words.begin(), words.end(), option) != words.end();
}

}  // namespace talus
