#include "io/terrain_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace talus {

namespace {

using Points = std::vector<std::vector<Real>>;

constexpr Real unknown = std::numeric_limits<Real>::quiet_NaN();

/// A line in 2-D through points whose x grow; level outside is not assumed.
Surface line_through(Points points)
{
  return [points = std::move(points)](const Place& place) {
    if (place[0] < points.front()[0] || place[0] > points.back()[0])
      return unknown;
    const auto next = std::upper_bound(points.begin() + 1, points.end() - 1, place[0], [](Real x, const auto& p) { return x < p[0]; });
    const auto &a = *(next - 1), &b = *next;
    const Real share = (place[0] - a[0]) / (b[0] - a[0]);
    return a[1] * (1 - share) + b[1] * share;
  };
}

/// Reads one thing after the other; what is wrong is collected.
template <int D>
class TerrainReader {
 public:
  TerrainReader(const TerrainSpec& spec, const std::filesystem::path& directory) : spec_(spec), directory_(directory) {}

  TerrainInput operator()()
  {
    if (D == 3 && spec_.section)
      complain(spec_.section->where, "a section is for scenes of dimension 2");
    input_.on_map = D == 3 || spec_.section;
    input_.frame.crs = spec_.crs;
    input_.ground = surface(spec_.ground, "ground");
    for (const LayerSpec& layer : spec_.layers) {
      input_.bottoms.push_back(surface(layer.bottom, fmt::format("bottom of layer \"{}\"", layer.name)));
      std::optional<Area>& within = input_.within.emplace_back();
      if (!layer.within.empty() || !layer.within_file.empty())
        within = area(layer.where, "within", layer.within, layer.within_file);
    }
    for (const ObstacleSpec& obstacle : spec_.obstacles)
      input_.obstacles.push_back(area(obstacle.where, "outline", obstacle.outline, obstacle.outline_file));
    domain();
    if (!problems_.empty())
      throw SceneErrors(std::move(problems_));
    return std::move(input_);
  }

 private:
  void complain(const Where& where, std::string message) { problems_.push_back({where, std::move(message), {}}); }

  Surface surface(const SurfaceSpec& spec, const std::string& what)
  {
    if (spec.elevation)
      return [elevation = *spec.elevation](const Place&) { return elevation; };
    if (spec.depth)
      return [ground = input_.ground, depth = *spec.depth](const Place& place) { return ground(place) - depth; };
    if (!spec.points.empty())
      return points(spec, what);
    complain(spec.where, fmt::format("the {}: files are not read yet", what));
    return [](const Place&) { return unknown; };
  }

  Surface points(const SurfaceSpec& spec, const std::string& what)
  {
    const auto none_known = [](const Place&) { return unknown; };
    if (D == 2 && !spec_.section) {
      for (std::size_t i = 0; i < spec.points.size(); ++i) {
        if (spec.points[i].size() != 2) {
          complain(spec.where, fmt::format("the {}: every point has two numbers, [x, y]", what));
          return none_known;
        }
        if (i > 0 && !(spec.points[i][0] > spec.points[i - 1][0])) {
          complain(spec.where, fmt::format("the {}: x grows from point to point; point {} has {:.6g} after {:.6g}", what, i + 1,
                                           spec.points[i][0], spec.points[i - 1][0]));
          return none_known;
        }
        input_.kinks.push_back(spec.points[i][0]);
      }
      if (spec.points.size() < 2) {
        complain(spec.where, fmt::format("the {} needs two points or more", what));
        return none_known;
      }
      extend({spec.points.front()[0], 0}, {spec.points.back()[0], 0});
      return line_through(spec.points);
    }
    complain(spec.where, fmt::format("the {}: points are not triangulated yet", what));
    return none_known;
  }

  /// The ground covers this much of the map; the first surface read is the ground.
  void extend(const Place& low, const Place& high)
  {
    if (!covered_)
      covered_ = std::pair(low, high);
  }

  /// A polygon of the scene or of a file, checked.
  Area area(const Where& where, std::string_view key, const Points& corners, const std::string& file)
  {
    if (!file.empty()) {
      complain(where, fmt::format("{}_file: files are not read yet", key));
      return {};
    }
    const bool plain = std::any_of(corners.begin(), corners.end(), [](const auto& corner) { return corner.size() < 2; });
    if (!input_.on_map && corners.size() == 2) {  // of a line only x counts
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
    Line ring;
    for (const auto& corner : corners)
      ring.push_back({corner[0], corner[1]});
    if (ring.front() == ring.back())
      ring.pop_back();
    if (ring.size() < 3)
      complain(where, fmt::format("{} has no area", key));
    else if (const auto place = crossing_of(ring))
      complain(where, fmt::format("{} crosses itself at ({:.10g}, {:.10g})", key, (*place)[0], (*place)[1]));
    return {{ring}};
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
      const Place from{spec_.section->from[0], spec_.section->from[1]}, to{spec_.section->to[0], spec_.section->to[1]};
      input_.to = std::hypot(to[0] - from[0], to[1] - from[1]);
      input_.frame.origin = from;
      input_.frame.along = {(to[0] - from[0]) / input_.to, (to[1] - from[1]) / input_.to};
      return;
    }
    const Real shift = spec_.origin.empty() ? 0 : spec_.origin[0];
    input_.frame.origin = {shift, 0};
    if (!spec_.domain.empty()) {
      const auto by_x = [](const auto& a, const auto& b) { return a[0] < b[0]; };
      const auto [low, high] = std::minmax_element(spec_.domain.begin(), spec_.domain.end(), by_x);
      input_.from = (*low)[0] - shift, input_.to = (*high)[0] - shift;
    } else if (covered_) {
      input_.from = covered_->first[0] - shift, input_.to = covered_->second[0] - shift;
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
    } else if (covered_) {
      input_.domain = rectangle(covered_->first, covered_->second);
      input_.is_rectangle = true;
    } else if (problems_.empty()) {
      complain(spec_.where, "domain is needed: the ground goes on without end");
    }
    constexpr Real whole = 100;  // m: an origin that people can remember
    const Place low = bounds_of(input_.domain).first;
    if (spec_.origin.size() == 2)
      input_.frame.origin = {spec_.origin[0], spec_.origin[1]};
    else if (problems_.empty())
      input_.frame.origin = {std::floor(low[0] / whole) * whole, std::floor(low[1] / whole) * whole};
  }

  const TerrainSpec& spec_;
  std::filesystem::path directory_;
  TerrainInput input_;
  std::optional<std::pair<Place, Place>> covered_;
  std::vector<Problem> problems_;
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
