#include "io/terrain/map_crs.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/terrain/gdal_plugin.hpp"

namespace talus {

std::optional<CrsFacts> crs_facts(const std::string& crs) { return crs.empty() ? std::nullopt : gdal().crs_facts(crs); }

bool same_plan(const std::string& one, const std::string& other) { return one == other || gdal().same_plan(one, other); }

std::vector<std::array<Real, 2>> to_crs(const std::string& from, const std::string& to, const std::vector<std::array<Real, 2>>& places)
{
  return gdal().to_crs(from, to, places);
}

std::optional<std::string> utm_zone_of(const std::string& crs, const std::array<Real, 2>& place)
{
  const auto moved = to_crs(crs, "EPSG:4326", {place});
  if (moved.empty() || !(std::abs(moved[0][0]) <= 180) || !(std::abs(moved[0][1]) <= 84))
    return std::nullopt;
  const auto [longitude, latitude] = moved[0];
  const int zone = std::min(60, 1 + static_cast<int>(std::floor((longitude + 180) / 6)));
  return fmt::format("EPSG:{}", (latitude < 0 ? 32700 : 32600) + zone);
}

}  // namespace talus
