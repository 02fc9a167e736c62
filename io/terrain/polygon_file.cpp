#include "io/terrain/polygon_file.hpp"

#include "io/terrain/gdal_plugin.hpp"

namespace talus {

PolygonFile read_polygons(const std::filesystem::path& file) { return gdal().read_polygons(file); }

}  // namespace talus
