#include "io/terrain/surface_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/terrain/gdal_plugin.hpp"
#include "io/terrain/map_crs.hpp"
#include "io/terrain/point_file.hpp"
#include "io/terrain/raster_file.hpp"
#include "io/terrain/stl_file.hpp"
#include "io/terrain/surface_points.hpp"
#include "mesh/geometry/raster_surface.hpp"
#include "mesh/geometry/triangle_surface.hpp"

namespace talus {

namespace {

namespace fs = std::filesystem;

/// Reads a file of a surface of the scene.
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
  /// The command that converts the file to the coordinate system of the map.
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
  std::ranges::transform(kind, kind.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool of_points = kind == ".csv" || kind == ".xyz" || kind == ".txt";
  if (kind != ".stl")
    gdal();  // checked here, because a missing plugin is not an error of the scene
  try {
    return kind == ".stl" ? read_stl_surface() : of_points ? read_point_surface() : read_raster_surface();
  } catch (const SceneErrors& wrong) {  // errors with positions in the file
    for (SceneError problem : wrong.problems()) {
      problem.message += fmt::format(" ({})", to_string(where_));
      problems_.push_back(std::move(problem));
    }
  } catch (const EnvironmentError& wrong) {
    problems_.push_back({where_, wrong.what(), {}});
  }
  return std::nullopt;
}

/// Refuses degrees, feet and the coordinate system of another map.
bool FileReader::is_of_the_map(const Raster& raster)
{
  const MapBox box = talus::extent_of(raster);
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

/// Converts elevations to metres.
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
  std::ranges::transform(unit, unit.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (unit.empty() || unit == "m")
    return true;
  const auto* const length = std::ranges::find(lengths, unit, &Length::name);
  if (length == lengths.end()) {
    complain(fmt::format("elevations are in '{}', which is no length that is known: m, ft, US survey foot, km, dm, cm, mm", raster.unit));
    return false;
  }
  for (Real& value : raster.values)
    value *= length->metres;
  mend(fmt::format("elevations were in {} and are multiplied by {:.10g}", raster.unit, length->metres));
  return true;
}

/// Removes common no-data values that the file does not declare.
void FileReader::drop_undeclared(Raster& raster)
{
  constexpr std::array usual{-9999.0, -32768.0, -32767.0, -99999.0};
  constexpr Real absurd = 1e30;
  Index dropped = 0;
  Real example = 0;
  for (Real& value : raster.values)
    if (std::ranges::find(usual, value) != usual.end() || std::abs(value) > absurd) {
      example = value;
      value = std::numeric_limits<Real>::quiet_NaN();
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
  constexpr Real highest = 9000, lowest = -11500;  // highest and lowest elevation of the Earth [m]
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
                     cells, cells == 1 ? "" : "s", count, count == 1 ? "" : "s", across, count == 1 ? "is" : "are", to_words(first)));
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
  const MapBox extent = talus::extent_of(sheet.corners);
  if (!(extent.west < extent.east && extent.south < extent.north)) {
    complain("the triangles are all upright, and lie over no place of the plan");
    return std::nullopt;
  }
  const Real farthest = std::max({std::abs(extent.west), std::abs(extent.east), std::abs(extent.south), std::abs(extent.north)});
  // Coordinates of a binary file have 24 bits, and those of an ASCII file often come from a binary one.
  const auto is_single = [](const auto& corner) {
    return std::ranges::all_of(corner, [](Real x) { return x == static_cast<Real>(static_cast<float>(x)); });
  };
  if (const Real step = std::ldexp(1.0, std::ilogb(farthest) - 23); step > 0.05 && std::ranges::all_of(sheet.corners, is_single))
    mend(fmt::format("places {:.0f} m away from zero are exact to {:.2g} m only in an STL file", farthest, step));
  const Real spacing = std::sqrt((extent.east - extent.west) * (extent.north - extent.south) / static_cast<Real>(sheet.triangles.size()));
  return SurfaceRead{surface_of(std::move(sheet)), file_, extent, spacing};
}

}  // namespace

std::optional<SurfaceRead> read_surface_file(const std::string& file, const SourceLocation& where, MapPlan& plan,
                                             std::vector<SceneError>& problems, std::vector<std::string>& repairs)
{
  return FileReader(file, where, plan, problems, repairs).read();
}

}  // namespace talus
