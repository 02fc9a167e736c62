// talus render
#include <fmt/format.h>

#include "app/commands/pictures/movie_command.hpp"
#include "app/commands/pictures/render_command.hpp"
#include "app/commands/pictures/rendered_run.hpp"
#include "app/setup/vertical_axis.hpp"

#include "io/pictures/settings/launch_render.hpp"

namespace talus {

namespace {

using Words = std::vector<std::string>;

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
  if (options.movie)
    make_movie(options, std::move(words));
  else
    for (const RenderedFile& file : launch_render(words))
      fmt::print("{}\n", file.path.string());
}

}  // namespace talus
