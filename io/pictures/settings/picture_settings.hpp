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

/// An option of a command line: how many words follow it, and what they set.  Error: they are not what is wanted.
template <class S>
struct Option {
  std::string_view name;
  int least, most;
  std::string_view values, help;
  void (*set)(const std::vector<std::string>& words, S& settings);
  bool internal = false;  ///< what `talus` says of the scene; only talus-render knows it
  bool repeated = false;  ///< may stand there several times
};

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
  static std::span<const Option<Settings>> options();
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
  static std::span<const Option<SurfaceSettings>> options();
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
  static std::span<const Option<MapSettings>> options();
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
