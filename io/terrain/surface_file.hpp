#pragma once
// Reads the surfaces of a scene, from files, points and numbers, and its outlines from files.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "io/scene/scene_surface.hpp"
#include "io/terrain/polygon_file.hpp"
#include "mesh/geometry/surface.hpp"

namespace talus {

/// The map of a scene, into which surfaces and outlines are read.
struct MapPlan {
  std::filesystem::path directory;  ///< folder of the scene, in which relative paths start
  std::string crs;                  ///< of the map; empty: unknown, and taken from the first file that has one
  bool is_line = false;             ///< 2-D without a section: positions of the plan are (x, 0), points are [x, elevation]
  Surface ground;                   ///< reference of `depth`; none while the ground itself is read
};

struct SurfaceRead {
  Surface at;
  std::string name;              ///< name of the file; empty if none
  std::optional<MapBox> extent;  ///< region with values; nothing if it is unlimited
  Real spacing = 0;              ///< spacing of the data [m]; zero if there is none
};

/// Holes in rasters up to this number of cells across are filled.
inline constexpr Index largest_hole_filled = 10;

/// The box as text: "0..100 east, 20..50 north".
std::string to_words(const MapBox& box);

/// Reads a surface; nothing after an error, which is added to `problems`.  Corrections and assumptions are added to `repairs`, one sentence
/// each.  An empty `plan.crs` becomes that of the file.  Throws EnvironmentError if GDAL cannot be loaded.
std::optional<SurfaceRead> read_surface(const SurfaceSpec& spec, MapPlan& plan, std::vector<SceneError>& problems,
                                        std::vector<std::string>& repairs);

/// Adds a problem if the surface has no value somewhere within the outline: its extents and those of the outline, or the position of the
/// hole.  `of` is the name of the outline, such as "domain".
void check_cover(const SurfaceRead& surface, const SourceLocation& where, const MapRing& outline, const std::string& of,
                 std::vector<SceneError>& problems);

/// The polygons of a file in map coordinates, reprojected if the file has another coordinate system.  Empty after an error.
std::vector<MapPolygon> read_outlines(const std::string& file, const SourceLocation& where, const MapPlan& plan,
                                      std::vector<SceneError>& problems, std::vector<std::string>& repairs);

}  // namespace talus
