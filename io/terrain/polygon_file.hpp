#pragma once
// Polygons in files: outlines that were drawn in a GIS.
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// Corners (x, y) of a ring; the last is not the first again.
using MapRing = std::vector<std::array<Real, 2>>;

struct MapPolygon {
  std::string name;  ///< attribute `name`, if there is one
  MapRing outer;
  std::vector<MapRing> holes;
};

struct PolygonFile {
  std::vector<MapPolygon> polygons;  ///< in the order of the file; of many parts each is one
  std::string crs;                   ///< as in MapFrame; empty: the file does not say
};

/// GeoJSON, shapefile, GeoPackage, .csv with a column WKT and what else GDAL reads; the first layer that has polygons.  EnvironmentError
/// names the file, also where there is no polygon in it.
PolygonFile read_polygons(const std::filesystem::path& file);

}  // namespace talus
