#pragma once
// Coordinate systems of maps: what there is to know of one, and from one to another.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct CrsFacts {
  std::string code;         ///< "EPSG:32633" where it has one, else WKT: as in MapFrame
  std::string name;         ///< "WGS 84 / UTM zone 33N"
  bool geographic = false;  ///< coordinates are degrees of longitude and latitude
  Real metres = 1;          ///< length of one unit of its coordinates over the plan [m]; of no meaning where geographic
  std::string unit;         ///< name of that unit
};

/// Nothing: not understood.
std::optional<CrsFacts> crs_facts(const std::string& crs);
/// Whether two coordinate systems say the same of places on the plan, whatever they say of heights.  False where one is not understood.
bool same_plan(const std::string& one, const std::string& other);
/// Places (x, y), longitude before latitude, from one coordinate system to another; NaN where that is not possible.  Empty: a coordinate
/// system is not understood.
std::vector<std::array<Real, 2>> to_crs(const std::string& from, const std::string& to, const std::vector<std::array<Real, 2>>& places);
/// "EPSG:32633": the UTM zone, on WGS 84, that a place of a coordinate system is in; nothing where it is in none.
std::optional<std::string> utm_zone_of(const std::string& crs, const std::array<Real, 2>& place);

}  // namespace talus
