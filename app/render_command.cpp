// talus render
#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/upright.hpp"
#include "core/error.hpp"
#include "io/launch_render.hpp"
#include "io/reader.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

void add(std::string_view option, const std::vector<Real>& numbers, std::vector<std::string>& arguments)
{
  if (numbers.empty())
    return;
  arguments.emplace_back(option);
  for (const Real number : numbers)
    arguments.push_back(fmt::format("{}", number));
}

/// Against gravity, so that what falls falls down in the picture.
std::vector<Real> up_of(const Scene& scene)
{
  if (!scene.outputs.picture.up.empty() || scene.dimension == 2)
    return scene.outputs.picture.up;
  if (const auto up = against_gravity(scene))
    return {up->begin(), up->end()};
  return {};
}

}  // namespace

void render_results(const RenderOptions& options)
{
  if (!fs::exists(options.folder / "summary.json"))
    throw EnvironmentError(fmt::format("{} holds no results of a run (no summary.json)", options.folder.string()));
  const Scene scene = read_scene(options.folder / "scene.yaml");
  const PictureSpec& picture = scene.outputs.picture;
  std::vector<std::string> arguments{options.folder.string(), "--field", options.field.value_or(picture.field), "--title", scene.title};
  add("--range", options.range.empty() && !options.field ? picture.range : options.range, arguments);
  if (scene.dimension == 3)
    add("--view", options.view.empty() ? picture.view : options.view, arguments);
  add("--up", up_of(scene), arguments);
  if (!picture.mesh)
    arguments.emplace_back("--no-mesh");
  const auto add_word = [&](const char* option, const auto& word) {
    if (word)
      arguments.insert(arguments.end(), {option, *word});
  };
  add_word("--frames", options.frames);
  add_word("--size", options.size);
  if (options.out)
    arguments.insert(arguments.end(), {"--out", options.out->string()});
  const fs::path self = fs::read_symlink("/proc/self/exe");
  for (const fs::path& file : launch_render(self.parent_path() / "talus-render", arguments))
    fmt::print("{}\n", file.string());
}

}  // namespace talus
