// The functions that libtalus_gdal.so exports.
#include "io/terrain/gdal_part.hpp"

extern "C" {
extern const talus::GdalPart talus_gdal_part;
const talus::GdalPart talus_gdal_part{talus::gdal_part::read_raster,   talus::gdal_part::write_geotiff, talus::gdal_part::triangulate,
                                      talus::gdal_part::read_polygons, talus::gdal_part::crs_facts,     talus::gdal_part::same_plan,
                                      talus::gdal_part::to_crs,        talus::gdal_part::esri_text};
}
