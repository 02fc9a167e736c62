#pragma once
// Coordinate systems of maps: their properties, and transformations between them.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct CrsFacts {
  std::string code;         ///< "EPSG:32633" if there is such a code, otherwise WKT, as in MapFrame
  std::string name;         ///< for example "WGS 84 / UTM zone 33N"
  bool geographic = false;  ///< coordinates are degrees of longitude and latitude
  Real metres = 1;          ///< length of one unit of plan coordinates [m]; without meaning if geographic
  std::string unit;         ///< name of that unit
};

/// The properties; nothing if the text is not understood.
std::optional<CrsFacts> crs_facts(const std::string& crs);
/// Whether two coordinate systems are equal in the plan, whatever their heights.  False if one is not understood.
bool same_plan(const std::string& one, const std::string& other);
/// Transforms positions (x, y), longitude before latitude, from one coordinate system to another; NaN where that is impossible.  Empty if a
/// coordinate system is not understood.
std::vector<std::array<Real, 2>> to_crs(const std::string& from, const std::string& to, const std::vector<std::array<Real, 2>>& places);
/// The UTM zone on WGS 84 that contains a position, such as "EPSG:32633"; nothing if there is none.
std::optional<std::string> utm_zone_of(const std::string& crs, const std::array<Real, 2>& place);

}  // namespace talus
