#include "io/gdal_session.hpp"

#include <cpl_conv.h>
#include <fmt/format.h>

#include <mutex>

#include "core/error.hpp"
#include "io/whole_file.hpp"

namespace talus {

namespace {

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
  std::call_once(known, [] { GDALAllRegister(); });
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
  Dataset opened(GDALOpenEx(file.c_str(), kind | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr, nullptr, nullptr));
  if (opened == nullptr)
    session.fail(file, kind == GDAL_OF_RASTER ? "is no raster that can be read" : "has no outlines that can be read");
  return opened;
}

Crs crs_of(const std::string& text)
{
  Crs crs(OSRNewSpatialReference(nullptr));
  if (text.empty() || OSRSetFromUserInput(crs.get(), text.c_str()) != OGRERR_NONE)
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
