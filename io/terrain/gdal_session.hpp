#pragma once
// A session of GDAL: silent, with its errors stored.
#include <cpl_error.h>

#include <filesystem>
#include <memory>
#include <string>

#include <gdal.h>
#include <ogr_srs_api.h>

namespace talus {

/// While it exists GDAL prints nothing and its errors are stored.  The first session registers the formats.
class GdalSession {
 public:
  GdalSession();
  ~GdalSession();
  GdalSession(const GdalSession&) = delete;
  GdalSession& operator=(const GdalSession&) = delete;

  /// The first error since the session began; empty if there was none.
  const std::string& error() const noexcept { return error_; }
  /// Throws EnvironmentError with `file`, `what` and the error.
  [[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) const;

 private:
  static void CPL_STDCALL listen(CPLErr kind, CPLErrorNum number, const char* text);
  std::string error_;
};

struct CloseDataset {
  void operator()(GDALDatasetH dataset) const noexcept { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, CloseDataset>;
/// Opens an ordinary file of a format that contains its values itself, for reading; `kind` is GDAL_OF_RASTER or GDAL_OF_VECTOR.
Dataset open_dataset(const GdalSession& session, const std::filesystem::path& file, unsigned kind);

struct DestroyCrs {
  void operator()(OGRSpatialReferenceH crs) const noexcept { OSRRelease(crs); }
};
using Crs = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>, DestroyCrs>;
/// A coordinate system with x before y and longitude before latitude; nothing if the text is not understood.
Crs crs_of(const std::string& text);
/// "EPSG:32633" if there is such a code, otherwise WKT; empty for none.
std::string text_of(OGRSpatialReferenceH crs);

}  // namespace talus
