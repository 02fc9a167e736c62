#include "io/terrain/surface_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/terrain/gdal_plugin.hpp"
#include "io/terrain/map_crs.hpp"
#include "io/terrain/surface_points.hpp"
#include "io/terrain/surface_reader.hpp"

namespace talus {

namespace {

bool is_inside(const std::array<Real, 2>& place, const MapRing& ring)
{
  bool inside = false;
  for (std::size_t i = 0, before = ring.size() - 1; i < ring.size(); before = i++) {
    const auto &a = ring[i], &b = ring[before];
    if ((a[1] > place[1]) != (b[1] > place[1]) && place[0] < a[0] + (place[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
      inside = !inside;
  }
  return inside;
}

MapBox extent_of(const MapRing& ring)
{
  MapBox box{ring[0][0], ring[0][1], ring[0][0], ring[0][1]};
  for (const auto& [x, y] : ring)
    box = {std::min(box.west, x), std::min(box.south, y), std::max(box.east, x), std::max(box.north, y)};
  return box;
}

}  // namespace

std::string to_words(const MapBox& box)
{
  return fmt::format("{:.10g}..{:.10g} east, {:.10g}..{:.10g} north", box.west, box.east, box.south, box.north);
}

std::optional<SurfaceRead> read_surface(const SurfaceSpec& spec, MapPlan& plan, std::vector<SceneError>& problems,
                                        std::vector<std::string>& repairs)
{
  if (!spec.file.empty())
    return read_surface_file(spec.file, spec.where, plan, problems, repairs);
  if (spec.elevation)
    return SurfaceRead{[z = *spec.elevation](const std::array<Real, 2>&) { return z; }, "", std::nullopt, 0};
  if (!spec.points.empty())
    return read_given_points(spec, plan, problems, repairs);
  if (spec.depth && plan.ground)
    return SurfaceRead{[ground = plan.ground, depth = *spec.depth](const std::array<Real, 2>& place) { return ground(place) - depth; }, "",
                       std::nullopt, 0};
  problems.push_back({spec.where, spec.depth ? "there is no ground that a depth could be counted from" : "there is no surface in it", {}});
  return std::nullopt;
}

void check_cover(const SurfaceRead& surface, const SourceLocation& where, const MapRing& outline, const std::string& of,
                 std::vector<SceneError>& problems)
{
  if (outline.size() < 3)
    return;
  const std::string name = surface.name.empty() ? "the surface" : surface.name;
  const MapBox wanted = extent_of(outline);
  if (surface.extent) {
    const MapBox& there = *surface.extent;
    const Real beyond =
        std::max({there.west - wanted.west, there.south - wanted.south, wanted.east - there.east, wanted.north - there.north});
    constexpr Real slack = 1e-6;  // relative to the size, for rounding
    if (beyond > slack * std::max(wanted.east - wanted.west, wanted.north - wanted.south)) {
      problems.push_back(
          {where,
           fmt::format("{} covers {}, the {} is {}: it reaches {:.6g} m beyond", name, to_words(there), of, to_words(wanted), beyond),
           {}});
      return;
    }
  }
  constexpr Real most = 400;  // positions checked along a side
  const Real size = std::max(wanted.east - wanted.west, wanted.north - wanted.south);
  const Real step = std::max(surface.spacing, size / most);
  const Index columns = static_cast<Index>((wanted.east - wanted.west) / step),
              rows = static_cast<Index>((wanted.north - wanted.south) / step);
  constexpr Real far = std::numeric_limits<Real>::infinity();
  MapBox hole{far, far, -far, -far};
  std::int64_t inside = 0, missing = 0;
  for (Index row = 0; row <= rows; ++row)
    for (Index column = 0; column <= columns; ++column) {
      const std::array<Real, 2> place{wanted.west + (static_cast<Real>(column) + 0.5) * step,
                                      wanted.south + (static_cast<Real>(row) + 0.5) * step};
      if (!is_inside(place, outline))
        continue;
      ++inside;
      if (!std::isnan(surface.at(place)))
        continue;
      ++missing;
      hole = {std::min(hole.west, place[0]), std::min(hole.south, place[1]), std::max(hole.east, place[0]), std::max(hole.north, place[1])};
    }
  if (missing > 0)
    problems.push_back(
        {where,
         fmt::format("{} has no value in {:.3g} % of the {}, within {}; holes of up to {} cells across are filled, larger ones are "
                     "not: fill them (gdal_fillnodata.py) or leave them out of the {}",
                     name, 100 * static_cast<Real>(missing) / static_cast<Real>(inside), of, to_words(hole), largest_hole_filled, of),
         {}});
}

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
  const bool is_metres = facts && facts->geographic &&
                         std::ranges::any_of(rings, [&](const MapRing* ring) { return std::ranges::any_of(*ring, is_no_degree); });
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
    if (ring->empty() ||
        std::ranges::any_of(*ring, [](const auto& corner) { return !std::isfinite(corner[0]) || !std::isfinite(corner[1]); })) {
      problems.push_back(
          {where, fmt::format("{}: its places, in {}, cannot be brought to {}", file, facts ? facts->name : read.crs, plan.crs), {}});
      return {};
    }
  }
  mend(fmt::format("its places are brought from {} to that of the map, {}", facts ? facts->name : read.crs, plan.crs));
  return read.polygons;
}

}  // namespace talus
