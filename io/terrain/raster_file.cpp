#include "io/terrain/raster_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/terrain/ascii_grid.hpp"
#include "io/terrain/gdal_plugin.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

std::string as_table(const Raster& raster)
{
  std::string text = fmt::format("x [m],y [m],value{}\n", raster.unit.empty() ? "" : " [" + raster.unit + "]");
  for (Index r = 0; r < raster.rows; ++r)
    for (Index c = 0; c < raster.columns; ++c)
      if (const Real value = raster.at(c, r); std::isfinite(value))
        fmt::format_to(std::back_inserter(text), "{},{},{}\n", raster.west + (static_cast<Real>(c) + 0.5) * raster.dx,
                       raster.south + (static_cast<Real>(r) + 0.5) * raster.dy, value);
  return text;
}

std::string as_ascii_grid(const Raster& raster)
{
  constexpr Real same = 1e-9;
  if (std::abs(raster.dx - raster.dy) > same * raster.dx)
    throw EnvironmentError(
        fmt::format("cells of {:g} m by {:g} m are no squares, which an ESRI ASCII grid wants: write a .tif", raster.dx, raster.dy));
  std::string text = fmt::format("ncols {}\nnrows {}\nxllcorner {}\nyllcorner {}\ncellsize {}\nNODATA_value -9999\n", raster.columns,
                                 raster.rows, raster.west, raster.south, raster.dx);
  for (Index r = raster.rows; r-- > 0;)
    for (Index c = 0; c < raster.columns; ++c) {
      const Real value = raster.at(c, r);
      fmt::format_to(std::back_inserter(text), "{}{}", std::isfinite(value) ? static_cast<float>(value) : -9999.0F,
                     c + 1 < raster.columns ? ' ' : '\n');
    }
  return text;
}

}  // namespace

Raster read_raster(const fs::path& file, std::vector<std::string>* passed_over)
{
  const GdalPart& part = gdal();
  if (!not_ordinary(file) && is_ascii_grid(file)) {
    std::vector<std::string> found = check_ascii_grid(file);
    if (passed_over != nullptr)
      *passed_over = std::move(found);
  }
  return part.read_raster(file);
}

void write_raster(const fs::path& file, const Raster& raster)
{
  const std::string kind = file.extension().string();
  try {
    if (kind == ".tif" || kind == ".tiff")
      write_whole(file, [&](const fs::path& temporary) { gdal().write_geotiff(temporary, raster); });
    else if (kind == ".asc") {
      write_whole(file, as_ascii_grid(raster));
      if (!raster.crs.empty())
        write_whole(fs::path(file).replace_extension(".prj"), gdal().esri_text(raster.crs) + "\n");
    } else if (kind == ".csv")
      write_whole(file, as_table(raster));
    else
      throw EnvironmentError(fmt::format("maps are .tif, .asc or .csv, not '{}'", kind));
  } catch (const EnvironmentError& wrong) {
    const std::string_view text = wrong.what();
    throw text.find(file.string()) != text.npos ? wrong : EnvironmentError(fmt::format("cannot write {}: {}", file.string(), text));
  }
}

}  // namespace talus
