#pragma once
// Settings of pictures and surfaces: parsed and checked before anything is read or drawn.
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

/// An option of the command line: the number of its words and the function that sets its value.  The function throws Error for wrong words.
template <class S>
struct Option {
  std::string_view name;
  int least, most;
  std::string_view values, help;
  void (*set)(const std::vector<std::string>& words, S& settings);
  bool internal = false;  ///< passed on by `talus` from the scene; only talus-render accepts it
  bool repeated = false;  ///< whether it may be repeated
};

/// A range of frames, counted from zero; nothing means the last one.
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

/// A clipping plane: points with normal . x > offset are left out.
struct Plane {
  Vec3 normal;
  Real offset;  ///< in m
};

struct Settings {
  std::filesystem::path folder;      ///< folder of particles.pvd, and of mesh.vtu or mesh.pvd for the lines of the mesh
  std::optional<std::string> field;  ///< see read_cloud()
  std::variant<RangeOf, std::array<Real, 2>> range = RangeOf::last;  ///< range of the colours [SI units]
  Map map = Map::viridis;
  bool log = false;
  Frames frames;
  std::optional<std::array<int, 2>> size;                   ///< in pixels; default 1280 wide, and as high as the particles need
  std::variant<Vec3, NamedView> view = Vec3(0.4, -1, 0.5);  ///< 3-D: direction from the particles to the camera
  Vec3 up{0, 0, 1};                                         ///< 3-D: up in the picture
  std::vector<Real> look_at;                                ///< one number per dimension [m], or empty
  Real zoom = 1;
  bool perspective = true;                    ///< in 3-D
  std::optional<std::array<Real, 4>> window;  ///< 2-D: low and high corner [m]
  std::optional<Plane> clip;
  MeshLines mesh = MeshLines::outline;
  bool ground = true;  ///< whether the ground of a mesh made from terrain is drawn
  bool start_outline = false;
  std::optional<std::filesystem::path> out;  ///< a .png, or a folder; default pictures/ in `folder`
  std::string title;
  std::optional<Real> radius;      ///< radius of a drawn particle [m]; default from their spacing
  std::vector<std::string> given;  ///< options that were given
  static std::span<const Option<Settings>> options();
};

struct SurfaceSettings {
  std::filesystem::path folder;  ///< folder of particles.pvd
  struct Body {
    int number;  ///< value of the field "body"
    std::string name;
  };
  std::vector<Body> bodies;  ///< one surface for each; empty: one surface of all particles
  Frames frames;
  std::optional<Real> spacing;  ///< spacing of the grid [m]
  Real level = 0.5;
  std::optional<std::string> field;
  std::filesystem::path out;
  static std::span<const Option<SurfaceSettings>> options();
};

struct MapSettings {
  std::filesystem::path folder;  ///< folder of maps and sections
  std::vector<std::string> only;
  std::optional<std::array<Real, 2>> range;
  Map map = Map::viridis;
  bool log = false;
  std::optional<Real> contours;  ///< interval of contours [m]
  std::optional<std::array<int, 2>> size;
  std::optional<std::filesystem::path> out;
  std::string title;
  std::array<std::string, 2> axes{"x", "y"};  ///< names of the plan axes, to the right and upwards
  bool frames = false;                        ///< whether the frames of the thickness are drawn instead
  static std::span<const Option<MapSettings>> options();
};

/// The facts about a run that settings depend on.
struct RunFacts {
  int dimension;
  std::size_t n_frames;
  struct Field {
    std::string name;
    int components;
  };
  std::vector<Field> fields;  ///< fields of the particles
};

/// Parses words of a command line; errors are added to `problems`.
Settings parse_picture(std::span<const std::string> words, std::vector<std::string>& problems);
SurfaceSettings parse_surface(std::span<const std::string> words, std::vector<std::string>& problems);
MapSettings parse_maps(std::span<const std::string> words, std::vector<std::string>& problems);
std::string usage();

/// Adds settings that the run cannot satisfy to `problems`.
void check(const Settings& settings, const RunFacts& facts, std::vector<std::string>& problems);
void check(const SurfaceSettings& settings, const RunFacts& facts, std::vector<std::string>& problems);
/// Throws Error with all problems, one per line, if there are any.
void require_none(const std::vector<std::string>& problems);

/// The numbers of the frames that exist in the run.
std::vector<std::size_t> chosen(const Frames& frames, std::size_t n_frames);

}  // namespace talus::render
