#pragma once
// GDAL behind one door: silent, its complaints kept until somebody asks.
#include <cpl_error.h>

#include <filesystem>
#include <memory>
#include <string>

#include <gdal.h>
#include <ogr_srs_api.h>

namespace talus {

/// While it lives GDAL prints nothing and what it complains of is kept.  Formats are known from the first on.
class GdalSession {
 public:
  GdalSession();
  ~GdalSession();
  GdalSession(const GdalSession&) = delete;
  GdalSession& operator=(const GdalSession&) = delete;

  /// The first error since the session began; empty: none.
  const std::string& error() const noexcept { return error_; }
  /// EnvironmentError: `file`, `what` and the error.
  [[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) const;

 private:
  static void CPL_STDCALL listen(CPLErr kind, CPLErrorNum number, const char* text);
  std::string error_;
};

struct CloseDataset {
  void operator()(GDALDatasetH dataset) const noexcept { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, CloseDataset>;
/// An ordinary file of a format that holds its values itself, for reading; `kind` is GDAL_OF_RASTER or GDAL_OF_VECTOR.
Dataset open_dataset(const GdalSession& session, const std::filesystem::path& file, unsigned kind);

struct DestroyCrs {
  void operator()(OGRSpatialReferenceH crs) const noexcept { OSRRelease(crs); }
};
using Crs = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>, DestroyCrs>;
/// x before y, longitude before latitude; nothing where the text is not understood.
Crs crs_of(const std::string& text);
/// "EPSG:32633" where it has such a code, else WKT; empty for nothing.
std::string text_of(OGRSpatialReferenceH crs);

}  // namespace talus
