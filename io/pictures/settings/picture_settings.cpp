// The options of pictures, surfaces and maps as tables, and the conversion of their words.
#include "io/pictures/settings/picture_settings.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "io/files/result_files.hpp"
#include "io/pictures/settings/option_parser.hpp"

namespace talus::render {

namespace {

constexpr int smallest = 200, largest = 10000;  // in pixels
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

/// Parses "FROM:TO" or "FROM:TO:STEP"; a missing end is that of the run.
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

bool is_start(const std::string& word)
{
  return word == "start" ? true : throw Error(fmt::format("--outline: unknown \"{}\"; known is start", word));
}

constexpr std::array picture_options{
    Option<Settings>{"--field", 1, 1, "NAME[:component]", "particle field that colours the particles; default what the scene says",
                     [](const Values& w, Settings& s) { s.field = w[0]; }},
    Option<Settings>{"--range", 1, 2, "LOW HIGH|last|whole",
                     "values at the ends of the colours; default those of the last frame; whole: of all frames",
                     [](const Values& w, Settings& s) { s.range = range_of(w); }},
    Option<Settings>{"--map", 1, 1, "{viridis,cividis,coolwarm}", "colours; default viridis; coolwarm has its middle at zero",
                     [](const Values& w, Settings& s) { s.map = choice<Map>(w[0], "--map"); }},
    Option<Settings>{"--log", 0, 0, "", "colours by the logarithm of the values", [](const Values&, Settings& s) { s.log = true; }},
    Option<Settings>{"--frames", 1, 1, "WHICH", "last (default), first, all, the number of one from 0, or FROM:TO[:STEP]",
                     [](const Values& w, Settings& s) { s.frames = frames_of(w[0], "--frames"); }},
    Option<Settings>{"--size", 1, 1, "WxH", "pixels, such as 1280x720", [](const Values& w, Settings& s) { s.size = picture_size(w[0]); }},
    Option<Settings>{"--view", 1, 3, "{front,back,left,right,top,iso}|X Y Z", "3-D: or the direction from the scene to the camera",
                     [](const Values& w, Settings& s) {
                       if (w.size() == 1)
                         s.view = choice<NamedView>(w[0], "--view");
                       else
                         s.view = vector_of(w, "--view");
                     }},
    Option<Settings>{"--look-at", 2, 3, "X Y [Z]", "point in the middle of the picture [m]",
                     [](const Values& w, Settings& s) { s.look_at = numbers(w, "--look-at"); }},
    Option<Settings>{"--zoom", 1, 1, "F", "so many times larger than what shows everything",
                     [](const Values& w, Settings& s) { s.zoom = positive_number(w[0], "--zoom"); }},
    Option<Settings>{"--perspective", 0, 0, "", "3-D: far things are smaller (default)",
                     [](const Values&, Settings& s) { s.perspective = true; }},
    Option<Settings>{"--orthographic", 0, 0, "", "3-D: far things are as large as near ones",
                     [](const Values&, Settings& s) { s.perspective = false; }},
    Option<Settings>{"--window", 4, 4, "XLOW YLOW XHIGH YHIGH", "2-D: the part to show [m]",
                     [](const Values& w, Settings& s) { s.window = window_of(w); }},
    Option<Settings>{"--clip", 2, 4, "AXIS OFFSET|NX NY NZ OFFSET", "leave out the particles beyond a plane, those with n.x > offset [m]",
                     [](const Values& w, Settings& s) { s.clip = plane_of(w); }},
    Option<Settings>{"--mesh", 1, 1, "{outline,edges,none}",
                     "lines; edges: of all cells, in 3-D of the boundary; default what the scene says",
                     [](const Values& w, Settings& s) { s.mesh = choice<MeshLines>(w[0], "--mesh"); }},
    Option<Settings>{"--no-mesh", 0, 0, "", "as --mesh none", [](const Values&, Settings& s) { s.mesh = MeshLines::none; }},
    Option<Settings>{"--no-ground", 0, 0, "", "without the ground of a mesh of terrain",
                     [](const Values&, Settings& s) { s.ground = false; }},
    Option<Settings>{"--outline", 1, 1, "start", "draw the outline of the bodies at the start over the particles",
                     [](const Values& w, Settings& s) { s.start_outline = is_start(w[0]); }},
    Option<Settings>{"--out", 1, 1, "PATH", "a .png or a folder; default DIR/pictures", [](const Values& w, Settings& s) { s.out = w[0]; }},
    Option<Settings>{"--up", 3, 3, "X Y Z", "3-D: up in the picture", [](const Values& w, Settings& s) { s.up = vector_of(w, "--up"); },
                     true},
    Option<Settings>{"--title", 1, 1, "TEXT", "above the picture", [](const Values& w, Settings& s) { s.title = w[0]; }, true},
    Option<Settings>{"--radius", 1, 1, "R", "of a particle as drawn [m]",
                     [](const Values& w, Settings& s) { s.radius = positive_number(w[0], "--radius"); }, true}};

constexpr std::array surface_options{
    Option<SurfaceSettings>{"--frame", 1, 1, "WHICH",
                            "last (default), first, all, the number of one from 0, or FROM:TO[:STEP]; several become numbered files",
                            [](const Values& w, SurfaceSettings& s) { s.frames = frames_of(w[0], "--frame"); }},
    Option<SurfaceSettings>{"--spacing", 1, 1, "H",
                            "between the points where the density is reckoned [m]; default half the width of a particle",
                            [](const Values& w, SurfaceSettings& s) { s.spacing = positive_number(w[0], "--spacing"); }},
    Option<SurfaceSettings>{"--level", 1, 1, "F", "share of the density inside at which the surface lies; default 0.5",
                            [](const Values& w, SurfaceSettings& s) { s.level = positive_number(w[0], "--level"); }},
    Option<SurfaceSettings>{"--field", 1, 1, "NAME[:component]", "colours the vertices of a .ply by a particle field",
                            [](const Values& w, SurfaceSettings& s) { s.field = w[0]; }},
    Option<SurfaceSettings>{"--out", 1, 1, "FILE", ".ply, .stl or .obj; of a 2-D run .obj, whose lines are the contour",
                            [](const Values& w, SurfaceSettings& s) { s.out = w[0]; }},
    Option<SurfaceSettings>{"--body", 2, 2, "NUMBER NAME", "one more body",
                            [](const Values& w, SurfaceSettings& s) {
                              s.bodies.push_back({number<int>(w[0], "--body"), w[1]});
                            },
                            true, true}};

constexpr std::array map_options{
    Option<MapSettings>{"--only", 1, 12, "NAME...",
                        "maps to draw, such as thickness_max arrival, or sections; default all but surfaces, and sections",
                        [](const Values& w, MapSettings& s) { s.only = w; }},
    Option<MapSettings>{"--range", 2, 2, "LOW HIGH", "values at the ends of the colours, of a single map or a movie; default all there are",
                        [](const Values& w, MapSettings& s) { s.range = std::get<std::array<Real, 2>>(range_of(w)); }},
    Option<MapSettings>{"--map", 1, 1, "{viridis,cividis,coolwarm}", "colours; default viridis",
                        [](const Values& w, MapSettings& s) { s.map = choice<Map>(w[0], "--map"); }},
    Option<MapSettings>{"--log", 0, 0, "", "colours by the logarithm of the values", [](const Values&, MapSettings& s) { s.log = true; }},
    Option<MapSettings>{"--contours", 1, 1, "STEP", "between contours of the ground [m]; default a round number",
                        [](const Values& w, MapSettings& s) { s.contours = positive_number(w[0], "--contours"); }},
    Option<MapSettings>{"--size", 1, 1, "WxH", "pixels, such as 1280x960; default 1280 wide, as high as the map needs",
                        [](const Values& w, MapSettings& s) { s.size = picture_size(w[0]); }},
    Option<MapSettings>{"--out", 1, 1, "FOLDER", "default DIR/pictures", [](const Values& w, MapSettings& s) { s.out = w[0]; }},
    Option<MapSettings>{"--title", 1, 1, "TEXT", "above the picture", [](const Values& w, MapSettings& s) { s.title = w[0]; }, true},
    Option<MapSettings>{"--axes", 2, 2, "RIGHT UP", "names of the axes of the plan",
                        [](const Values& w, MapSettings& s) {
                          s.axes = {w[0], w[1]};
                        },
                        true},
    Option<MapSettings>{"--frames", 0, 0, "", "the frames of the thickness instead", [](const Values&, MapSettings& s) { s.frames = true; },
                        true}};

/// Settings of what stands on the command line; what is wrong with it is added to `problems`.
template <class S>
S read_settings(std::span<const std::string> words, std::vector<std::string>& problems)
{
  S settings;
  CLI::App app;
  app.set_help_flag();
  app.add_option("DIR", settings.folder);
  add_options(app, S::options(), [&](const Option<S>& option, const Values& values) {
    try {
      option.set(values, settings);
      if constexpr (requires { settings.given; })
        settings.given.emplace_back(option.name);
    } catch (const Error& error) {
      problems.emplace_back(error.what());
    }
  });
  parse_words(app, words, problems);
  if (settings.folder.empty())
    problems.emplace_back("the folder of a run is missing");
  return settings;
}

template <class S>
std::string help(const char* command)
{
  CLI::App app;
  app.set_help_flag();
  app.add_option("DIR", "folder of a run");
  add_options(app, S::options(), [](const Option<S>&, const Values&) {});
  return app.help(command) + "\n";
}

}  // namespace

std::span<const Option<Settings>> Settings::options() { return picture_options; }
std::span<const Option<SurfaceSettings>> SurfaceSettings::options() { return surface_options; }
std::span<const Option<MapSettings>> MapSettings::options() { return map_options; }

Settings parse_picture(std::span<const std::string> words, std::vector<std::string>& problems)
{
  auto s = read_settings<Settings>(words, problems);
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
  auto s = read_settings<SurfaceSettings>(words, problems);
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
  auto s = read_settings<MapSettings>(words, problems);
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
  return "Draws the particles of DIR/particles.pvd, writes the surface of bodies, draws DIR/maps and DIR/sections, or a curve of a table.\n"
         "Pictures need a display; `talus render` brings one.\n\n" +
         help<Settings>("talus-render") + help<SurfaceSettings>("talus-render surface") + help<MapSettings>("talus-render map") +
         "talus-render chart TABLE.csv --x COLUMN --y COLUMN [--level NAME VALUE]... [--title TEXT] --out FILE.png\n";
}

}  // namespace talus::render
