#include "io/gdal_door.hpp"

#include "io/module.hpp"

namespace talus {

const GdalPart& gdal()
{
  static const auto& part = *static_cast<const GdalPart*>(open_module("gdal", "talus_gdal_part", "reads and writes maps with GDAL"));
  return part;
}

}  // namespace talus
