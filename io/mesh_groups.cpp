#include "io/mesh_groups.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/words.hpp"
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

/// f(nodes of the facet) for every facet between a cell in the group and one that is not, or nothing.
template <int D, class F>
void for_each_outer_facet(const MeshData<D>& data, const FacetMatch<D>& match, std::span<const std::uint8_t> in_group, F&& f)
{
  for (Index c = 0; c < static_cast<Index>(data.cells.size()); ++c)
    for (int a = 0; a <= D; ++a) {
      const Index other = match.neighbours[c][a];
      if (in_group[c] != 0 && (other == none || in_group[other] == 0))
        f(nodes_of(data, c, a));
    }
}

template <int D>
std::vector<FacetNodes<D>> boundary_of(const MeshData<D>& data, const FacetMatch<D>& match)
{
  std::vector<FacetNodes<D>> facets;
  const std::vector<std::uint8_t> all(data.cells.size(), 1);
  for_each_outer_facet(data, match, all, [&](const FacetNodes<D>& nodes) { facets.push_back(nodes); });
  return facets;
}

template <int D>
FacetMatch<D> match_of(const MeshData<D>& data)
{
  return match_facets<D>(data.cells, cells_at_nodes<D>(data.cells, static_cast<Index>(data.nodes.size())));
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
Vec<D> corner(const std::vector<Real>& numbers, std::string_view key, const GroupSpec& group)
{
  if (numbers.size() != D)
    throw SceneErrors(group.where, fmt::format("within.{} of group \"{}\" has {} numbers; the scene has dimension {}", key, group.name,
                                               numbers.size(), D));
  return Eigen::Map<const Vec<D>>(numbers.data());
}

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
    return;  // no mesh at all, as its constructor will say
  const auto boundary = boundary_of(data, match);
  const auto [low, high] = bounds_of(data);
  // Meshers and text files leave round-off in coordinates; cells a million times smaller than the mesh cannot be run.
  const Real slack = 1e-6 * (high - low).norm();
  for (int axis = 0; axis < D; ++axis)
    for (const bool upper : {false, true}) {
      const Real plane = upper ? high[axis] : low[axis];
      std::vector<FacetNodes<D>> side;
      std::copy_if(boundary.begin(), boundary.end(), std::back_inserter(side), [&](const FacetNodes<D>& nodes) {
        return std::all_of(nodes.begin(), nodes.end(), [&](Index n) { return std::abs(data.nodes[n][axis] - plane) <= slack; });
      });
      if (!side.empty())
        data.facet_sets.emplace(fmt::format("{}_{}", "xyz"[axis], upper ? "max" : "min"), std::move(side));
    }
  for (const auto& [name, cells] : data.cell_sets) {
    std::vector<std::uint8_t> in_group(data.cells.size(), 0);
    for (const Index c : cells)
      in_group[c] = 1;
    std::vector<FacetNodes<D>> outline;
    for_each_outer_facet(data, match, in_group, [&](const FacetNodes<D>& nodes) { outline.push_back(nodes); });
    data.facet_sets.emplace(name + ":boundary", std::move(outline));
  }
  data.facet_sets.emplace("boundary", boundary);
}

template <int D>
void add_groups(MeshData<D>& data, std::span<const GroupSpec> groups)
{
  if (!data.facet_sets.contains("boundary"))
    return;  // no mesh at all, as its constructor will say
  for (const GroupSpec& group : groups) {
    const Vec<D> low = corner<D>(group.within.low, "low", group), high = corner<D>(group.within.high, "high", group);
    if (data.facet_sets.contains(group.name))
      throw SceneErrors(group.where, fmt::format("the mesh has a facet group \"{}\" already", group.name));
    const auto source = data.facet_sets.find(group.of);
    if (source == data.facet_sets.end())
      throw SceneErrors(group.where,
                        fmt::format("of: the mesh has no facet group \"{}\"{}", group.of, suggestion(group.of, names(data.facet_sets))));
    if (!(low.array() <= high.array()).all())
      throw SceneErrors(group.where,
                        fmt::format("group \"{}\": within.low {} is not below within.high {}", group.name, place<D>(low), place<D>(high)));
    std::vector<FacetNodes<D>> inside;
    std::copy_if(source->second.begin(), source->second.end(), std::back_inserter(inside), [&](const FacetNodes<D>& nodes) {
      return std::all_of(nodes.begin(), nodes.end(), [&](Index n) {
        const Vec<D>& x = data.nodes[n];
        return (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
      });
    });
    if (inside.empty()) {
      const auto [from, to] = bounds_of(data);
      throw SceneErrors(group.where,
                        fmt::format("group \"{}\": no facet of \"{}\" has all its corners between {} and {}; the mesh goes from {} to {}",
                                    group.name, group.of, place<D>(low), place<D>(high), place<D>(from), place<D>(to)));
    }
    data.facet_sets.emplace(group.name, std::move(inside));
  }
}

template void add_automatic_groups<2>(MeshData<2>&);
template void add_automatic_groups<3>(MeshData<3>&);
template void add_groups<2>(MeshData<2>&, std::span<const GroupSpec>);
template void add_groups<3>(MeshData<3>&, std::span<const GroupSpec>);

}  // namespace talus
