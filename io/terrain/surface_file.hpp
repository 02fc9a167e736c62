#pragma once
// Surfaces that a scene speaks of, read: from files, points and numbers.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "io/scene/scene_surface.hpp"
#include "io/terrain/polygon_file.hpp"
#include "mesh/geometry/surface.hpp"

namespace talus {

/// What a surface or an outline of a scene is read into.
struct MapPlan {
  std::filesystem::path directory;  ///< of the scene: files are relative to it
  std::string crs;                  ///< of the map; empty: not known, and taken from the first file that says one
  bool is_line = false;             ///< 2-D without a section: places of the plan are (x, 0), points are [x, elevation]
  Surface ground;                   ///< what `depth` is counted from; none while it is the ground itself that is read
};

struct SurfaceRead {
  Surface at;
  std::string name;              ///< of the file; empty: none
  std::optional<MapBox> extent;  ///< outside of which there is no value; nothing: it goes on without end
  Real spacing = 0;              ///< [m] of what it was made of; zero: without
};

/// Holes in rasters up to so many cells across are filled.
inline constexpr Index largest_hole_filled = 10;

/// "0..100 east, 20..50 north"
std::string to_words(const MapBox& box);

/// Nothing where something is wrong: `problems` then has what.  What was mended, or taken for granted, is in `repairs`, one sentence each.
/// `plan.crs` becomes that of the file where it was empty.  EnvironmentError: GDAL cannot be loaded.
std::optional<SurfaceRead> read_surface(const SurfaceSpec& spec, MapPlan& plan, std::vector<SceneError>& problems,
                                        std::vector<std::string>& repairs);

/// A problem, if the surface has no value somewhere within the outline: which extents it has and which are wanted, or where the hole is.
/// `of`: what is so named, "domain".
void check_cover(const SurfaceRead& surface, const SourceLocation& where, const MapRing& outline, const std::string& of,
                 std::vector<SceneError>& problems);

}  // namespace talus
