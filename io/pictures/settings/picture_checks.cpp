// Checks of settings against the data of a run.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/error.hpp"
#include "core/field_component.hpp"
#include "core/word_match.hpp"
#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

namespace {

void check_frames(const Frames& frames, std::size_t n, const char* option, std::vector<std::string>& problems)
{
  for (const auto& end : {frames.first, frames.last})
    if (end && *end >= n)
      return problems.push_back(fmt::format("{}: there is no frame {}: the run has frames 0 to {}", option, *end, n - 1));
}

void check_field(const std::optional<std::string>& field, const RunFacts& facts, std::vector<std::string>& problems)
{
  if (!field)
    return;
  const auto viewed = ViewedField::of(*field);
  const auto found = std::ranges::find_if(facts.fields, [&wanted = viewed.name](const RunFacts::Field& f) { return f.name == wanted; });
  if (found == facts.fields.end()) {
    std::vector<std::string> known;
    for (const RunFacts::Field& f : facts.fields)
      known.push_back(f.name);
    return problems.push_back(fmt::format("--field: the run has no particle field \"{}\"{}", viewed.name, suggestion(viewed.name, known)));
  }
  if (viewed.component.empty())
    return;
  const auto components = component_names(found->components);
  if (components.empty())
    problems.push_back(fmt::format("--field: \"{}\" is one number, it has no component \"{}\"", viewed.name, viewed.component));
  else if (std::ranges::find(components, viewed.component) == components.end())
    problems.push_back(
        fmt::format("--field: \"{}\" has no component \"{}\"; it has {}", viewed.name, viewed.component, or_list(components)));
}

}  // namespace

void check(const Settings& s, const RunFacts& facts, std::vector<std::string>& problems)
{
  const bool flat = facts.dimension == 2;
  for (const std::string& option : s.given) {
    const bool solid_only = option == "--view" || option == "--perspective" || option == "--orthographic";
    if (flat && solid_only)
      problems.push_back(
          fmt::format("{}: the run is 2-D and is seen from the front; --window, --look-at and --zoom choose a part of it", option));
    if (!flat && option == "--window")
      problems.emplace_back("--window: it is for 2-D, the run is 3-D; --look-at and --zoom choose a part of it");
  }
  if (s.window && (!s.look_at.empty() || s.zoom != 1))
    problems.emplace_back("--window: it says already what --look-at and --zoom do");
  if (!s.look_at.empty() && s.look_at.size() != static_cast<std::size_t>(facts.dimension))
    problems.push_back(fmt::format("--look-at: a point of a {}-D run has {} coordinates", facts.dimension, facts.dimension));
  check_frames(s.frames, facts.n_frames, "--frames", problems);
  check_field(s.field, facts, problems);
  if (s.out && s.out->extension() == ".png" && chosen(s.frames, facts.n_frames).size() > 1)
    problems.push_back(fmt::format("--out: {}: several frames need a folder", s.out->string()));
}

void check(const SurfaceSettings& s, const RunFacts& facts, std::vector<std::string>& problems)
{
  check_frames(s.frames, facts.n_frames, "--frame", problems);
  check_field(s.field, facts, problems);
  if (facts.dimension == 2 && (s.out.extension() == ".ply" || s.out.extension() == ".stl"))
    problems.push_back(fmt::format("--out: {}: the run is 2-D, its surface is a line, and {} knows no lines; .obj does", s.out.string(),
                                   s.out.extension().string()));
}

void require_none(const std::vector<std::string>& problems)
{
  if (!problems.empty())
    throw Error(fmt::format("{}", fmt::join(problems, "\nerror: ")));
}

std::vector<std::size_t> chosen(const Frames& frames, std::size_t n_frames)
{
  const std::size_t step = std::min(frames.step, n_frames);  // a larger step could overflow
  std::vector<std::size_t> list;
  for (std::size_t f = frames.first.value_or(n_frames - 1); f <= frames.last.value_or(n_frames - 1) && f < n_frames; f += step)
    list.push_back(f);
  return list;
}

}  // namespace talus::render
