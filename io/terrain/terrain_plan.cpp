#include "io/terrain/terrain_plan.hpp"

#include <algorithm>
#include <cmath>

#include "io/mesh/gmsh_plugin.hpp"
#include "mesh/generate/generate.hpp"

namespace talus {

namespace {

/// All areas with sides of their own.
std::vector<Area> areas_of(const TerrainInput& input)
{
  std::vector<Area> areas = input.obstacles;
  for (const auto& within : input.within)
    if (within)
      areas.push_back(*within);
  return areas;
}

/// The ends of the line, outlines on it, and corners of lines where there is room for a node.
std::vector<Real> stops(const TerrainInput& input, const PlanSizes& sizes)
{
  const MapPlace from = input.frame.to_map(input.from), to = input.frame.to_map(input.to);
  std::vector<Real> x{input.from, input.to};
  for (const Area& area : areas_of(input))
    for (const Real share : crossings(area, from, to))
      x.push_back(input.from + share * (input.to - input.from));
  std::ranges::sort(x);
  x.erase(std::unique(x.begin(), x.end()), x.end());
  constexpr Real room = 0.3;  // relative to a cell
  for (const Real kink : input.kinks) {
    const Real least = room * sizes(input.frame.to_map(kink));
    const bool free = std::ranges::all_of(x, [&](Real other) { return std::abs(other - kink) >= least; });
    if (free && kink > input.from && kink < input.to)
      x.push_back(kink);
  }
  std::ranges::sort(x);
  return x;
}

/// Adds nodes from a to b without the last one; the number in each interval follows from the desired size of cells.
void divide(Real a, Real b, const TerrainInput& input, const PlanSizes& sizes, std::vector<Vec<1>>& nodes)
{
  const auto place = [&](Real share) { return a * (1 - share) + b * share; };
  const Real smallest = sizes.strips.empty() ? sizes.size : std::ranges::min_element(sizes.strips, [](const Strip& s, const Strip& t) {
                                                              return s.inside < t.inside;
                                                            })->inside;
  const auto pieces = sizes.strips.empty() ? 1 : static_cast<Index>(std::ceil(8 * (b - a) / std::min(smallest, sizes.size)));
  std::vector<Real> cells{0};  // number of cells up to the end of each interval
  for (Index i = 0; i < pieces; ++i)
    cells.push_back(cells.back() + (b - a) / pieces / sizes(input.frame.to_map(place((i + 0.5) / pieces))));
  const Index n = std::max<Index>(1, static_cast<Index>(std::lround(cells.back())));
  for (Index k = 0; k < n; ++k) {
    const Real wanted = cells.back() * k / n;
    const auto next = std::upper_bound(cells.begin() + 1, cells.end() - 1, wanted);
    const Real share = (static_cast<Real>(next - cells.begin()) - 1 + (wanted - *(next - 1)) / (*next - *(next - 1))) / pieces;
    nodes.push_back(Vec<1>(place(share)));
  }
}

Plan<2> plan_of_line(const TerrainInput& input, const PlanSizes& sizes)
{
  Plan<2> plan;
  const std::vector<Real> x = stops(input, sizes);
  for (std::size_t i = 1; i < x.size(); ++i)
    divide(x[i - 1], x[i], input, sizes, plan.nodes);
  plan.nodes.push_back(Vec<1>(x.back()));
  for (Index n = 1; n < static_cast<Index>(plan.nodes.size()); ++n)
    plan.cells.push_back({n - 1, n});
  return plan;
}

Plan<3> grid_of(const TerrainInput& input, Real size)
{
  const auto [low, high] = bounds_of(input.domain);
  std::array<Index, 2> cells;
  Vec<2> from, to;
  for (int d = 0; d < 2; ++d) {
    const auto axis = static_cast<std::size_t>(d);
    from[d] = low[axis] - input.frame.origin[axis];
    to[d] = high[axis] - input.frame.origin[axis];
    cells[axis] = std::max<Index>(1, static_cast<Index>(std::lround((to[d] - from[d]) / size)));
  }
  MeshData<2> data = box(from, to, cells, Diagonals::alternating);
  return {std::move(data.nodes), std::move(data.cells)};
}

/// The ring without corners that are close to the previous one and change it little: outlines drawn in a GIS have many corners per cell.
MapLine thinned(const MapLine& ring, const PlanSizes& sizes)
{
  constexpr Real close = 0.5, little = 0.05;  // relative to a cell
  MapLine saved;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const MapPlace &corner = ring[i], &next = ring[(i + 1) % ring.size()];
    const Real cell = sizes(corner);
    if (saved.empty() || distance({saved.back()}, corner) > close * cell || distance({saved.back(), next}, corner) > little * cell)
      saved.push_back(corner);
  }
  return saved.size() < 3 ? ring : saved;
}

Polygon local(const MapLine& ring, const MapFrame& frame)
{
  Polygon polygon;
  for (const MapPlace& place : ring)
    polygon.points.push_back({place[0] - frame.origin[0], place[1] - frame.origin[1]});
  return polygon;
}

/// The triangles of a mesh that lie in the domain, with their nodes.
Plan<3> inside(const MeshData<2>& data, const TerrainInput& input)
{
  Plan<3> plan;
  std::vector<Index> number(data.nodes.size(), none);
  for (const auto& cell : data.cells) {
    const Vec<2> centre = (data.nodes[cell[0]] + data.nodes[cell[1]] + data.nodes[cell[2]]) / 3;
    if (!input.domain.contains(on_map<3>(input.frame, centre)))
      continue;
    auto& taken = plan.cells.emplace_back(cell);
    for (Index& n : taken) {
      if (number[n] == none) {
        number[n] = static_cast<Index>(plan.nodes.size());
        plan.nodes.push_back(data.nodes[n]);
      }
      n = number[n];
    }
  }
  return plan;
}

/// The outlines of areas that have sides in the domain or near it, cut to it: an outline may be that of a country.
std::vector<Polygon> outlines_in_domain(const TerrainInput& input, const PlanSizes& sizes)
{
  constexpr Real around = 2.236;  // cells beside the domain; not a round number, as corners of outlines often are
  auto [low, high] = bounds_of(input.domain);
  for (std::size_t d = 0; d < 2; ++d)
    low[d] -= around * sizes.size, high[d] += around * sizes.size;
  std::vector<Polygon> outlines;
  for (const Area& area : areas_of(input))
    for (const MapLine& ring : area.rings)
      for (const MapLine& line : cut_to(thinned(ring, sizes), low, high))
        outlines.push_back(local(line, input.frame));
  return outlines;
}

Plan<3> plan_of_plane(const TerrainInput& input, const PlanSizes& sizes, const SourceLocation& where)
{
  const std::vector<Polygon> outlines = outlines_in_domain(input, sizes);
  if (input.is_rectangle && outlines.empty() && sizes.strips.empty())
    return grid_of(input, sizes.size);
  std::vector<Polygon> polygons;
  for (const MapLine& ring : input.domain.rings)
    polygons.push_back(local(thinned(ring, sizes), input.frame));
  polygons.insert(polygons.end(), outlines.begin(), outlines.end());
  const auto size = [&](const Vec<2>& x) { return sizes(on_map<3>(input.frame, x)); };
  return inside(gmsh().mesh_plan(polygons, size, sizes.size, where), input);
}

Real extent_of(const Plan<2>& plan, const std::array<Index, 2>& cell) { return std::abs(plan.nodes[cell[1]][0] - plan.nodes[cell[0]][0]); }
Real extent_of(const Plan<3>& plan, const std::array<Index, 3>& cell)
{
  const Vec<2> a = plan.nodes[cell[1]] - plan.nodes[cell[0]], b = plan.nodes[cell[2]] - plan.nodes[cell[0]];
  return std::abs(a[0] * b[1] - a[1] * b[0]) / 2;
}

}  // namespace

Real PlanSizes::operator()(const MapPlace& place) const noexcept
{
  constexpr Real growth = 1.0 / 3;  // change of edge length per length
  Real least = size;
  for (const auto& [along, width, inside] : strips)
    least = std::min(least, inside + growth * std::max(Real{0}, distance(along, place) - width / 2));
  return least;
}

template <int D>
Plan<D> make_plan(const TerrainInput& input, const PlanSizes& sizes, const SourceLocation& where)
{
  if constexpr (D == 2)
    return plan_of_line(input, sizes);
  else
    return plan_of_plane(input, sizes, where);
}

template <int D>
SurveyedPlan<D> survey(Plan<D> plan, const TerrainInput& input, const PlanSizes& sizes)
{
  SurveyedPlan<D> surveyed;
  surveyed.usual_size = sizes.size;
  surveyed.extent.assign(plan.nodes.size(), 0);
  for (const auto& cell : plan.cells)
    for (const Index n : cell)
      surveyed.extent[n] += extent_of(plan, cell) / D;
  for (const auto& x : plan.nodes) {
    surveyed.place.push_back(on_map<D>(input.frame, x));
    surveyed.size.push_back(sizes(surveyed.place.back()));
    surveyed.ground.push_back(input.ground(surveyed.place.back()));
  }
  surveyed.plan = std::move(plan);
  return surveyed;
}

template <int D>
Marks SurveyedPlan<D>::nodes_of(const Marks& cells) const
{
  Marks nodes(plan.nodes.size(), 0);
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (const Index n : plan.cells[c])
      nodes[n] |= cells[c];
  return nodes;
}

template <int D>
Marks cells_in(const Area& area, const SurveyedPlan<D>& plan)
{
  Marks inside;
  for (const auto& cell : plan.plan.cells) {
    MapPlace centre{};
    for (const Index n : cell)
      for (std::size_t d = 0; d < 2; ++d)
        centre[d] += plan.place[n][d] / D;
    inside.push_back(area.contains(centre) ? 1 : 0);
  }
  return inside;
}

template struct SurveyedPlan<2>;
template struct SurveyedPlan<3>;
template SurveyedPlan<2> survey<2>(Plan<2>, const TerrainInput&, const PlanSizes&);
template SurveyedPlan<3> survey<3>(Plan<3>, const TerrainInput&, const PlanSizes&);
template Marks cells_in<2>(const Area&, const SurveyedPlan<2>&);
template Marks cells_in<3>(const Area&, const SurveyedPlan<3>&);
template Plan<2> make_plan<2>(const TerrainInput&, const PlanSizes&, const SourceLocation&);
template Plan<3> make_plan<3>(const TerrainInput&, const PlanSizes&, const SourceLocation&);

}  // namespace talus
