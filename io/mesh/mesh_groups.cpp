#include "io/mesh/mesh_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/word_match.hpp"
#include "mesh/check.hpp"
#include "mesh/connectivity.hpp"
#include "mesh/simplex.hpp"

namespace talus {

namespace {

template <int D>
using FacetNodes = std::array<Index, D>;

template <int D>
FacetNodes<D> nodes_of(const MeshData<D>& data, Index cell, int local)
{
  FacetNodes<D> nodes;
  for (int i = 0; i < D; ++i)
    nodes[i] = data.cells[cell][facet_locals<D>[local][i]];
  return nodes;
}

/// Calls f(nodes of the facet, its cell in the group, its local number) for every facet between a cell in the group and one outside, or no
/// cell.
template <int D, class F>
void for_each_outer_facet(const MeshData<D>& data, const FacetMatch<D>& match, std::span<const std::uint8_t> in_group, F&& f)
{
  for (Index c = 0; c < static_cast<Index>(data.cells.size()); ++c)
    for (int a = 0; a <= D; ++a) {
      const Index other = match.neighbours[c][a];
      if (in_group[c] != 0 && (other == none || in_group[other] == 0))
        f(nodes_of(data, c, a), c, a);
    }
}

template <int D>
std::vector<FacetNodes<D>> boundary_of(const MeshData<D>& data, const FacetMatch<D>& match)
{
  std::vector<FacetNodes<D>> facets;
  const std::vector<std::uint8_t> all(data.cells.size(), 1);
  for_each_outer_facet(data, match, all, [&](const FacetNodes<D>& nodes, Index, int) { facets.push_back(nodes); });
  return facets;
}

template <int D>
FacetMatch<D> match_of(const MeshData<D>& data)
{
  return match_facets<D>(data.cells, cells_at_nodes<D>(data.cells, static_cast<Index>(data.nodes.size())));
}

/// The facets between two cells.
template <int D>
std::vector<FacetNodes<D>> inside_of(const MeshData<D>& data)
{
  const FacetMatch<D> match = match_of(data);
  std::vector<FacetNodes<D>> facets;
  for (Index c = 0; c < static_cast<Index>(data.cells.size()); ++c)
    for (int a = 0; a <= D; ++a)
      if (match.neighbours[c][a] > c)
        facets.push_back(nodes_of(data, c, a));
  return facets;
}

template <int D>
struct Bounds {
  Vec<D> low, high;
};
template <int D>
Bounds<D> bounds_of(const MeshData<D>& data)
{
  Bounds<D> bounds{data.nodes[0], data.nodes[0]};
  for (const Vec<D>& x : data.nodes) {
    bounds.low = bounds.low.cwiseMin(x);
    bounds.high = bounds.high.cwiseMax(x);
  }
  return bounds;
}

template <int D>
Vec<D> vector_of(const std::vector<Real>& numbers, std::string_view key, const GroupSpec& group)
{
  if (numbers.size() != D)
    throw SceneErrors(group.where,
                      fmt::format("{} of group \"{}\" has {} numbers; the scene has dimension {}", key, group.name, numbers.size(), D));
  return Eigen::Map<const Vec<D>>(numbers.data());
}

template <int D>
std::vector<std::uint8_t> marks_of(const MeshData<D>& data, const std::string& cell_group)
{
  const auto cells = data.cell_sets.find(cell_group);
  if (cells == data.cell_sets.end())
    return std::vector<std::uint8_t>(data.cells.size(), 1);
  std::vector<std::uint8_t> marks(data.cells.size(), 0);
  for (const Index c : cells->second)
    marks[c] = 1;
  return marks;
}

/// Finds which facets of a set face a direction.  Facets of an outline have one outward normal; for other facets inside the mesh both sides
/// count.
template <int D>
class FacingFacets {
 public:
  FacingFacets(const MeshData<D>& data, const GroupSpec& group)
      : data_(data),
        direction_(vector_of<D>(group.facing, "facing", group).normalized()),
        least_cosine_(std::cos(group.angle * std::numbers::pi / 180))
  {
    constexpr std::string_view ending = ":boundary";
    const std::string region = group.of.ends_with(ending) ? group.of.substr(0, group.of.size() - ending.size()) : "";
    for_each_outer_facet(data, match_of(data), marks_of(data, region), [&](FacetNodes<D> nodes, Index c, int a) {
      const Vec<D> normal = normal_of(nodes), inwards = data.nodes[data.cells[c][a]] - data.nodes[nodes[0]];
      std::ranges::sort(nodes);
      outwards_[nodes] = normal.dot(inwards) > 0 ? Vec<D>(-normal) : normal;
    });
  }
  bool operator()(FacetNodes<D> nodes) const
  {
    const Vec<D> normal = normal_of(nodes);
    std::ranges::sort(nodes);
    const auto outwards = outwards_.find(nodes);
    const Real cosine = outwards == outwards_.end() ? std::abs(normal.dot(direction_)) : outwards->second.dot(direction_);
    return cosine >= least_cosine_;
  }

 private:
  Vec<D> normal_of(const FacetNodes<D>& nodes) const
  {
    std::array<Vec<D>, D> corners;
    for (std::size_t i = 0; i < D; ++i)
      corners[i] = data_.nodes[nodes[i]];
    return area_vector(corners).normalized();
  }

  const MeshData<D>& data_;
  Vec<D> direction_;
  Real least_cosine_;
  std::map<FacetNodes<D>, Vec<D>> outwards_;
};

/// The distance in the x-y plane of a position from a side.
Real distance_to(const Vec<2>& x, const std::vector<Real>& a, const std::vector<Real>& b)
{
  return (closest_point({Vec<2>(a[0], a[1]), Vec<2>(b[0], b[1])}, x) - x).norm();
}

/// Selects the facets of a region's outline that lie on the sides of its shapes.
template <int D>
class SidesOfRegion {
 public:
  SidesOfRegion(MeshData<D>& data, const RegionSpec& region) : data_(data), region_(region)
  {
    const auto [low, high] = bounds_of(data);
    slack_ = 1e-6 * (high - low).norm();  // round-off, as in add_automatic_groups()
  }

  void operator()(const Polygon& polygon)
  {
    const std::size_t n = polygon.points.size();
    std::map<std::string, std::vector<std::size_t>> sides_of_name;
    for (std::size_t i = 0; i < polygon.sides.size(); ++i)
      sides_of_name[polygon.sides[i]].push_back(i);
    for (const auto& [name, sides] : sides_of_name)
      add(name, [&, &of_name = sides](const std::vector<Vec<D>>& corners) {
        return std::ranges::any_of(of_name, [&](std::size_t i) { return lie_on(corners, polygon.points, i, (i + 1) % n); });
      });
    for (std::size_t h = 0; h < polygon.holes.size(); ++h)
      add(fmt::format("hole_{}", h + 1), [&](const std::vector<Vec<D>>& corners) {
        const auto& hole = polygon.holes[h];
        for (std::size_t i = 0; i < hole.size(); ++i)
          if (lie_on(corners, hole, i, (i + 1) % hole.size()))
            return true;
        return false;
      });
  }
  void operator()(const Ring& ring)
  {
    const Vec<D> centre = Eigen::Map<const Vec<D>>(ring.centre.data());
    add("inner", [&](const std::vector<Vec<D>>& corners) {
      return std::ranges::all_of(corners, [&](const Vec<D>& x) { return std::abs((x - centre).norm() - ring.inner_radius) <= slack_; });
    });
  }
  template <class Other>
  void operator()(const Other&)
  {}

 private:
  bool lie_on(const std::vector<Vec<D>>& corners, const std::vector<std::vector<Real>>& points, std::size_t from, std::size_t to) const
  {
    return std::ranges::all_of(
        corners, [&](const Vec<D>& x) { return distance_to(Vec<2>(x.template head<2>()), points[from], points[to]) <= slack_; });
  }
  template <class Lies>
  void add(const std::string& side, Lies&& lies)
  {
    const std::string name = fmt::format("{}:{}", region_.name, side);
    std::vector<FacetNodes<D>> found;
    std::vector<Vec<D>> corners(D);
    for (const FacetNodes<D>& nodes : data_.facet_sets.at(region_.name + ":boundary")) {
      for (std::size_t i = 0; i < D; ++i)
        corners[i] = data_.nodes[nodes[i]];
      if (lies(corners))
        found.push_back(nodes);
    }
    if (found.empty())
      throw SceneErrors(region_.where,
                        fmt::format("no facet of region \"{}\" lies on its side \"{}\": other regions have taken it", region_.name, side));
    if (!data_.facet_sets.emplace(name, std::move(found)).second)
      throw SceneErrors(region_.where, fmt::format("the mesh has a facet group \"{}\" already", name));
  }

  MeshData<D>& data_;
  const RegionSpec& region_;
  Real slack_ = 0;
};

template <class Sets>
std::vector<std::string> names(const Sets& sets)
{
  std::vector<std::string> all;
  for (const auto& [name, facets] : sets)
    all.push_back(name);
  return all;
}

}  // namespace

template <int D>
void add_automatic_groups(MeshData<D>& data)
{
  const FacetMatch<D> match = match_of(data);
  if (match.crowded)
    return;  // not a valid mesh, as its constructor will report
  const auto boundary = boundary_of(data, match);
  const auto [low, high] = bounds_of(data);
  // Meshers and text files leave round-off in coordinates; a mesh with cells a million times smaller than itself cannot be run.
  const Real slack = 1e-6 * (high - low).norm();
  for (int axis = 0; axis < D; ++axis)
    for (const bool upper : {false, true}) {
      const Real plane = upper ? high[axis] : low[axis];
      std::vector<FacetNodes<D>> side;
      std::ranges::copy_if(boundary, std::back_inserter(side), [&](const FacetNodes<D>& nodes) {
        return std::ranges::all_of(nodes, [&](Index n) { return std::abs(data.nodes[n][axis] - plane) <= slack; });
      });
      if (!side.empty())
        data.facet_sets.emplace(fmt::format("{}_{}", "xyz"[axis], upper ? "max" : "min"), std::move(side));
    }
  for (const auto& [name, cells] : data.cell_sets) {
    std::vector<std::uint8_t> in_group(data.cells.size(), 0);
    for (const Index c : cells)
      in_group[c] = 1;
    std::vector<FacetNodes<D>> outline;
    for_each_outer_facet(data, match, in_group, [&](const FacetNodes<D>& nodes, Index, int) { outline.push_back(nodes); });
    data.facet_sets.emplace(name + ":boundary", std::move(outline));
  }
  data.facet_sets.emplace("boundary", boundary);
}

template <int D>
void add_side_groups(MeshData<D>& data, std::span<const RegionSpec> regions)
{
  for (const RegionSpec& region : regions)
    if (data.facet_sets.contains(region.name + ":boundary")) {
      SidesOfRegion<D> add(data, region);
      for_each_part(region.shape, [&](const SimpleShape& part) { std::visit(add, part); });
    }
}

template <int D>
void add_groups(MeshData<D>& data, std::span<const GroupSpec> groups)
{
  if (!data.facet_sets.contains("boundary"))
    return;  // not a valid mesh, as its constructor will report
  for (const GroupSpec& group : groups) {
    const auto [all_low, all_high] = bounds_of(data);
    const Vec<D> low = group.within ? vector_of<D>(group.within->low, "within.low", group) : all_low;
    const Vec<D> high = group.within ? vector_of<D>(group.within->high, "within.high", group) : all_high;
    if (data.facet_sets.contains(group.name))
      throw SceneErrors(group.where, fmt::format("the mesh has a facet group \"{}\" already", group.name));
    const auto known = data.facet_sets.find(group.of);
    const bool all_inside = known == data.facet_sets.end() && group.of == "inside";
    const std::vector<FacetNodes<D>> source = all_inside                       ? inside_of(data)
                                              : known != data.facet_sets.end() ? known->second
                                                                               : std::vector<FacetNodes<D>>{};
    if (known == data.facet_sets.end() && !all_inside)
      throw SceneErrors(group.where,
                        fmt::format("of: the mesh has no facet group \"{}\"{}", group.of, suggestion(group.of, names(data.facet_sets))));
    if (!(low.array() <= high.array()).all())
      throw SceneErrors(group.where,
                        fmt::format("group \"{}\": within.low {} is not below within.high {}", group.name, place<D>(low), place<D>(high)));
    std::vector<FacetNodes<D>> inside;
    std::ranges::copy_if(source, std::back_inserter(inside), [&](const FacetNodes<D>& nodes) {
      return std::ranges::all_of(nodes, [&](Index n) {
        const Vec<D>& x = data.nodes[n];
        return (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
      });
    });
    if (inside.empty())
      throw SceneErrors(group.where,
                        fmt::format("group \"{}\": no facet of \"{}\" has all its corners between {} and {}; the mesh goes from {} to {}",
                                    group.name, group.of, place<D>(low), place<D>(high), place<D>(all_low), place<D>(all_high)));
    if (!group.facing.empty()) {
      const FacingFacets<D> faces(data, group);
      std::erase_if(inside, [&](const FacetNodes<D>& nodes) { return !faces(nodes); });
      if (inside.empty())
        throw SceneErrors(group.where, fmt::format("group \"{}\": no facet of \"{}\"{} faces {} up to {:.6g} deg", group.name, group.of,
                                                   group.within ? " in the box" : "", place<D>(vector_of<D>(group.facing, "facing", group)),
                                                   group.angle));
    }
    data.facet_sets.emplace(group.name, std::move(inside));
  }
}

template void add_automatic_groups<2>(MeshData<2>&);
template void add_automatic_groups<3>(MeshData<3>&);
template void add_side_groups<2>(MeshData<2>&, std::span<const RegionSpec>);
template void add_side_groups<3>(MeshData<3>&, std::span<const RegionSpec>);
template void add_groups<2>(MeshData<2>&, std::span<const GroupSpec>);
template void add_groups<3>(MeshData<3>&, std::span<const GroupSpec>);

}  // namespace talus
