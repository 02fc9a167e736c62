#include <cpl_conv.h>
#include <ogr_srs_api.h>

#include <limits>

#include "io/terrain/gdal_part.hpp"
#include "io/terrain/gdal_session.hpp"

namespace talus::gdal_part {

std::optional<CrsFacts> crs_facts(const std::string& text)
{
  const GdalSession session;
  const Crs crs = crs_of(text);
  if (crs == nullptr)
    return std::nullopt;
  CrsFacts facts;
  facts.code = text_of(crs.get());
  facts.geographic = OSRIsGeographic(crs.get()) != 0;
  const char* const name = OSRGetName(crs.get());
  facts.name = name != nullptr ? name : "unnamed";
  char* unit = nullptr;  // owned by the coordinate system
  facts.metres = facts.geographic ? 1 : OSRGetLinearUnits(crs.get(), &unit);
  facts.unit = facts.geographic ? "degree" : unit != nullptr ? unit : "metre";
  return facts;
}

bool same_plan(const std::string& one, const std::string& other)
{
  const GdalSession session;
  const Crs a = crs_of(one), b = crs_of(other);
  if (a == nullptr || b == nullptr)
    return false;
  for (const Crs* crs : {&a, &b})
    if (OSRIsCompound(crs->get()) != 0)
      OSRStripVertical(crs->get());
  constexpr std::array<const char*, 3> told{"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", "CRITERION=EQUIVALENT_EXCEPT_AXIS_ORDER_GEOGCRS",
                                            nullptr};
  return OSRIsSameEx(a.get(), b.get(), told.data()) != 0;
}

std::vector<std::array<Real, 2>> to_crs(const std::string& from, const std::string& to, const std::vector<std::array<Real, 2>>& places)
{
  const GdalSession session;
  const Crs a = crs_of(from), b = crs_of(to);
  if (a == nullptr || b == nullptr)
    return {};
  OGRCoordinateTransformationH change = OCTNewCoordinateTransformation(a.get(), b.get());
  if (change == nullptr)
    return {};
  std::vector<std::array<Real, 2>> moved = places;
  for (auto& [x, y] : moved)
    if (int done = 0; OCTTransformEx(change, 1, &x, &y, nullptr, &done) == 0 || done == 0)
      x = y = std::numeric_limits<Real>::quiet_NaN();
  OCTDestroyCoordinateTransformation(change);
  return moved;
}

std::string esri_text(const std::string& text)
{
  const GdalSession session;
  const Crs crs = crs_of(text);
  if (crs == nullptr)
    return {};
  constexpr std::array<const char*, 2> told{"FORMAT=WKT1_ESRI", nullptr};
  char* written = nullptr;
  const bool done = OSRExportToWktEx(crs.get(), &written, told.data()) == OGRERR_NONE;
  const std::string wkt = done && written != nullptr ? written : "";
  CPLFree(written);
  return wkt;
}

}  // namespace talus::gdal_part
