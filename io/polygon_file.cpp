#include "io/polygon_file.hpp"

#include "io/gdal_door.hpp"

namespace talus {

PolygonFile read_polygons(const std::filesystem::path& file) { return gdal().read_polygons(file); }

}  // namespace talus
