#pragma once
// The functions of libtalus_gdal.so that GdalPart lists (io/terrain/gdal_plugin.hpp).
#include "io/terrain/gdal_plugin.hpp"

namespace talus::gdal_part {

Raster read_raster(const std::filesystem::path& file);
void write_geotiff(const std::filesystem::path& file, const Raster& raster);
std::vector<std::array<Index, 3>> triangulate(const std::vector<std::array<Real, 3>>& points);
PolygonFile read_polygons(const std::filesystem::path& file);
std::optional<CrsFacts> crs_facts(const std::string& text);
bool same_plan(const std::string& one, const std::string& other);
std::vector<std::array<Real, 2>> to_crs(const std::string& from, const std::string& to, const std::vector<std::array<Real, 2>>& places);
std::string esri_text(const std::string& text);

}  // namespace talus::gdal_part
