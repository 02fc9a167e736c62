#include "io/terrain/surface_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/terrain/gdal_plugin.hpp"
#include "io/terrain/map_crs.hpp"
#include "io/terrain/point_file.hpp"
#include "io/terrain/raster_file.hpp"
#include "io/terrain/stl_file.hpp"
#include "mesh/geometry/raster_surface.hpp"
#include "mesh/geometry/triangle_surface.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

constexpr Real unknown = std::numeric_limits<Real>::quiet_NaN();

std::string in_words(const MapBox& box)
{
  return fmt::format("{:.10g}..{:.10g} east, {:.10g}..{:.10g} north", box.west, box.east, box.south, box.north);
}

MapBox extent_of(const std::vector<std::array<Real, 3>>& points)
{
  constexpr Real far = std::numeric_limits<Real>::infinity();
  MapBox box{far, far, -far, -far};
  for (const auto& [x, y, z] : points)
    box = {std::min(box.west, x), std::min(box.south, y), std::max(box.east, x), std::max(box.north, y)};
  return box;
}

/// A file, and whoever wants to know of it.
class FileReader {
 public:
  FileReader(const std::string& file, const SourceLocation& where, MapPlan& plan, std::vector<SceneError>& problems,
             std::vector<std::string>& repairs)
      : file_(file), where_(where), plan_(plan), problems_(problems), repairs_(repairs), path_(plan.directory / file)
  {}
  std::optional<SurfaceRead> read();

 private:
  void complain(const std::string& what) { problems_.push_back({where_, fmt::format("{}: {}", file_, what), {}}); }
  void mend(const std::string& what) { repairs_.push_back(fmt::format("{}: {}: {}", to_string(where_), file_, what)); }
  /// The command that makes what is wanted of a file that is not.
  std::string warp_to(const std::string& crs) const
  {
    return fmt::format("gdalwarp -t_srs {} -r bilinear {} {}_on_the_map.tif", crs, file_, fs::path(file_).stem().string());
  }
  std::optional<SurfaceRead> read_raster_surface();
  std::optional<SurfaceRead> read_point_surface();
  std::optional<SurfaceRead> read_stl_surface();
  std::optional<SurfaceRead> from_raster(Raster raster);
  bool is_of_the_map(const Raster& raster);
  bool settle_units(Raster& raster);
  void drop_undeclared(Raster& raster);
  bool is_plausible(const Raster& raster);
  void fill(Raster& raster);

  const std::string& file_;
  const SourceLocation& where_;
  MapPlan& plan_;
  std::vector<SceneError>& problems_;
  std::vector<std::string>& repairs_;
  fs::path path_;
};

std::optional<SurfaceRead> FileReader::read()
{
  std::string kind = path_.extension().string();
  std::transform(kind.begin(), kind.end(), kind.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool of_points = kind == ".csv" || kind == ".xyz" || kind == ".txt";
  if (kind != ".stl")
    gdal();  // that it cannot be loaded is no fault of the scene
  try {
    return kind == ".stl" ? read_stl_surface() : of_points ? read_point_surface() : read_raster_surface();
  } catch (const SceneErrors& wrong) {  // at places in the file
    for (SceneError problem : wrong.problems()) {
      problem.message += fmt::format(" ({})", to_string(where_));
      problems_.push_back(std::move(problem));
    }
  } catch (const EnvironmentError& wrong) {
    problems_.push_back({where_, wrong.what(), {}});
  }
  return std::nullopt;
}

/// Degrees, feet and the coordinate system of another map are no places on this one.
bool FileReader::is_of_the_map(const Raster& raster)
{
  const MapBox box = extent_of(raster);
  const std::array<Real, 2> middle{(box.west + box.east) / 2, (box.south + box.north) / 2};
  if (raster.crs.empty()) {
    if (plan_.crs.empty())
      mend(
          "the file does not say which coordinate system its places are in; they are taken for metres, and maps will not say where they "
          "lie");
    else
      mend(fmt::format("the file does not say which coordinate system its places are in; they are taken to be in that of the map, {}",
                       plan_.crs));
    return true;
  }
  const auto facts = crs_facts(raster.crs);
  if (facts && (facts->geographic || std::abs(facts->metres - 1) > 1e-9)) {
    const std::string wanted = plan_.crs.empty() ? utm_zone_of(raster.crs, middle).value_or("EPSG:CODE") : plan_.crs;
    const auto wanted_facts = crs_facts(wanted);
    complain(fmt::format("places are in {} ({}), a computation needs metres; reproject it to {} first: {}",
                         facts->geographic ? "degrees" : facts->unit, facts->name, wanted_facts ? wanted_facts->name : wanted,
                         warp_to(wanted)));
    return false;
  }
  if (plan_.crs.empty())
    plan_.crs = raster.crs;
  else if (!same_plan(raster.crs, plan_.crs)) {
    const auto wanted = crs_facts(plan_.crs);
    complain(fmt::format("its coordinate system is {}, that of the map is {}; reproject it first: {}", facts ? facts->name : raster.crs,
                         wanted ? wanted->name : plan_.crs, warp_to(plan_.crs)));
    return false;
  }
  return true;
}

/// Elevations become metres.
bool FileReader::settle_units(Raster& raster)
{
  struct Length {
    std::string_view name;
    Real metres;
  };
  constexpr Real foot = 0.3048, survey_foot = 1200.0 / 3937;
  static constexpr std::array lengths{Length{"ft", foot},
                                      Length{"foot", foot},
                                      Length{"feet", foot},
                                      Length{"international foot", foot},
                                      Length{"us survey foot", survey_foot},
                                      Length{"us-ft", survey_foot},
                                      Length{"ftus", survey_foot},
                                      Length{"mm", 1e-3},
                                      Length{"cm", 1e-2},
                                      Length{"dm", 0.1},
                                      Length{"km", 1e3}};
  std::string unit = raster.unit;
  std::transform(unit.begin(), unit.end(), unit.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (unit.empty() || unit == "m")
    return true;
  const auto* const length = std::find_if(lengths.begin(), lengths.end(), [&](const Length& l) { return l.name == unit; });
  if (length == lengths.end()) {
    complain(fmt::format("elevations are in '{}', which is no length that is known: m, ft, US survey foot, km, dm, cm, mm", raster.unit));
    return false;
  }
  for (Real& value : raster.values)
    value *= length->metres;
  mend(fmt::format("elevations were in {} and are multiplied by {:.10g}", raster.unit, length->metres));
  return true;
}

/// What programs write where there is no value, without saying so in the file.
void FileReader::drop_undeclared(Raster& raster)
{
  constexpr std::array usual{-9999.0, -32768.0, -32767.0, -99999.0};
  constexpr Real absurd = 1e30;
  Index dropped = 0;
  Real example = 0;
  for (Real& value : raster.values)
    if (std::find(usual.begin(), usual.end(), value) != usual.end() || std::abs(value) > absurd) {
      example = value;
      value = unknown;
      ++dropped;
    }
  if (dropped > 0)
    mend(fmt::format("{} cell{} the value {:g}, which is taken for none, though the file does not declare it", dropped,
                     dropped == 1 ? " has" : "s have", example));
}

bool FileReader::is_plausible(const Raster& raster)
{
  Real low = std::numeric_limits<Real>::infinity(), high = -low;
  for (const Real value : raster.values)
    if (!std::isnan(value)) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  constexpr Real highest = 9000, lowest = -11500;  // m: of the Earth
  if (!(low <= high))
    complain("no cell has a value");
  else if (low == 0 && high == 0)
    complain("all elevations are zero, as if the raster had been exported without them; for a level surface write elevation: 0");
  else if (high > highest || low < lowest)
    complain(
        fmt::format("elevations from {:g} m to {:g} m are not those of any ground: other units, or a value for none that the file does not "
                    "declare (gdal_edit.py -a_nodata VALUE {})",
                    low, high, file_));
  else
    return true;
  return false;
}

void FileReader::fill(Raster& raster)
{
  Index cells = 0, count = 0, across = 0;
  MapBox first;
  for (const RasterHole& hole : fill_holes(largest_hole_filled, raster))
    if (hole.filled) {
      if (count == 0)
        first = hole.extent;
      cells += hole.cells;
      across = std::max(across, hole.across);
      ++count;
    }
  if (count > 0)
    mend(fmt::format("{} cell{} without a value in {} hole{} of up to {} cells across {} filled smoothly from around; the first at {}",
                     cells, cells == 1 ? "" : "s", count, count == 1 ? "" : "s", across, count == 1 ? "is" : "are", in_words(first)));
}

std::optional<SurfaceRead> FileReader::from_raster(Raster raster)
{
  drop_undeclared(raster);
  if (!settle_units(raster) || !is_plausible(raster))
    return std::nullopt;
  fill(raster);
  const MapBox extent = talus::extent_of(raster);
  const Real spacing = std::max(raster.dx, raster.dy);
  return SurfaceRead{surface_of(std::move(raster)), file_, extent, spacing};
}

std::optional<SurfaceRead> FileReader::read_raster_surface()
{
  std::vector<std::string> passed_over;
  Raster raster = read_raster(path_, &passed_over);
  for (const std::string& what : passed_over)
    mend(what);
  if (!is_of_the_map(raster))
    return std::nullopt;
  return from_raster(std::move(raster));
}

/// Several points at one place of the plan become one, of their mean elevation.
Index merge_places(std::vector<std::array<Real, 3>>& points)
{
  std::sort(points.begin(), points.end());
  std::size_t saved = 0;
  for (std::size_t i = 0; i < points.size();) {
    std::size_t end = i;
    Real sum = 0;
    for (; end < points.size() && points[end][0] == points[i][0] && points[end][1] == points[i][1]; ++end)
      sum += points[end][2];
    points[saved] = points[i];
    points[saved++][2] = sum / static_cast<Real>(end - i);
    i = end;
  }
  const std::size_t merged = points.size() - saved;
  points.resize(saved);
  return static_cast<Index>(merged);
}

std::string merged_in_words(Index merged)
{
  return fmt::format("{} where another lies on the plan; each such place gets the mean of their elevations",
                     merged == 1 ? "1 point lies" : fmt::format("{} points lie", merged));
}

/// Linear over Delaunay's triangles; nothing: the points lie on a line.
std::optional<SurfaceRead> over_triangles(std::vector<std::array<Real, 3>> points)
{
  const MapBox extent = extent_of(points);
  auto triangles = gdal().triangulate(points);
  if (triangles.empty())
    return std::nullopt;
  const Real spacing = std::sqrt((extent.east - extent.west) * (extent.north - extent.south) / static_cast<Real>(points.size()));
  return SurfaceRead{surface_of(TriangleSheet{std::move(points), std::move(triangles)}), "", extent, spacing};
}

std::optional<SurfaceRead> FileReader::read_point_surface()
{
  auto points = read_points(path_);
  if (auto raster = as_raster(points))
    return from_raster(std::move(*raster));
  if (const Index merged = merge_places(points); merged > 0)
    mend(merged_in_words(merged));
  auto surface = over_triangles(std::move(points));
  if (surface)
    surface->name = file_;
  else
    complain("the points lie on one line, and span no surface");
  return surface;
}

std::optional<SurfaceRead> FileReader::read_stl_surface()
{
  TriangleSheet sheet = read_stl(path_);
  const MapBox extent = extent_of(sheet.corners);
  if (!(extent.west < extent.east && extent.south < extent.north)) {
    complain("the triangles are all upright, and lie over no place of the plan");
    return std::nullopt;
  }
  const Real farthest = std::max({std::abs(extent.west), std::abs(extent.east), std::abs(extent.south), std::abs(extent.north)});
  // Coordinates of a binary file have 24 bits, and those of an ascii one often come from there.
  const auto is_single = [](const auto& corner) {
    return std::all_of(corner.begin(), corner.end(), [](Real x) { return x == static_cast<Real>(static_cast<float>(x)); });
  };
  if (const Real step = std::ldexp(1.0, std::ilogb(farthest) - 23);
      step > 0.05 && std::all_of(sheet.corners.begin(), sheet.corners.end(), is_single))
    mend(fmt::format("places {:.0f} m away from zero are exact to {:.2g} m only in an STL file", farthest, step));
  const Real spacing = std::sqrt((extent.east - extent.west) * (extent.north - extent.south) / static_cast<Real>(sheet.triangles.size()));
  return SurfaceRead{surface_of(std::move(sheet)), file_, extent, spacing};
}

/// A line through points whose x grow.
Surface line_through(std::vector<std::vector<Real>> points)
{
  return [points = std::move(points)](const std::array<Real, 2>& place) {
    if (!(place[0] >= points.front()[0] && place[0] <= points.back()[0]))
      return unknown;
    const auto next = std::upper_bound(points.begin() + 1, points.end() - 1, place[0], [](Real x, const auto& p) { return x < p[0]; });
    const auto &a = *(next - 1), &b = *next;
    const Real share = (place[0] - a[0]) / (b[0] - a[0]);
    return a[1] * (1 - share) + b[1] * share;
  };
}

std::optional<SurfaceRead> read_given_points(const SurfaceSpec& spec, const MapPlan& plan, std::vector<SceneError>& problems,
                                             std::vector<std::string>& repairs)
{
  const std::size_t numbers = plan.is_line ? 2 : 3, fewest = numbers, before = problems.size();
  const auto complain = [&](const std::string& what) { problems.push_back({spec.where, what, {}}); };
  for (std::size_t i = 0; i < spec.points.size(); ++i)
    if (spec.points[i].size() != numbers)
      complain(fmt::format("point {} has {} numbers; here a point is {}", i + 1, spec.points[i].size(),
                           plan.is_line ? "[x, elevation]" : "[east, north, elevation]"));
    else if (plan.is_line && i > 0 && spec.points[i - 1].size() == numbers && !(spec.points[i][0] > spec.points[i - 1][0]))
      complain(
          fmt::format("x grows from point to point; point {} has {:.10g} after {:.10g}", i + 1, spec.points[i][0], spec.points[i - 1][0]));
  if (spec.points.size() < fewest)
    complain(fmt::format("{} points are needed at least", fewest));
  if (problems.size() > before)
    return std::nullopt;
  if (plan.is_line) {
    const MapBox extent{spec.points.front()[0], 0, spec.points.back()[0], 0};
    return SurfaceRead{line_through(spec.points), "", extent, 0};
  }
  std::vector<std::array<Real, 3>> points;
  for (const auto& point : spec.points)
    points.push_back({point[0], point[1], point[2]});
  if (const Index merged = merge_places(points); merged > 0)
    repairs.push_back(fmt::format("{}: {}", to_string(spec.where), merged_in_words(merged)));
  auto surface = over_triangles(std::move(points));
  if (!surface)
    complain("the points lie on one line, and span no surface");
  return surface;
}

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

std::optional<SurfaceRead> read_surface(const SurfaceSpec& spec, MapPlan& plan, std::vector<SceneError>& problems,
                                        std::vector<std::string>& repairs)
{
  if (!spec.file.empty())
    return FileReader(spec.file, spec.where, plan, problems, repairs).read();
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
    constexpr Real slack = 1e-6;  // of the size: rounding
    if (beyond > slack * std::max(wanted.east - wanted.west, wanted.north - wanted.south)) {
      problems.push_back(
          {where,
           fmt::format("{} covers {}, the {} is {}: it reaches {:.6g} m beyond", name, in_words(there), of, in_words(wanted), beyond),
           {}});
      return;
    }
  }
  constexpr Real most = 400;  // places looked at along a side
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
                     name, 100 * static_cast<Real>(missing) / static_cast<Real>(inside), of, in_words(hole), largest_hole_filled, of),
         {}});
}

std::vector<MapPolygon> read_outlines(const std::string& file, const SourceLocation& where, const MapPlan& plan,
                                      std::vector<SceneError>& problems, std::vector<std::string>& repairs)
{
  gdal();  // that it cannot be loaded is no fault of the scene
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
  // GeoJSON is in degrees by its standard, but many write it in metres.
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
