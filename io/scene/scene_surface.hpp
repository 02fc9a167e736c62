#pragma once
// Surfaces in a scene: ground, bottoms of layers, the water table.
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/fields.hpp"

namespace talus {

/// Exactly one of file, elevation, depth and points.
struct SurfaceSpec {
  std::string file;
  std::optional<Real> elevation, depth;
  std::vector<std::vector<Real>> points;
  SourceLocation where;
  static constexpr auto fields()
  {
    return std::tuple{
        optional("file", &SurfaceSpec::file, any, "-",
                 "a raster (GeoTIFF, ESRI ASCII grid and what else GDAL reads), an .stl, or a .csv or .xyz of points x, y, z; relative to "
                 "the scene"),
        optional("elevation", &SurfaceSpec::elevation, any, "m", "a level surface"),
        optional("depth", &SurfaceSpec::depth, non_negative, "m", "so far below the ground everywhere"),
        optional("points", &SurfaceSpec::points, any, "m",
                 "2-D: a line through [x, y], x growing; 3-D: points [x, y, z], triangulated; on the map where there is one")};
  }
  void check(std::vector<std::string>& problems) const;
};

}  // namespace talus
