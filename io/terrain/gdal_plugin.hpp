#pragma once
// The way to GDAL, which is a part of its own (libtalus_gdal.so).
#include <filesystem>

#include "io/terrain/map_crs.hpp"
#include "io/terrain/polygon_file.hpp"
#include "mesh/geometry/raster.hpp"

namespace talus {

/// What the part hands out.  What is not said here is said of the functions of the same name.
struct GdalPart {
  Raster (*read_raster)(const std::filesystem::path&);
  /// To a path of any extension.  EnvironmentError says only what went wrong: the name of the file is not yet the one it will have.
  void (*write_geotiff)(const std::filesystem::path&, const Raster&);
  /// Delaunay's triangles of points on the plan; none where all of them lie on a line.
  std::vector<std::array<Index, 3>> (*triangulate)(const std::vector<std::array<Real, 3>>& points);
  PolygonFile (*read_polygons)(const std::filesystem::path&);
  std::optional<CrsFacts> (*crs_facts)(const std::string&);
  bool (*same_plan)(const std::string&, const std::string&);
  std::vector<std::array<Real, 2>> (*to_crs)(const std::string&, const std::string&, const std::vector<std::array<Real, 2>>&);
  /// A coordinate system as a .prj says it.
  std::string (*esri_text)(const std::string& crs);
};

/// EnvironmentError: the part is not where it belongs, beside the program or its libraries, or cannot be loaded.
const GdalPart& gdal();

}  // namespace talus
