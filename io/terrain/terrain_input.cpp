#include "io/terrain/terrain_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/terrain/surface_file.hpp"

namespace talus {

namespace {

using Points = std::vector<std::vector<Real>>;

/// Reads the parts of the block in sequence and collects errors.
template <int D>
class TerrainReader {
 public:
  TerrainReader(const TerrainSpec& spec, const std::filesystem::path& directory) : spec_(spec), directory_(directory) {}

  TerrainInput operator()()
  {
    input_.is_line = D == 2;
    input_.on_map = D == 3 || spec_.section;
    map_ = {directory_, spec_.crs, !input_.on_map, {}};
    input_.ground = surface(spec_.ground);
    map_.ground = input_.ground;
    for (const LayerSpec& layer : spec_.layers) {
      input_.bottoms.push_back(surface(layer.bottom));
      std::optional<Area>& within = input_.within.emplace_back();
      if (!layer.within.empty() || !layer.within_file.empty())
        within = area(layer.where, "within", layer.within, layer.within_file);
    }
    for (const ObstacleSpec& obstacle : spec_.obstacles)
      input_.obstacles.push_back(area(obstacle.where, "outline", obstacle.outline, obstacle.outline_file));
    domain();
    input_.frame.crs = map_.crs;
    if (!problems_.empty())
      throw SceneErrors(std::move(problems_));
    return std::move(input_);
  }

 private:
  void complain(const SourceLocation& where, std::string message) { problems_.push_back({where, std::move(message), {}}); }

  /// The surface; it has no value anywhere if it cannot be read.
  Surface surface(const SurfaceSpec& spec)
  {
    if (!input_.on_map)
      for (const auto& point : spec.points)
        if (!point.empty())
          input_.kinks.push_back(point[0]);
    if (auto read = read_surface(spec, map_, problems_, input_.notes)) {
      if (!ground_)
        ground_ = *read;
      return read->at;
    }
    return [](const MapPlace&) { return std::numeric_limits<Real>::quiet_NaN(); };
  }

  /// A polygon of the scene or of a file, checked.
  Area area(const SourceLocation& where, std::string_view key, const Points& corners, const std::string& file)
  {
    if (!file.empty())
      return checked(where, fmt::format("{}_file", key), area_of(read_outlines(file, where, map_, problems_, input_.notes)));
    const bool plain = std::any_of(corners.begin(), corners.end(), [](const auto& corner) { return corner.size() < 2; });
    if (!input_.on_map && corners.size() == 2) {  // only x of a line is used
      const Real side = 1;
      return rectangle({corners[0][0], -side}, {corners[1][0], side});
    }
    if (plain) {
      complain(where, fmt::format("every corner of {} has two numbers, [east, north]", key));
      return {};
    }
    if (corners.size() == 2) {
      if (corners[0][0] == corners[1][0] || corners[0][1] == corners[1][1])
        complain(where, fmt::format("the two corners of {} span no rectangle", key));
      return rectangle({corners[0][0], corners[0][1]}, {corners[1][0], corners[1][1]});
    }
    MapLine ring;
    for (const auto& corner : corners)
      ring.push_back({corner[0], corner[1]});
    return checked(where, key, {{ring}});
  }

  Area checked(const SourceLocation& where, std::string_view key, Area area)
  {
    for (MapLine& ring : area.rings) {
      if (!ring.empty() && ring.front() == ring.back())
        ring.pop_back();
      if (ring.size() < 3)
        complain(where, fmt::format("{} has no area", key));
      else if (const auto place = crossing_of(ring))
        complain(where, fmt::format("{} crosses itself at ({:.10g}, {:.10g})", key, (*place)[0], (*place)[1]));
    }
    return area;
  }

  static Area area_of(const std::vector<MapPolygon>& polygons)
  {
    Area area;
    for (const MapPolygon& polygon : polygons) {
      area.rings.push_back(polygon.outer);
      area.rings.insert(area.rings.end(), polygon.holes.begin(), polygon.holes.end());
    }
    return area;
  }

  void domain()
  {
    if constexpr (D == 2)
      line();
    else
      plane();
  }

  void line()
  {
    if (spec_.section) {
      if (spec_.section->from.size() != 2 || spec_.section->to.size() != 2)
        return;
      const MapPlace from{spec_.section->from[0], spec_.section->from[1]}, to{spec_.section->to[0], spec_.section->to[1]};
      input_.to = std::hypot(to[0] - from[0], to[1] - from[1]);
      input_.frame.origin = from;
      input_.frame.along = {(to[0] - from[0]) / input_.to, (to[1] - from[1]) / input_.to};
      return;
    }
    if (!spec_.domain_file.empty())
      complain(spec_.where, "domain_file is for the map: in 2-D without a section domain has two numbers, [[x from], [x to]]");
    const Real shift = spec_.origin.empty() ? 0 : spec_.origin[0];
    input_.frame.origin = {shift, 0};
    if (!spec_.domain.empty()) {
      const auto by_x = [](const auto& a, const auto& b) { return a[0] < b[0]; };
      const auto [low, high] = std::minmax_element(spec_.domain.begin(), spec_.domain.end(), by_x);
      input_.from = (*low)[0] - shift, input_.to = (*high)[0] - shift;
    } else if (ground_ && ground_->extent) {
      input_.from = ground_->extent->west - shift, input_.to = ground_->extent->east - shift;
    } else if (problems_.empty()) {
      complain(spec_.where, "domain is needed: the ground goes on without end");
    }
    if (problems_.empty() && !(input_.from < input_.to))
      complain(spec_.where, fmt::format("the domain goes from x = {:.6g} m to {:.6g} m", input_.from, input_.to));
    for (Real& x : input_.kinks)
      x -= shift;
  }

  void plane()
  {
    if (!spec_.domain.empty() || !spec_.domain_file.empty()) {
      input_.domain = area(spec_.where, "domain", spec_.domain, spec_.domain_file);
      input_.is_rectangle = spec_.domain.size() == 2;
    } else if (ground_ && ground_->extent) {
      const MapBox& all = *ground_->extent;
      input_.domain = rectangle({all.west + ground_->spacing, all.south + ground_->spacing},
                                {all.east - ground_->spacing, all.north - ground_->spacing});
      input_.is_rectangle = true;
    } else if (problems_.empty()) {
      complain(spec_.where, "domain is needed: the ground goes on without end");
    }
    if (ground_ && !input_.domain.rings.empty())
      check_cover(*ground_, spec_.ground.where, input_.domain.rings.front(), "domain", problems_);
    constexpr Real whole = 100;  // the origin is rounded to this [m]
    const MapPlace low = bounds_of(input_.domain).first;
    if (spec_.origin.size() == 2)
      input_.frame.origin = {spec_.origin[0], spec_.origin[1]};
    else if (problems_.empty())
      input_.frame.origin = {std::floor(low[0] / whole) * whole, std::floor(low[1] / whole) * whole};
  }

  const TerrainSpec& spec_;
  std::filesystem::path directory_;
  TerrainInput input_;
  MapPlan map_;
  std::optional<SurfaceRead> ground_;
  std::vector<SceneError> problems_;
};

}  // namespace

template <int D>
TerrainInput read_terrain(const TerrainSpec& spec, const std::filesystem::path& directory)
{
  return TerrainReader<D>(spec, directory)();
}

template TerrainInput read_terrain<2>(const TerrainSpec&, const std::filesystem::path&);
template TerrainInput read_terrain<3>(const TerrainSpec&, const std::filesystem::path&);

}  // namespace talus
