#include "io/terrain/outline_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/terrain/gdal_plugin.hpp"
#include "io/terrain/map_crs.hpp"

namespace talus {

std::vector<MapPolygon> read_outlines(const std::string& file, const SourceLocation& where, const MapPlan& plan,
                                      std::vector<SceneError>& problems, std::vector<std::string>& repairs)
{
  gdal();  // checked here, because a missing plugin is not an error of the scene
  PolygonFile read;
  try {
    read = read_polygons(plan.directory / file);
  } catch (const EnvironmentError& wrong) {
    problems.push_back({where, wrong.what(), {}});
    return {};
  }
  const auto mend = [&](const std::string& what) { repairs.push_back(fmt::format("{}: {}: {}", to_string(where), file, what)); };
  std::vector<MapRing*> rings;
  for (MapPolygon& polygon : read.polygons) {
    rings.push_back(&polygon.outer);
    for (MapRing& hole : polygon.holes)
      rings.push_back(&hole);
  }
  const auto is_no_degree = [](const std::array<Real, 2>& corner) { return std::abs(corner[0]) > 360 || std::abs(corner[1]) > 90; };
  const auto facts = crs_facts(read.crs);
  // GeoJSON is in degrees by its standard, but many files are in metres.
  const bool is_metres = facts && facts->geographic && std::any_of(rings.begin(), rings.end(), [&](const MapRing* ring) {
                           return std::any_of(ring->begin(), ring->end(), is_no_degree);
                         });
  if (read.crs.empty() || is_metres) {
    mend(fmt::format("{}; its places are taken to be in {}",
                     is_metres ? fmt::format("the file says {}, but its numbers are no degrees", facts->name)
                               : "the file does not say which coordinate system its places are in",
                     plan.crs.empty() ? "metres of the map" : fmt::format("that of the map, {}", plan.crs)));
    return read.polygons;
  }
  if (plan.crs.empty()) {
    if (!facts || facts->geographic || std::abs(facts->metres - 1) > 1e-9) {
      problems.push_back({where,
                          fmt::format("{}: its places are in {}, and no coordinate system of the map is known: say crs", file,
                                      facts ? facts->name : read.crs),
                          {}});
      return {};
    }
    return read.polygons;
  }
  if (same_plan(read.crs, plan.crs))
    return read.polygons;
  for (MapRing* const ring : rings) {
    *ring = to_crs(read.crs, plan.crs, *ring);
    if (ring->empty() || std::any_of(ring->begin(), ring->end(),
                                     [](const auto& corner) { return !std::isfinite(corner[0]) || !std::isfinite(corner[1]); })) {
      problems.push_back(
          {where, fmt::format("{}: its places, in {}, cannot be brought to {}", file, facts ? facts->name : read.crs, plan.crs), {}});
      return {};
    }
  }
  mend(fmt::format("its places are brought from {} to that of the map, {}", facts ? facts->name : read.crs, plan.crs));
  return read.polygons;
}

}  // namespace talus
