#pragma once
// The maps that a run with outputs.runout writes: their names and contents.
#include <array>
#include <string_view>

namespace talus {

struct MapKind {
  std::string_view name;   ///< name of the file without its ending, and of the column of a section
  std::string_view title;  ///< title in pictures
  std::string_view unit;
};

/// All kinds of maps.  Maps of the ground are surfaces to draw on; the others have a value only where material has moved.
inline constexpr std::array map_kinds{
    MapKind{"ground", "ground before", "m"},        MapKind{"base", "base", "m"},
    MapKind{"surface", "surface after", "m"},       MapKind{"surface_max", "highest surface", "m"},
    MapKind{"thickness", "deposit thickness", "m"}, MapKind{"thickness_max", "largest thickness", "m"},
    MapKind{"speed_max", "largest speed", "m/s"},   MapKind{"intensity_max", "largest intensity h v^2", "m^3/s^2"},
    MapKind{"arrival", "time of arrival", "s"},     MapKind{"source", "depth that has left", "m"},
    MapKind{"erosion", "depth of erosion", "m"}};

constexpr bool is_surface(std::string_view map) { return map == "ground" || map == "base" || map == "surface" || map == "surface_max"; }

}  // namespace talus
