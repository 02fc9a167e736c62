// talus surface
#include <fmt/format.h>

#include "app/commands/pictures/rendered_run.hpp"
#include "app/commands/pictures/surface_command.hpp"
#include "core/error.hpp"
#include "core/word_match.hpp"
#include "io/pictures/settings/launch_render.hpp"

namespace talus {

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
