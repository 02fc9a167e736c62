#include <cpl_conv.h>
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "io/terrain/gdal_part.hpp"
#include "io/terrain/gdal_session.hpp"

namespace talus::gdal_part {

namespace {

namespace fs = std::filesystem;

constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();
constexpr Real no_data = -9999;  // a common value in other programs, and not an elevation on a map

/// Sets position and spacing on the map; `from_north`: the first row of the file is the northernmost.
void set_place(GDALDatasetH dataset, const fs::path& file, Raster& raster, bool& from_north)
{
  std::array<double, 6> t{};
  if (GDALGetGeoTransform(dataset, t.data()) != CE_None)
    throw EnvironmentError(fmt::format("{}: the raster does not say where on the map it lies", file.string()));
  const auto [x0, dx, skew_x, y0, skew_y, dy] = t;
  constexpr Real straight = 1e-9;  // relative to the spacing: rounding of rotations given in degrees
  if (std::abs(skew_x) > straight * std::abs(dx) || std::abs(skew_y) > straight * std::abs(dy))
    throw EnvironmentError(
        fmt::format("{}: the rows of the raster are turned by {:.4g} degrees; turn it north up first: gdalwarp -r bilinear {} north_up.tif",
                    file.string(), std::atan2(skew_y, dx) * 180 / M_PI, file.filename().string()));
  if (!(dx > 0) || dy == 0)
    throw EnvironmentError(fmt::format("{}: cells of {:g} by {:g} are none", file.string(), dx, dy));
  from_north = dy < 0;
  raster.dx = dx;
  raster.dy = std::abs(dy);
  raster.west = x0;
  raster.south = from_north ? y0 + dy * raster.rows : y0;
}

/// The short name of a unit of height in the notation of GDAL and other programs.
std::string unit_in_short(const std::string& unit)
{
  return unit == "metre" || unit == "meter" || unit == "metres" || unit == "meters" ? "m" : unit;
}

/// Throws if a file is too short for its number of cells: it is damaged, or made to fill the memory.
void require_bytes(const fs::path& file, std::int64_t cells)
{
  constexpr std::uintmax_t most_from_one = 1000,
                           of_any_file = 1'000'000;  // largest number of cells per byte; four times what deflate reaches for equal values
  std::error_code unknown;
  const std::uintmax_t bytes = fs::file_size(file, unknown);
  if (!unknown && static_cast<std::uintmax_t>(cells) > of_any_file + most_from_one * bytes)
    throw EnvironmentError(fmt::format("{}: {} cells cannot be in {} bytes: the file is damaged", file.string(), cells, bytes));
}

/// Whether values may be truncated.  GDAL takes an ESRI ASCII grid for integers if its beginning has no decimal point: a cell "nan" is then
/// 0, and decimals further down are cut off.
bool may_be_cut(GDALDatasetH dataset)
{
  return std::string_view(GDALGetDriverShortName(GDALGetDatasetDriver(dataset))) == "AAIGrid" && GDALGetRasterCount(dataset) > 0 &&
         GDALGetRasterDataType(GDALGetRasterBand(dataset, 1)) == GDT_Int32;
}

Dataset open_raster(const GdalSession& session, const fs::path& file)
{
  Dataset dataset = open_dataset(session, file, GDAL_OF_RASTER);
  if (!may_be_cut(dataset.get()))
    return dataset;
  CPLSetThreadLocalConfigOption("AAIGRID_DATATYPE", "Float64");
  try {
    dataset = open_dataset(session, file, GDAL_OF_RASTER);
  } catch (...) {
    CPLSetThreadLocalConfigOption("AAIGRID_DATATYPE", nullptr);
    throw;
  }
  CPLSetThreadLocalConfigOption("AAIGRID_DATATYPE", nullptr);
  return dataset;
}

}  // namespace

Raster read_raster(const fs::path& file)
{
  const GdalSession session;
  const Dataset dataset = open_raster(session, file);
  Raster raster;
  raster.columns = GDALGetRasterXSize(dataset.get());
  raster.rows = GDALGetRasterYSize(dataset.get());
  if (GDALGetRasterCount(dataset.get()) == 0 || raster.columns < 1 || raster.rows < 1)
    session.fail(file, "is no raster: it has no band of values");
  constexpr std::int64_t most = 200'000'000;  // 1.6 GB
  if (static_cast<std::int64_t>(raster.columns) * raster.rows > most)
    throw EnvironmentError(
        fmt::format("{}: {} by {} cells are more than {} million; cut out what is needed first: gdal_translate -projwin WEST "
                    "NORTH EAST SOUTH {} part.tif",
                    file.string(), raster.columns, raster.rows, most / 1'000'000, file.filename().string()));
  require_bytes(file, static_cast<std::int64_t>(raster.columns) * raster.rows);
  bool from_north = true;
  set_place(dataset.get(), file, raster, from_north);
  raster.crs = text_of(GDALGetSpatialRef(dataset.get()));

  const GDALRasterBandH band = GDALGetRasterBand(dataset.get(), 1);
  raster.unit = unit_in_short(GDALGetRasterUnitType(band));
  raster.values.resize(static_cast<std::size_t>(raster.columns) * static_cast<std::size_t>(raster.rows));
  // Rows are read from north to south into rows from the south: a negative distance between rows flips the raster.
  const GSpacing row_bytes = static_cast<GSpacing>(sizeof(Real)) * raster.columns;
  Real* const first = from_north ? &raster.at(0, raster.rows - 1) : raster.values.data();
  if (GDALRasterIOEx(band, GF_Read, 0, 0, raster.columns, raster.rows, first, raster.columns, raster.rows, GDT_Float64, sizeof(Real),
                     from_north ? -row_bytes : row_bytes, nullptr) != CE_None)
    session.fail(file, "cannot be read to its end");

  int has_no_data = 0;
  Real none = GDALGetRasterNoDataValue(band, &has_no_data);
  if (GDALGetRasterDataType(band) == GDT_Float32 && std::isfinite(none))  // rounded like the values in the file
    none = std::abs(none) > std::numeric_limits<float>::max() ? none : static_cast<Real>(static_cast<float>(none));
  int scales = 0, shifts = 0;
  const Real scale = GDALGetRasterScale(band, &scales), shift = GDALGetRasterOffset(band, &shifts);
  for (Real& value : raster.values)
    if ((has_no_data != 0 && value == none) || !std::isfinite(value))
      value = nan;
    else if (scales != 0 || shifts != 0)
      value = value * (scales != 0 ? scale : 1) + (shifts != 0 ? shift : 0);
  return raster;
}

void write_geotiff(const fs::path& file, const Raster& raster)
{
  const GdalSession session;
  const auto check = [&](bool good) {
    if (!good || !session.error().empty())
      throw EnvironmentError(session.error().empty() ? "GDAL cannot write it" : session.error());
  };
  const GDALDriverH driver = GDALGetDriverByName("GTiff");
  check(driver != nullptr);
  std::array<char*, 4> options{const_cast<char*>("COMPRESS=DEFLATE"),
                               const_cast<char*>("PREDICTOR=3"),                 // NOLINT: GDAL does not change them
                               const_cast<char*>("BIGTIFF=IF_SAFER"), nullptr};  // NOLINT
  CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", "NO");                       // no .aux.xml beside the file
  Dataset dataset(GDALCreate(driver, file.c_str(), raster.columns, raster.rows, 1, GDT_Float32, options.data()));
  CPLSetThreadLocalConfigOption("GDAL_PAM_ENABLED", nullptr);
  check(dataset != nullptr);
  std::array<double, 6> place{raster.west, raster.dx, 0, raster.south + raster.dy * static_cast<Real>(raster.rows), 0, -raster.dy};
  check(GDALSetGeoTransform(dataset.get(), place.data()) == CE_None);
  if (const Crs crs = crs_of(raster.crs))
    check(GDALSetSpatialRef(dataset.get(), crs.get()) == CE_None);
  const GDALRasterBandH band = GDALGetRasterBand(dataset.get(), 1);
  check(GDALSetRasterNoDataValue(band, no_data) == CE_None);
  if (!raster.unit.empty())
    check(GDALSetRasterUnitType(band, raster.unit.c_str()) == CE_None);
  std::vector<Real> row(static_cast<std::size_t>(raster.columns));
  for (Index r = 0; r < raster.rows; ++r) {
    for (Index c = 0; c < raster.columns; ++c) {
      const Real value = raster.at(c, raster.rows - 1 - r);
      row[static_cast<std::size_t>(c)] = std::isfinite(value) ? value : no_data;
    }
    check(GDALRasterIO(band, GF_Write, 0, r, raster.columns, 1, row.data(), raster.columns, 1, GDT_Float64, 0, 0) == CE_None);
  }
  GDALFlushCache(dataset.get());
  dataset.reset();
  check(true);
}

}  // namespace talus::gdal_part
