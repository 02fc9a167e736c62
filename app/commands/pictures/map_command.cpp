// talus map
#include "app/commands/pictures/map_command.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/commands/pictures/movie_command.hpp"
#include "app/commands/report/report.hpp"
#include "app/observers/plan_axes.hpp"
#include "app/observers/results.hpp"
#include "core/error.hpp"
#include "io/pictures/settings/launch_render.hpp"
#include "io/pictures/settings/picture_settings.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// The names of the axes of the plan, to the right and upwards.
std::array<std::string, 2> names_of_axes(const Scene& scene)
{
  Vec3 gravity = Vec3::Zero();
  for (const LoadSpec& load : scene.loads)
    if (const auto* given = std::get_if<GravitySpec>(&load))
      for (std::size_t d = 0; d < std::min<std::size_t>(3, given->acceleration.size()); ++d)
        gravity[static_cast<Index>(d)] = given->acceleration[d];
  const PlanAxes axes = plan_axes<3>(gravity);
  return {std::string(1, "xyz"[axes.plan[0]]), std::string(1, "xyz"[axes.plan[1]])};
}

/// Throws Error if there is nothing to draw.
void require_maps(const fs::path& folder, const Scene& scene, bool movie)
{
  std::error_code unreadable;
  if (!scene.outputs.runout)
    throw Error(fmt::format("{} has no maps: the scene does not ask for outputs.runout", folder.string()));
  if (!fs::exists(folder / section_folder, unreadable) && !fs::exists(folder / map_folder / "ground.tif", unreadable))
    throw Error(fmt::format("{} has no maps yet: they are written when a stage of the run is over", folder.string()));
  if (movie && (!scene.outputs.runout->frames_every || !fs::exists(folder / map_folder / "thickness_0000.tif", unreadable)))
    throw Error(fmt::format("--movie: {} has no maps of the thickness in time: the scene asks for them by outputs.runout.frames_every",
                            folder.string()));
}

}  // namespace

void draw_maps(const MapOptions& options)
{
  const Scene scene = read_run_folder(options.folder).scene;
  const auto axes = names_of_axes(scene);
  std::vector<std::string> words{options.folder.string(), "--title", scene.title, "--axes", axes[0], axes[1]}, problems;
  words.insert(words.end(), options.words.begin(), options.words.end());
  if (options.movie)
    words.emplace_back("--frames");
  render::parse_maps(words, problems);
  check_movie(options, options.words, problems);
  render::require_none(problems);
  require_maps(options.folder, scene, options.movie.has_value());
  words.insert(words.begin(), "map");
  if (options.movie)
    make_movie(options, std::move(words));
  else
    for (const RenderedFile& file : launch_render(words))
      fmt::print("{}\n", file.path.string());
}

}  // namespace talus
