#include <fmt/format.h>
#include <ogr_api.h>

#include "core/error.hpp"
#include "io/terrain/gdal_part.hpp"
#include "io/terrain/gdal_session.hpp"

namespace talus::gdal_part {

namespace {

struct DestroyFeature {
  void operator()(OGRFeatureH feature) const noexcept { OGR_F_Destroy(feature); }
};
struct DestroyGeometry {
  void operator()(OGRGeometryH geometry) const noexcept { OGR_G_DestroyGeometry(geometry); }
};
using Feature = std::unique_ptr<std::remove_pointer_t<OGRFeatureH>, DestroyFeature>;
using Geometry = std::unique_ptr<std::remove_pointer_t<OGRGeometryH>, DestroyGeometry>;

MapRing ring_of(OGRGeometryH line)
{
  MapRing ring;
  for (int i = 0; i < OGR_G_GetPointCount(line); ++i)
    if (const std::array<Real, 2> corner{OGR_G_GetX(line, i), OGR_G_GetY(line, i)}; ring.empty() || corner != ring.back())
      ring.push_back(corner);
  if (ring.size() > 1 && ring.front() == ring.back())
    ring.pop_back();
  return ring;
}

/// Adds each part of a collection, and the area inside a closed line.
void add_polygons(OGRGeometryH geometry, const std::string& name, std::vector<MapPolygon>& found)
{
  const OGRwkbGeometryType type = wkbFlatten(OGR_G_GetGeometryType(geometry));
  if (type == wkbLineString && OGR_G_IsRing(geometry) != 0)
    found.push_back({name, ring_of(geometry), {}});
  else if (type == wkbPolygon) {
    MapPolygon polygon{name, {}, {}};
    for (int i = 0; i < OGR_G_GetGeometryCount(geometry); ++i) {
      MapRing ring = ring_of(OGR_G_GetGeometryRef(geometry, i));
      if (i == 0)
        polygon.outer = std::move(ring);
      else
        polygon.holes.push_back(std::move(ring));
    }
    if (polygon.outer.size() > 2)
      found.push_back(std::move(polygon));
  } else if (type != wkbLineString)
    for (int i = 0; i < OGR_G_GetGeometryCount(geometry); ++i)
      add_polygons(OGR_G_GetGeometryRef(geometry, i), name, found);
}

std::vector<MapPolygon> polygons_of(OGRLayerH layer)
{
  std::vector<MapPolygon> found;
  const int name = OGR_FD_GetFieldIndex(OGR_L_GetLayerDefn(layer), "name");
  OGR_L_ResetReading(layer);
  while (const Feature feature{OGR_L_GetNextFeature(layer)})
    // Arcs are approximated by chords, by default of GDAL one every four degrees.
    if (OGRGeometryH shape = OGR_F_GetGeometryRef(feature.get()))
      if (const Geometry straight{OGR_G_GetLinearGeometry(shape, 0, nullptr)})
        add_polygons(straight.get(), name >= 0 ? OGR_F_GetFieldAsString(feature.get(), name) : "", found);
  return found;
}

}  // namespace

PolygonFile read_polygons(const std::filesystem::path& file)
{
  const GdalSession session;
  const Dataset dataset = open_dataset(session, file, GDAL_OF_VECTOR);
  for (int i = 0; i < GDALDatasetGetLayerCount(dataset.get()); ++i) {
    const OGRLayerH layer = GDALDatasetGetLayer(dataset.get(), i);
    if (PolygonFile read{polygons_of(layer), text_of(OGR_L_GetSpatialRef(layer))}; !read.polygons.empty()) {
      if (!session.error().empty())
        session.fail(file, "cannot be read to its end");
      return read;
    }
  }
  session.fail(file, "has no polygon");
}

}  // namespace talus::gdal_part
