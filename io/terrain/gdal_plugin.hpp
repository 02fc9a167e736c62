#pragma once
// Access to GDAL, which is in a plugin (libtalus_gdal.so).
#include <filesystem>

#include "io/terrain/map_crs.hpp"
#include "io/terrain/polygon_file.hpp"
#include "mesh/geometry/raster.hpp"

namespace talus {

/// The functions of the plugin.  Those without a comment are described with the functions of the same name.
struct GdalPart {
  Raster (*read_raster)(const std::filesystem::path&);
  /// Writes to a path with any extension.  Throws EnvironmentError with the reason only, as the name of the file is not yet the final one.
  void (*write_geotiff)(const std::filesystem::path&, const Raster&);
  /// Delaunay triangles of points in the plan; none if all points lie on a line.
  std::vector<std::array<Index, 3>> (*triangulate)(const std::vector<std::array<Real, 3>>& points);
  PolygonFile (*read_polygons)(const std::filesystem::path&);
  std::optional<CrsFacts> (*crs_facts)(const std::string&);
  bool (*same_plan)(const std::string&, const std::string&);
  std::vector<std::array<Real, 2>> (*to_crs)(const std::string&, const std::string&, const std::vector<std::array<Real, 2>>&);
  /// A coordinate system in the notation of a .prj file.
  std::string (*esri_text)(const std::string& crs);
};

/// The plugin.  Throws EnvironmentError if it is not beside the program or its libraries, or cannot be loaded.
const GdalPart& gdal();

}  // namespace talus
