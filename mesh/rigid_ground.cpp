#include "mesh/rigid_ground.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "mesh/geometry/single_items.hpp"

namespace talus {

namespace {

template <int D>
using FacetNodes = std::array<Index, D>;

bool is_bottom_of_layer(std::string_view name) { return name.starts_with("layer:") && name.ends_with(":bottom"); }

template <int D>
FacetNodes<D> ascending(FacetNodes<D> facet)
{
  std::sort(facet.begin(), facet.end());
  return facet;
}

/// The edges that belong to one of the facets only.
std::vector<Edge> rim_of(const std::vector<FacetNodes<3>>& facets)
{
  std::vector<Edge> sides;
  for (const FacetNodes<3>& facet : facets)
    for (std::size_t a = 0; a < 3; ++a)
      sides.push_back(ascending<2>({facet[a], facet[(a + 1) % 3]}));
  return single_items(std::move(sides));
}

void keep_each_once(std::vector<Edge>& edges)
{
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
}

/// Keeps the nodes that are used and renumbers them.
template <int D>
void keep_used_nodes(const std::vector<Vec<D>>& nodes, RigidGround& ground)
{
  std::vector<Index> number(nodes.size(), none);
  const auto take = [&](Index& n) {
    Index& mine = number[static_cast<std::size_t>(n)];
    if (mine == none) {
      mine = static_cast<Index>(ground.nodes.size() / 3);
      for (Index d = 0; d < 3; ++d)
        ground.nodes.push_back(d < D ? nodes[static_cast<std::size_t>(n)][d] : 0);
    }
    n = mine;
  };
  for (auto& triangle : ground.triangles)
    std::for_each(triangle.begin(), triangle.end(), take);
  for (std::vector<Edge>* list : {&ground.lines, &ground.layers})
    for (Edge& edge : *list)
      std::for_each(edge.begin(), edge.end(), take);
}

}  // namespace

template <int D>
std::optional<RigidGround> rigid_ground_of(const MeshData<D>& data)
{
  if (!data.facet_sets.contains("terrain"))
    return std::nullopt;
  std::set<FacetNodes<D>> rigid;
  for (const auto& [name, facets] : data.facet_sets)
    if (name == "base" || name.starts_with("obstacle:"))
      for (const FacetNodes<D>& facet : facets)
        rigid.insert(ascending<D>(facet));
  if (rigid.empty())
    return std::nullopt;
  RigidGround ground;
  for (const auto& [name, facets] : data.facet_sets)
    if (is_bottom_of_layer(name)) {
      if constexpr (D == 3) {
        const std::vector<Edge> rim = rim_of(facets);
        ground.layers.insert(ground.layers.end(), rim.begin(), rim.end());
      } else {
        for (const FacetNodes<D>& facet : facets)
          if (!rigid.contains(ascending<D>(facet)))
            ground.layers.push_back(ascending<D>(facet));
      }
    }
  keep_each_once(ground.layers);
  if constexpr (D == 3)
    ground.triangles.assign(rigid.begin(), rigid.end());
  else
    ground.lines.assign(rigid.begin(), rigid.end());
  keep_used_nodes<D>(data.nodes, ground);
  return ground;
}

template std::optional<RigidGround> rigid_ground_of<2>(const MeshData<2>&);
template std::optional<RigidGround> rigid_ground_of<3>(const MeshData<3>&);

}  // namespace talus
