#include "io/terrain/gdal_plugin.hpp"

#include "io/system/plugin.hpp"

namespace talus {

const GdalPart& gdal()
{
  static const auto& part = *static_cast<const GdalPart*>(open_module("gdal", "talus_gdal_part", "reads and writes maps with GDAL"));
  return part;
}

PolygonFile read_polygons(const std::filesystem::path& file) { return gdal().read_polygons(file); }

}  // namespace talus
