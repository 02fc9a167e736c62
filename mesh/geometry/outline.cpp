#include "mesh/geometry/outline.hpp"

#include <algorithm>

#include "mesh/geometry/single_items.hpp"

namespace talus {

namespace {

constexpr Real cosine_of_sharp_edge = 0.8660254037844387;  // 30 degrees between the normals of two boundary facets

using Triangle = std::array<Index, 3>;

Edge edge(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

void sort_once(std::vector<Edge>& edges)
{
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
}

Vec3 point(std::span<const Real> nodes, Index n) { return Eigen::Map<const Vec3>(nodes.data() + 3 * static_cast<std::size_t>(n)); }

/// The unit normal of a facet.  Its sign is arbitrary, because the corners of facets are sorted.
Vec3 normal(std::span<const Real> nodes, const Triangle& facet)
{
  const Vec3 a = point(nodes, facet[0]), u = point(nodes, facet[1]) - a, v = point(nodes, facet[2]) - a;
  return Vec3(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]).normalized();
}

/// The unit vector in the plane of a triangle that is perpendicular to an edge and points to the third corner.
Vec3 away(std::span<const Real> nodes, const Edge& of, const Triangle& facet)
{
  const auto third = std::find_if(facet.begin(), facet.end(), [&](Index n) { return n != of[0] && n != of[1]; });
  const Vec3 along = (point(nodes, of[1]) - point(nodes, of[0])).normalized(), to = point(nodes, *third) - point(nodes, of[0]);
  return (to - to.dot(along) * along).normalized();
}

/// Whether the angle between two facets at a common edge is sharp.
bool is_bent(std::span<const Real> nodes, const Edge& at, const Triangle& a, const Triangle& b)
{
  const bool folded = away(nodes, at, a).dot(away(nodes, at, b)) > 0;
  return folded || std::abs(normal(nodes, a).dot(normal(nodes, b))) < cosine_of_sharp_edge;
}

MeshEdges edges_of_triangles(std::span<const Index> corners)
{
  MeshEdges edges;
  for (std::size_t c = 0; c + 2 < corners.size(); c += 3)
    for (std::size_t a = 0; a < 3; ++a)
      edges.all.push_back(edge(corners[c + a], corners[c + (a + 1) % 3]));
  edges.outline = single_items(edges.all);  // edges of one cell only
  sort_once(edges.all);
  return edges;
}

MeshEdges edges_of_tetrahedra(std::span<const Real> nodes, std::span<const Index> corners)
{
  std::vector<Triangle> facets;
  for (std::size_t c = 0; c + 3 < corners.size(); c += 4)
    for (std::size_t a = 0; a < 4; ++a) {
      Triangle facet{corners[c + (a + 1) % 4], corners[c + (a + 2) % 4], corners[c + (a + 3) % 4]};
      std::sort(facet.begin(), facet.end());
      facets.push_back(facet);
    }
  facets = single_items(std::move(facets));
  std::vector<std::pair<Edge, std::size_t>> sides;  // each side with the index of its facet
  for (std::size_t f = 0; f < facets.size(); ++f)
    for (const Edge& side : {Edge{facets[f][0], facets[f][1]}, Edge{facets[f][1], facets[f][2]}, Edge{facets[f][0], facets[f][2]}})
      sides.emplace_back(side, f);
  std::sort(sides.begin(), sides.end());
  MeshEdges edges;
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    for (end = i + 1; end < sides.size() && sides[end].first == sides[i].first;)
      ++end;
    edges.all.push_back(sides[i].first);
    if (end != i + 2 || is_bent(nodes, sides[i].first, facets[sides[i].second], facets[sides[i + 1].second]))
      edges.outline.push_back(sides[i].first);
  }
  return edges;
}

}  // namespace

Real mean_node_size(int dimension, std::span<const Real> nodes, std::span<const Index> corners)
{
  const auto width = static_cast<std::size_t>(dimension) + 1;
  std::vector<Edge> edges;
  for (std::size_t c = 0; c + width <= corners.size(); c += width)
    for (std::size_t a = 0; a < width; ++a)
      for (std::size_t b = a + 1; b < width; ++b)
        edges.push_back(edge(corners[c + a], corners[c + b]));
  sort_once(edges);
  std::vector<Real> length(nodes.size() / 3, 0), count(length);
  for (const Edge& one : edges)
    for (const Index n : one) {
      length[static_cast<std::size_t>(n)] += (point(nodes, one[0]) - point(nodes, one[1])).norm();
      count[static_cast<std::size_t>(n)] += 1;
    }
  Real sum = 0, used = 0;
  for (std::size_t n = 0; n < length.size(); ++n)
    if (count[n] > 0)
      sum += length[n] / count[n], used += 1;
  return used > 0 ? sum / used : 0;
}

MeshEdges edges_of(int dimension, std::span<const Real> nodes, std::span<const Index> corners)
{
  return dimension == 2 ? edges_of_triangles(corners) : edges_of_tetrahedra(nodes, corners);
}

}  // namespace talus
