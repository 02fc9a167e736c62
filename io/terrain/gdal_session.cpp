#include "io/terrain/gdal_session.hpp"

#include <cpl_conv.h>
#include <cpl_http.h>
#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <span>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"

namespace talus {

namespace {

// Formats that contain values and outlines themselves.  Other formats of GDAL, such as VRT and WMS, name further files, servers or
// programs; a scene from someone else must not make this machine access those.
constexpr std::array<const char*, 10> raster_formats{"GTiff", "AAIGrid", "EHdr",  "ENVI",    "HFA",
                                                     "GSAG",  "GSBG",    "GS7BG", "USGSDEM", nullptr};
constexpr std::array<const char*, 8> outline_formats{"GeoJSON", "ESRI Shapefile", "GPKG", "CSV", "DXF", "FlatGeobuf", "KML", nullptr};

bool is_one_of(std::span<const char* const> names, std::string_view name)
{
  return std::any_of(names.begin(), names.end(), [&](const char* one) { return one != nullptr && name == one; });
}

/// Called by GDAL for access to the network, which is refused.
CPLHTTPResult* refuse_network(const char*, CSLConstList, GDALProgressFunc, void*, CPLHTTPFetchWriteFunc, void*, void*)
{
  auto* const result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
  result->nStatus = 1;
  result->pszErrBuf = CPLStrdup("files of others are not read over the network");
  return result;
}

/// Registers the formats above and disables access to the network, so that no other driver can be used.
void know_formats()
{
  CPLSetConfigOption("OGR_SQLITE_STATIC_VIRTUAL_OGR", "NO");         // a GeoPackage may else contain a table that is another file
  CPLSetConfigOption("CPL_VSIL_CURL_ALLOWED_FILENAME", "/nothing");  // of /vsicurl/ and its kin
  CPLHTTPSetFetchCallback(refuse_network, nullptr);
  GDALAllRegister();
  for (int i = GDALGetDriverCount(); i-- > 0;)
    if (const GDALDriverH driver = GDALGetDriver(i);
        !is_one_of(raster_formats, GDALGetDriverShortName(driver)) && !is_one_of(outline_formats, GDALGetDriverShortName(driver))) {
      GDALDeregisterDriver(driver);
      GDALDestroyDriver(driver);
    }
}

/// The files beside a raster or outlines that belong to it by their names (.prj, .tfw, .dbf, .aux.xml) are opened by GDAL: a pipe would keep it
/// waiting without end.
void check_beside(const std::filesystem::path& whole, const std::filesystem::path& file)
{
  std::error_code unreadable;
  const std::string stem = file.stem().string() + '.';
  for (const auto& entry : std::filesystem::directory_iterator(whole.parent_path(), unreadable))
    if (entry.path().filename().string().starts_with(stem))
      if (std::error_code unknown; std::filesystem::is_other(std::filesystem::status(entry.path(), unknown)))
        throw EnvironmentError(fmt::format("{}: {}, which belongs to it by its name, is not an ordinary file", file.string(),
                                           entry.path().filename().string()));
}

std::string code_of(OGRSpatialReferenceH crs)
{
  const char *const authority = OSRGetAuthorityName(crs, nullptr), *const code = OSRGetAuthorityCode(crs, nullptr);
  return authority != nullptr && code != nullptr ? fmt::format("{}:{}", authority, code) : "";
}

/// A .prj has no code in it, but is usually one of those that have.
std::string code_of_the_same(OGRSpatialReferenceH crs)
{
  constexpr int sure = 90;  // of 100: the same but for names
  int count = 0;
  int* confidence = nullptr;
  OGRSpatialReferenceH* const matches = OSRFindMatches(crs, nullptr, &count, &confidence);
  const std::string code = count > 0 && *confidence >= sure ? code_of(*matches) : "";
  OSRFreeSRSArray(matches);
  CPLFree(confidence);
  return code;
}

}  // namespace

GdalSession::GdalSession()
{
  static std::once_flag known;
  std::call_once(known, know_formats);
  CPLPushErrorHandlerEx(listen, this);
}

GdalSession::~GdalSession() { CPLPopErrorHandler(); }

void GdalSession::listen(CPLErr kind, CPLErrorNum, const char* text)
{
  if (auto* const session = static_cast<GdalSession*>(CPLGetErrorHandlerUserData()); kind >= CE_Failure && session->error_.empty())
    session->error_ = text;
}

void GdalSession::fail(const std::filesystem::path& file, const std::string& what) const
{
  throw EnvironmentError(fmt::format("{}: {}{}{}", file.string(), what, error_.empty() ? "" : ": ", error_));
}

Dataset open_dataset(const GdalSession& session, const std::filesystem::path& file, unsigned kind)
{
  std::error_code unknown;
  if (!std::filesystem::exists(file, unknown))
    throw EnvironmentError(fmt::format("{}: there is no such file", file.string()));
  if (const auto reason = not_ordinary(file))
    throw EnvironmentError(fmt::format("{}: {}", file.string(), *reason));
  const std::filesystem::path whole = std::filesystem::absolute(file, unknown);  // a name such as "GTIFF_DIR:..." means something to GDAL
  if (whole.string().starts_with("/vsi"))
    throw EnvironmentError(fmt::format("{}: is in a folder whose name GDAL takes for another file system", file.string()));
  check_beside(whole, file);
  const bool of_values = kind == GDAL_OF_RASTER;
  Dataset opened(GDALOpenEx(whole.c_str(), kind | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                            of_values ? raster_formats.data() : outline_formats.data(), nullptr, nullptr));
  if (opened == nullptr)
    session.fail(file, of_values ? "is no raster of a format that is read (GeoTIFF, ESRI ASCII grid, .bil, ENVI, .img, Surfer grid, USGS "
                                   "DEM); gdal_translate makes a GeoTIFF of any other"
                                 : "has no outlines of a format that is read (GeoJSON, shapefile, GeoPackage, CSV with WKT, DXF, "
                                   "FlatGeobuf, KML); ogr2ogr makes a GeoPackage of any other");
  return opened;
}

Crs crs_of(const std::string& text)
{
  Crs crs(OSRNewSpatialReference(nullptr));
  constexpr std::array<const char*, 3> text_only{"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
  if (text.empty() || OGRSpatialReference::FromHandle(crs.get())->SetFromUserInput(text.c_str(), text_only.data()) != OGRERR_NONE)
    return nullptr;
  OSRSetAxisMappingStrategy(crs.get(), OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

std::string text_of(OGRSpatialReferenceH crs)
{
  if (crs == nullptr)
    return {};
  const std::string code = code_of(crs);
  if (!code.empty())
    return code;
  const std::string known = code_of_the_same(crs);
  if (!known.empty())
    return known;
  constexpr std::array<const char*, 2> newest{"FORMAT=WKT2", nullptr};
  char* text = nullptr;
  const bool written = OSRExportToWktEx(crs, &text, newest.data()) == OGRERR_NONE;
  const std::string wkt = written && text != nullptr ? text : "";
  CPLFree(text);
  return wkt;
}

}  // namespace talus
