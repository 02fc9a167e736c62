// By hand: the ordinary user types `talus render`, which hands on what has been checked here already.
#include "io/pictures/settings/picture_settings.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/option_words.hpp"
#include "core/word_match.hpp"
#include "io/files/runout_maps.hpp"

namespace talus::render {

namespace {

constexpr int smallest = 200, largest = 10000;  // pixels
constexpr std::array internal_options{
    // what `talus render` says of the scene, and what only talus-render knows
    Option{"--up", 3, 3, "X Y Z", "3-D: up in the picture"}, Option{"--title", 1, 1, "TEXT", "above the picture"},
    Option{"--radius", 1, 1, "R", "of a particle as drawn [m]"}};
constexpr std::array internal_surface_options{Option{"--body", 2, 2, "NUMBER NAME", "one more body"}};

constexpr std::array internal_map_options{Option{"--title", 1, 1, "TEXT", "above the picture"},
                                          Option{"--axes", 2, 2, "RIGHT UP", "names of the axes of the plan"},
                                          Option{"--frames", 0, 0, "", "the frames of the thickness instead"}};

using Values = std::vector<std::string>;

template <class Enum>
Enum choice(const std::string& word, const std::string& option)
{
  constexpr auto names = enum_names(Enum{});
  const auto found = std::find(names.begin(), names.end(), word);
  if (found == names.end())
    throw Error(fmt::format("{}: unknown \"{}\"{}", option, word, suggestion(word, std::vector<std::string>(names.begin(), names.end()))));
  return static_cast<Enum>(found - names.begin());
}

bool is_number(const std::string& word)
{
  Real value{};
  const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
  return code == std::errc{} && end == word.data() + word.size();
}

std::vector<Real> numbers(const Values& values, const std::string& option)
{
  std::vector<Real> list;
  for (const std::string& word : values)
    list.push_back(number<Real>(word, option));
  return list;
}

Real positive_number(const std::string& word, const std::string& option)
{
  const Real value = number<Real>(word, option);
  if (!(value > 0))
    throw Error(fmt::format("{}: {} is not positive", option, word));
  return value;
}

Vec3 vector_of(const Values& values, const std::string& option)
{
  if (values.size() != 3)
    throw Error(fmt::format("{}: a direction has three numbers, here are {}", option, values.size()));
  const auto list = numbers(values, option);
  const Vec3 v(list[0], list[1], list[2]);
  if (!(v.norm() > 0))
    throw Error(fmt::format("{}: 0 0 0 is no direction", option));
  return v;
}

std::array<int, 2> picture_size(const std::string& word)
{
  const auto cross = word.find('x');
  if (cross == std::string::npos)
    throw Error(fmt::format("--size: \"{}\" should look like 1280x720", word));
  const std::array<int, 2> size{number<int>(word.substr(0, cross), "--size"), number<int>(word.substr(cross + 1), "--size")};
  for (const int pixels : size)
    if (pixels < smallest || pixels > largest)
      throw Error(fmt::format("--size: {} is outside {} to {} pixels", pixels, smallest, largest));
  return size;
}

/// "FROM:TO" or "FROM:TO:STEP"; an end left out is that of the run.
Frames series(const std::string& word, const std::string& option)
{
  const auto colon = word.find(':'), second = word.find(':', colon + 1);
  const std::string from = word.substr(0, colon), to = word.substr(colon + 1, second == std::string::npos ? second : second - colon - 1);
  Frames frames{0, std::nullopt, 1};
  if (!from.empty())
    frames.first = number<std::size_t>(from, option);
  if (!to.empty() && to != "last")
    frames.last = number<std::size_t>(to, option);
  if (second != std::string::npos)
    frames.step = number<std::size_t>(word.substr(second + 1), option);
  if (frames.step == 0)
    throw Error(fmt::format("{}: {} has a step of 0", option, word));
  if (frames.last && *frames.last < *frames.first)
    throw Error(fmt::format("{}: {} ends before it begins", option, word));
  return frames;
}

Frames frames_of(const std::string& word, const std::string& option)
{
  if (word == "first")
    return {0, 0};
  if (word == "last")
    return {};
  if (word == "all")
    return {0, std::nullopt};
  if (word.find(':') != std::string::npos)
    return series(word, option);
  if (!is_number(word))
    throw Error(fmt::format("{}: \"{}\" is not first, last, all, a number or FROM:TO[:STEP]", option, word));
  const auto one = number<std::size_t>(word, option);
  return {one, one};
}

std::variant<RangeOf, std::array<Real, 2>> range_of(const Values& values)
{
  if (values.size() == 1)
    return is_number(values[0]) ? throw Error(fmt::format("--range: {} is one end, the other is missing", values[0]))
                                : choice<RangeOf>(values[0], "--range");
  const auto list = numbers(values, "--range");
  if (!(list[0] < list[1]))
    throw Error(fmt::format("--range: {} is not below {}", list[0], list[1]));
  return std::array{list[0], list[1]};
}

Plane plane_of(const Values& values)
{
  const std::string axes = "xyz";
  if (values.size() == 4)
    return {vector_of({values[0], values[1], values[2]}, "--clip"), number<Real>(values[3], "--clip")};
  if (values.size() == 2 && values[0].size() == 1 && axes.find(values[0]) != std::string::npos)
    return {Vec3::Unit(static_cast<Index>(axes.find(values[0]))), number<Real>(values[1], "--clip")};
  throw Error("--clip: wanted are x, y or z and an offset, such as x 12.5, or a normal and an offset, such as 1 0 0 12.5");
}

std::array<Real, 4> window_of(const Values& values)
{
  const auto w = numbers(values, "--window");
  if (!(w[0] < w[2] && w[1] < w[3]))
    throw Error(fmt::format("--window: the low corner {} {} is not below the high corner {} {}", w[0], w[1], w[2], w[3]));
  return {w[0], w[1], w[2], w[3]};
}

void set(const std::string& option, const Values& values, Settings& s)
{
  if (option == "--field")
    s.field = values[0];
  else if (option == "--range")
    s.range = range_of(values);
  else if (option == "--map")
    s.map = choice<Map>(values[0], option);
  else if (option == "--log")
    s.log = true;
  else if (option == "--frames")
    s.frames = frames_of(values[0], option);
  else if (option == "--size")
    s.size = picture_size(values[0]);
  else if (option == "--view" && values.size() == 1)
    s.view = choice<NamedView>(values[0], option);
  else if (option == "--view")
    s.view = vector_of(values, option);
  else if (option == "--look-at")
    s.look_at = numbers(values, option);
  else if (option == "--zoom")
    s.zoom = positive_number(values[0], option);
  else if (option == "--perspective" || option == "--orthographic")
    s.perspective = option == "--perspective";
  else if (option == "--window")
    s.window = window_of(values);
  else if (option == "--clip")
    s.clip = plane_of(values);
  else if (option == "--mesh")
    s.mesh = choice<MeshLines>(values[0], option);
  else if (option == "--no-mesh")
    s.mesh = MeshLines::none;
  else if (option == "--no-ground")
    s.ground = false;
  else if (option == "--outline")
    s.start_outline = values[0] == "start" ? true : throw Error(fmt::format("--outline: unknown \"{}\"; known is start", values[0]));
  else if (option == "--out")
    s.out = values[0];
  else if (option == "--up")
    s.up = vector_of(values, option);
  else if (option == "--title")
    s.title = values[0];
  else if (option == "--radius")
    s.radius = positive_number(values[0], option);
  s.given.push_back(option);
}

void set(const std::string& option, const Values& values, MapSettings& s)
{
  if (option == "--only")
    s.only = values;
  else if (option == "--range")
    s.range = std::get<std::array<Real, 2>>(range_of(values));
  else if (option == "--map")
    s.map = choice<Map>(values[0], option);
  else if (option == "--log")
    s.log = true;
  else if (option == "--contours")
    s.contours = positive_number(values[0], option);
  else if (option == "--size")
    s.size = picture_size(values[0]);
  else if (option == "--out")
    s.out = values[0];
  else if (option == "--title")
    s.title = values[0];
  else if (option == "--axes")
    s.axes = {values[0], values[1]};
  else if (option == "--frames")
    s.frames = true;
}

void set(const std::string& option, const Values& values, SurfaceSettings& s)
{
  if (option == "--frame")
    s.frames = frames_of(values[0], option);
  else if (option == "--spacing")
    s.spacing = positive_number(values[0], option);
  else if (option == "--level")
    s.level = positive_number(values[0], option);
  else if (option == "--field")
    s.field = values[0];
  else if (option == "--body")
    s.bodies.push_back({number<int>(values[0], option), values[1]});
  else if (option == "--out")
    s.out = values[0];
}

/// Reads the words by the table of options; `folder` takes the one that belongs to none.
template <class S>
void read_words(std::span<const std::string> given, std::span<const Option> options, S& settings, std::vector<std::string>& problems)
{
  OptionWords words(given);
  while (!words.empty()) {
    const std::string word = words.next("");
    if (!word.starts_with("--")) {
      if (!settings.folder.empty())
        problems.push_back(fmt::format("one folder at a time: {} and {}", settings.folder.string(), word));
      settings.folder = word;
      continue;
    }
    const auto option = std::find_if(options.begin(), options.end(), [&](const Option& o) { return o.name == word; });
    if (option == options.end()) {
      std::vector<std::string> known;
      for (const Option& o : options)
        known.emplace_back(o.name);
      problems.push_back(fmt::format("unknown option {}{}", word, suggestion(word, known)));
      words.values();
      continue;
    }
    const Values values = option->most == 0 ? Values{} : word == "--title" ? Values{words.next(word)} : words.values();
    if (static_cast<int>(values.size()) < option->least || static_cast<int>(values.size()) > option->most)
      problems.push_back(fmt::format("{}: wanted is {}, here are {} words", word, option->values, values.size()));
    else
      try {
        set(word, values, settings);
      } catch (const Error& error) {
        problems.emplace_back(error.what());
      }
  }
  if (settings.folder.empty())
    problems.push_back("the folder of a run is missing\n" + usage());
}

template <std::size_t N, std::size_t M>
std::vector<Option> joined(const std::array<Option, N>& a, const std::array<Option, M>& b)
{
  std::vector<Option> all(a.begin(), a.end());
  all.insert(all.end(), b.begin(), b.end());
  return all;
}

std::string line_of(const Option& option)
{
  return fmt::format("  {:<40} {}\n", fmt::format("{} {}", option.name, option.values), option.help);
}

}  // namespace

Settings parse_picture(std::span<const std::string> words, std::vector<std::string>& problems)
{
  Settings s;
  read_words(words, joined(picture_options, internal_options), s, problems);
  if (const auto* view = std::get_if<Vec3>(&s.view))
    if (!(view->cross(s.up).norm() > 1e-6 * view->norm() * s.up.norm()))  // a ten-thousandth of a degree: no horizontal is left
      problems.emplace_back("--view: it must not be parallel to what is up in the picture; --view top looks from above");
  const auto* range = std::get_if<std::array<Real, 2>>(&s.range);
  if (s.log && range != nullptr && !((*range)[0] > 0))
    problems.push_back(fmt::format("--log: a range from {} has no logarithm", (*range)[0]));
  return s;
}

SurfaceSettings parse_surface(std::span<const std::string> words, std::vector<std::string>& problems)
{
  SurfaceSettings s;
  read_words(words, joined(surface_options, internal_surface_options), s, problems);
  const std::string kind = s.out.extension();
  if (s.out.empty())
    problems.emplace_back("--out: the file is missing: one that ends in .ply, .stl or .obj");
  else if (kind != ".ply" && kind != ".stl" && kind != ".obj")
    problems.push_back(fmt::format("--out: {} should end in .ply, .stl or .obj", s.out.string()));
  else if (s.field && kind != ".ply")
    problems.push_back(fmt::format("--field: of the formats only .ply has colours, {} has none", kind));
  if (!(s.level < 1))
    problems.push_back(fmt::format("--level: {} is not below 1, the density inside", s.level));
  return s;
}

MapSettings parse_maps(std::span<const std::string> words, std::vector<std::string>& problems)
{
  MapSettings s;
  read_words(words, joined(map_options, internal_map_options), s, problems);
  std::vector<std::string> known{"sections"};
  for (const MapKind& kind : map_kinds)
    known.emplace_back(kind.name);
  for (const std::string& name : s.only)
    if (std::find(known.begin(), known.end(), name) == known.end())
      problems.push_back(fmt::format("--only: there is no map \"{}\"{}", name, suggestion(name, known)));
  if (s.range && !s.frames && s.only.size() != 1)
    problems.emplace_back("--range: it is that of one map: say which with --only");
  if (s.range && s.log && !((*s.range)[0] > 0))
    problems.push_back(fmt::format("--log: a range from {} has no logarithm", (*s.range)[0]));
  return s;
}

std::string usage()
{
  std::string text =
      "usage: talus-render DIR [options]\n"
      "       talus-render surface DIR [options] --out FILE.ply|FILE.stl|FILE.obj\n"
      "       talus-render map DIR [options]\n"
      "       talus-render chart TABLE.csv --x COLUMN --y COLUMN [--level NAME VALUE]... [--upright NAME VALUE]... [--curve NAME] "
      "[--marks] [--log] [--title TEXT] --out FILE.png\n"
      "       talus-render tornado --bar NAME LOW HIGH... --base VALUE --x COLUMN [--title TEXT] --out FILE.png\n"
      "Draws the particles of DIR/particles.pvd, writes the surface of bodies, draws DIR/maps and DIR/sections, or a curve of a table.  "
      "Pictures need a display; "
      "`talus render` brings one.\nPictures:\n";
  for (const Option& option : joined(picture_options, internal_options))
    text += line_of(option);
  text += "Surfaces:\n";
  for (const Option& option : joined(surface_options, internal_surface_options))
    text += line_of(option);
  text += "Maps:\n";
  for (const Option& option : joined(map_options, internal_map_options))
    text += line_of(option);
  return text;
}

}  // namespace talus::render
