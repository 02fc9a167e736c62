#pragma once
// Polygons in files: outlines drawn in a GIS.
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// The corners (x, y) of a ring; the first one is not repeated at the end.
using MapRing = std::vector<std::array<Real, 2>>;

struct MapPolygon {
  std::string name;  ///< attribute `name`, if there is one
  MapRing outer;
  std::vector<MapRing> holes;
};

struct PolygonFile {
  std::vector<MapPolygon> polygons;  ///< in the order of the file; each part of a multipart polygon is one
  std::string crs;                   ///< as in MapFrame; empty if not in the file
};

/// Reads GeoJSON, shapefile, GeoPackage, .csv with a column WKT and other formats of GDAL; the first layer with polygons.  Throws
/// EnvironmentError with the name of the file, also if it contains no polygon.
PolygonFile read_polygons(const std::filesystem::path& file);

}  // namespace talus
