#pragma once
// What a picture, or the surface of a body, is to be: from words of a command line, checked, before anything is read or drawn.
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/types.hpp"

namespace talus::render {

/// An option of a command line and how many words follow it.
struct Option {
  std::string_view name;
  int least, most;
  std::string_view values, help;
};

// What both `talus render` and talus-render understand.
inline constexpr std::array picture_options{
    Option{"--field", 1, 1, "NAME[:component]", "particle field that colours the particles; default what the scene says"},
    Option{"--range", 1, 2, "LOW HIGH|last|whole",
           "values at the ends of the colours; default those of the last frame; whole: of all frames"},
    Option{"--map", 1, 1, "{viridis,cividis,coolwarm}", "colours; default viridis; coolwarm has its middle at zero"},
    Option{"--log", 0, 0, "", "colours by the logarithm of the values"},
    Option{"--frames", 1, 1, "WHICH", "last (default), first, all, the number of one from 0, or FROM:TO[:STEP]"},
    Option{"--size", 1, 1, "WxH", "pixels, such as 1280x720"},
    Option{"--view", 1, 3, "{front,back,left,right,top,iso}|X Y Z", "3-D: or the direction from the scene to the camera"},
    Option{"--look-at", 2, 3, "X Y [Z]", "point in the middle of the picture [m]"},
    Option{"--zoom", 1, 1, "F", "so many times larger than what shows everything"},
    Option{"--perspective", 0, 0, "", "3-D: far things are smaller (default)"},
    Option{"--orthographic", 0, 0, "", "3-D: far things are as large as near ones"},
    Option{"--window", 4, 4, "XLOW YLOW XHIGH YHIGH", "2-D: the part to show [m]"},
    Option{"--clip", 2, 4, "AXIS OFFSET|NX NY NZ OFFSET", "leave out the particles beyond a plane, those with n.x > offset [m]"},
    Option{"--mesh", 1, 1, "{outline,edges,none}", "lines; edges: of all cells, in 3-D of the boundary; default what the scene says"},
    Option{"--no-mesh", 0, 0, "", "as --mesh none"},
    Option{"--no-ground", 0, 0, "", "without the ground of a mesh of terrain"},
    Option{"--outline", 1, 1, "start", "draw the outline of the bodies at the start over the particles"},
    Option{"--out", 1, 1, "PATH", "a .png or a folder; default DIR/pictures"}};

inline constexpr std::array surface_options{
    Option{"--frame", 1, 1, "WHICH",
           "last (default), first, all, the number of one from 0, or FROM:TO[:STEP]; several become numbered files"},
    Option{"--spacing", 1, 1, "H", "between the points where the density is reckoned [m]; default half the width of a particle"},
    Option{"--level", 1, 1, "F", "share of the density inside at which the surface lies; default 0.5"},
    Option{"--field", 1, 1, "NAME[:component]", "colours the vertices of a .ply by a particle field"},
    Option{"--out", 1, 1, "FILE", ".ply, .stl or .obj; of a 2-D run .obj, whose lines are the contour"}};

inline constexpr std::array map_options{
    Option{"--only", 1, 12, "NAME...", "maps to draw, such as thickness_max arrival, or sections; default all but surfaces, and sections"},
    Option{"--range", 2, 2, "LOW HIGH", "values at the ends of the colours, of a single map or a movie; default all there are"},
    Option{"--map", 1, 1, "{viridis,cividis,coolwarm}", "colours; default viridis"},
    Option{"--log", 0, 0, "", "colours by the logarithm of the values"},
    Option{"--contours", 1, 1, "STEP", "between contours of the ground [m]; default a round number"},
    Option{"--size", 1, 1, "WxH", "pixels, such as 1280x960; default 1280 wide, as high as the map needs"},
    Option{"--out", 1, 1, "FOLDER", "default DIR/pictures"}};

/// From one frame to another, counted from zero; nothing stands for the last.
struct Frames {
  std::optional<std::size_t> first, last;
  std::size_t step = 1;
};

enum class Map : std::uint8_t { viridis, cividis, coolwarm };
constexpr std::array<std::string_view, 3> enum_names(Map) { return {"viridis", "cividis", "coolwarm"}; }
enum class MeshLines : std::uint8_t { outline, edges, none };
constexpr std::array<std::string_view, 3> enum_names(MeshLines) { return {"outline", "edges", "none"}; }
enum class NamedView : std::uint8_t { front, back, left, right, top, iso };
constexpr std::array<std::string_view, 6> enum_names(NamedView) { return {"front", "back", "left", "right", "top", "iso"}; }
enum class RangeOf : std::uint8_t { last, whole };
constexpr std::array<std::string_view, 2> enum_names(RangeOf) { return {"last", "whole"}; }

/// What lies beyond it, normal . x > offset, is left out.
struct Plane {
  Vec3 normal;
  Real offset;  ///< m
};

struct Settings {
  std::filesystem::path folder;      ///< holds particles.pvd, and mesh.vtu or mesh.pvd for the lines of the mesh
  std::optional<std::string> field;  ///< see read_cloud
  std::variant<RangeOf, std::array<Real, 2>> range = RangeOf::last;  ///< of the colours [SI]
  Map map = Map::viridis;
  bool log = false;
  Frames frames;
  std::optional<std::array<int, 2>> size;                   ///< pixels; default 1280 wide, as high as the particles need
  std::variant<Vec3, NamedView> view = Vec3(0.4, -1, 0.5);  ///< 3-D: direction from the particles to the camera
  Vec3 up{0, 0, 1};                                         ///< 3-D: up in the picture
  std::vector<Real> look_at;                                ///< m; one number per dimension, or none
  Real zoom = 1;
  bool perspective = true;                    ///< in 3-D
  std::optional<std::array<Real, 4>> window;  ///< m, 2-D: low corner, high corner
  std::optional<Plane> clip;
  MeshLines mesh = MeshLines::outline;
  bool ground = true;  ///< that of a mesh of terrain is drawn
  bool start_outline = false;
  std::optional<std::filesystem::path> out;  ///< a .png, or a folder; default: pictures/ in `folder`
  std::string title;
  std::optional<Real> radius;      ///< of a particle as drawn [m]; default from their spacing
  std::vector<std::string> given;  ///< options that stood there
};

struct SurfaceSettings {
  std::filesystem::path folder;  ///< holds particles.pvd
  struct Body {
    int number;  ///< in the field "body"
    std::string name;
  };
  std::vector<Body> bodies;  ///< a surface of each; none: of all particles together
  Frames frames;
  std::optional<Real> spacing;  ///< m
  Real level = 0.5;
  std::optional<std::string> field;
  std::filesystem::path out;
};

struct MapSettings {
  std::filesystem::path folder;  ///< holds maps and sections
  std::vector<std::string> only;
  std::optional<std::array<Real, 2>> range;
  Map map = Map::viridis;
  bool log = false;
  std::optional<Real> contours;  ///< m
  std::optional<std::array<int, 2>> size;
  std::optional<std::filesystem::path> out;
  std::string title;
  std::array<std::string, 2> axes{"x", "y"};  ///< of the plan, to the right and upwards
  bool frames = false;                        ///< draws the frames of the thickness instead
};

/// What a run has, so far as settings depend on it.
struct RunFacts {
  int dimension;
  std::size_t n_frames;
  struct Field {
    std::string name;
    int components;
  };
  std::vector<Field> fields;  ///< of the particles
};

/// Words of a command line to settings; what is wrong with them is added to `problems`.
Settings parse_picture(std::span<const std::string> words, std::vector<std::string>& problems);
SurfaceSettings parse_surface(std::span<const std::string> words, std::vector<std::string>& problems);
MapSettings parse_maps(std::span<const std::string> words, std::vector<std::string>& problems);
std::string usage();

/// What the run does not have.
void check(const Settings& settings, const RunFacts& facts, std::vector<std::string>& problems);
void check(const SurfaceSettings& settings, const RunFacts& facts, std::vector<std::string>& problems);
/// Error with all of them, a line each, if there are any.
void require_none(const std::vector<std::string>& problems);

/// Numbers of the frames; those that the run does not have are left out.
std::vector<std::size_t> chosen(const Frames& frames, std::size_t n_frames);

}  // namespace talus::render
