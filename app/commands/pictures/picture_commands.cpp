// talus map, talus render, talus surface
#include "app/commands/pictures/picture_commands.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/commands/report/report.hpp"
#include "app/observers/plan_axes.hpp"
#include "app/observers/results.hpp"
#include "core/error.hpp"
#include "core/word_match.hpp"
#include "io/output/vtk.hpp"
#include "io/pictures/settings/launch_render.hpp"
#include "io/pictures/settings/picture_settings.hpp"
#include "io/scene/reader.hpp"
#include "io/scene/scene.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

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

/// Results with particles to be drawn.
struct RenderedRun {
  Scene scene;
  render::RunFacts facts;
};
/// Throws Error if the folder contains no results of a run, EnvironmentError if it contains none of particles.
RenderedRun read_rendered_run(const fs::path& folder)
{
  require_run(folder);
  RenderedRun run{read_scene(folder / "scene.yaml", {}, Libraries::closed), {}};
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

/// Draws pictures and prints their names, or makes a movie of them if there is to be one.
void draw(const MovieOptions& options, Words words)
{
  if (options.movie)
    make_movie(options, std::move(words));
  else
    for (const RenderedFile& file : launch_render(words))
      fmt::print("{}\n", file.path.string());
}

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
  draw(options, std::move(words));
}

namespace {

void add(const std::string& option, const std::vector<Real>& numbers, Words& words)
{
  if (numbers.empty())
    return;
  words.push_back(option);
  for (const Real number : numbers)
    words.push_back(fmt::format("{}", number));
}

/// The direction against gravity, so that material falls downwards in the picture.
std::vector<Real> up_of(const Scene& scene)
{
  if (!scene.outputs.picture.up.empty() || scene.dimension == 2)
    return scene.outputs.picture.up;
  if (const auto up = against_gravity(scene))
    return {up->begin(), up->end()};
  return {};
}

/// The options with the defaults of the scene.
Words with_defaults(const Scene& scene, const RenderOptions& options)
{
  const PictureSpec& picture = scene.outputs.picture;
  const auto given = [&](std::string_view option) { return has_option(options.words, option); };
  Words words{options.folder.string(), "--title", scene.title};
  if (!given("--field"))
    words.insert(words.end(), {"--field", picture.field});
  if (!given("--range") && !given("--field"))
    add("--range", picture.range, words);
  if (scene.dimension == 3 && !given("--view"))
    add("--view", picture.view, words);
  add("--up", up_of(scene), words);
  if (!picture.mesh && !given("--mesh"))
    words.emplace_back("--no-mesh");
  words.insert(words.end(), options.words.begin(), options.words.end());
  return words;
}

/// Adds options for a series with constant colours.
void add_movie_defaults(Words& words)
{
  if (!has_option(words, "--frames"))
    words.insert(words.end(), {"--frames", "all"});
  if (!has_option(words, "--range"))
    words.insert(words.end(), {"--range", "whole"});
}

}  // namespace

void render_results(const RenderOptions& options)
{
  const RenderedRun run = read_rendered_run(options.folder);
  Words words = with_defaults(run.scene, options), problems;
  if (options.movie)
    add_movie_defaults(words);
  render::check(render::parse_picture(words, problems), run.facts, problems);
  check_movie(options, options.words, problems);
  render::require_none(problems);
  draw(options, std::move(words));
}

namespace {

/// The options of talus-render for one body, or for all.
std::vector<std::string> body_words(const Scene& scene, const std::optional<std::string>& wanted, std::vector<std::string>& problems)
{
  std::vector<std::string> words, known;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    known.push_back(scene.bodies[b].name);
    if (!wanted || *wanted == known.back())
      words.insert(words.end(), {"--body", std::to_string(b), known.back()});
  }
  if (words.empty())
    problems.push_back(fmt::format("--body: the run has no body \"{}\"{}", wanted.value_or(""), suggestion(wanted.value_or(""), known)));
  return words;
}

}  // namespace

void extract_surface(const SurfaceOptions& options)
{
  const RenderedRun run = read_rendered_run(options.folder);
  std::vector<std::string> words{options.folder.string()}, problems;
  words.insert(words.end(), options.words.begin(), options.words.end());
  render::check(render::parse_surface(words, problems), run.facts, problems);
  const auto bodies = body_words(run.scene, options.body, problems);
  render::require_none(problems);
  words.insert(words.end(), bodies.begin(), bodies.end());
  words.insert(words.begin(), "surface");
  for (const auto& [file, said] : launch_render(words, Display::not_needed)) {
    fmt::print("{}\n", file.string());
    for (const std::string& line : said)
      fmt::print("  {}\n", line);
  }
}

}  // namespace talus
