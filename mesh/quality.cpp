#include "mesh/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/parallel/threads.hpp"
#include "mesh/check.hpp"

namespace talus {

template <int D>
Real mean_ratio(const Simplex<D>& s) noexcept
{
  Real squares = 0;
  for_each_edge<D>(s, [&](Real squared) { squares += squared; });
  const Real volume = std::abs(signed_volume<D>(s));
  if constexpr (D == 2)
    return 4 * std::sqrt(3.0) * volume / squares;
  else
    return 12 * std::pow(3 * volume, 2.0 / 3) / squares;
}

template <int D>
Real smallest_angle(const Simplex<D>& s) noexcept
{
  // The angle between the outward normals of two facets is pi minus the angle of the simplex.  The tangent form (sine from the cross
  // product) is accurate for angles near zero, where the cosine is not.
  Real smallest = std::numeric_limits<Real>::infinity();
  std::array<Vec<D>, D + 1> normal;
  for (int a = 0; a <= D; ++a)
    normal[a] = area_vector(facet<D>(s, a));
  for (int a = 0; a < D; ++a)
    for (int b = a + 1; b <= D; ++b) {
      const Vec<D>&m = normal[a], &n = normal[b];
      Real cross = 0;
      if constexpr (D == 2)
        cross = std::abs(m[0] * n[1] - m[1] * n[0]);
      else
        cross = m.cross(n).norm();
      smallest = std::min(smallest, std::atan2(cross, -m.dot(n)));
    }
  return smallest;
}

template <int D>
Vec<D> star_offset(std::span<const Vec<D>> nodes, std::span<const std::array<Index, D + 1>> cells, std::span<const Index> star,
                   Index n) noexcept
{
  const Vec<D>& x = nodes[static_cast<std::size_t>(n)];
  Vec<D> sum = Vec<D>::Zero();  // relative to x: no round-off of large coordinates
  Real volume = 0;
  for (const Index c : star) {
    Simplex<D> s;
    for (std::size_t a = 0; a <= D; ++a)
      s[a] = nodes[static_cast<std::size_t>(cells[static_cast<std::size_t>(c)][a])] - x;
    const Real of_cell = std::abs(signed_volume<D>(s));
    sum += of_cell * centroid<D>(s);
    volume += of_cell;
  }
  return sum / volume;
}

template <int D>
StarOffsets<D> star_offsets(const Mesh<D>& mesh)
{
  constexpr Real share_of_most = 0.95;
  std::vector<Real> of_node(mesh.nodes().size(), -1);  // -1: boundary
  parallel_for(mesh.n_nodes(), [&](Index n) {
    if (!mesh.on_boundary(n))
      of_node[static_cast<std::size_t>(n)] =
          star_offset<D>(mesh.nodes(), mesh.cells(), mesh.cells_of_node()[n], n).norm() / mesh.node_size(n);
  });
  StarOffsets<D> offsets;
  const auto largest = std::ranges::max_element(of_node);  // the first of equal ones
  offsets.largest = *largest;
  offsets.largest_place = mesh.node(static_cast<Index>(largest - of_node.begin()));
  std::erase_if(of_node, [](Real offset) { return offset < 0; });
  if (of_node.empty())
    return {};
  offsets.nodes = static_cast<Index>(of_node.size());
  std::ranges::sort(of_node);
  offsets.median = of_node[of_node.size() / 2];
  offsets.most = of_node[static_cast<std::size_t>(std::ceil(share_of_most * static_cast<Real>(of_node.size()))) - 1];
  return offsets;
}

template <int D>
std::string to_string(const StarOffsets<D>& offsets)
{
  if (offsets.nodes == 0)
    return "";
  return fmt::format(
      "interior nodes: {:.3f} h from the centre of their cells in the median, up to {:.3f} h for 95 %, {:.3f} h at {}; h: mean edge\n",
      offsets.median, offsets.most, offsets.largest, place<D>(offsets.largest_place));
}

template <int D>
std::string advice(const StarOffsets<D>& offsets)
{
  if (offsets.median <= large_star_offset)
    return "";
  return fmt::format(
      "more than {} h in the median: the kernel projected is less accurate on such meshes; mesh.smoothing: 5 makes them more even\n",
      large_star_offset);
}

namespace {

struct CellQuality {
  Real mean_ratio, smallest_angle, shortest_edge, longest_edge;
  Real largest_ratio;  ///< of its volume to that of a neighbour
};

template <int D>
CellQuality quality_of(const Mesh<D>& mesh, Index c)
{
  const Simplex<D> s = mesh.corners(c);
  Real shortest = std::numeric_limits<Real>::infinity(), longest = 0;
  for_each_edge<D>(s, [&](Real squared) {
    shortest = std::min(shortest, squared);
    longest = std::max(longest, squared);
  });
  Real largest_ratio = 0;
  for (const Index other : mesh.neighbours(c))
    if (other != none)  // computed from both sides, so one of the two ratios is above one
      largest_ratio = std::max(largest_ratio, mesh.volume(c) / mesh.volume(other));
  return {mean_ratio<D>(s), smallest_angle<D>(s), std::sqrt(shortest), std::sqrt(longest), largest_ratio};
}

}  // namespace

template <int D>
MeshQuality<D> quality(const Mesh<D>& mesh)
{
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  MeshQuality<D> q{};
  q.nodes = mesh.n_nodes();
  q.cells = mesh.n_cells();
  q.boundary_facets = static_cast<Index>(mesh.boundary_facets().size());
  q.smallest_volume = q.smallest_mean_ratio = q.smallest_angle = q.shortest_edge = infinity;
  std::vector<Real> heights(mesh.cells().size());
  std::vector<CellQuality> of_cell(mesh.cells().size());
  parallel_for(mesh.n_cells(), [&](Index c) { of_cell[c] = quality_of(mesh, c); });
  Real largest_ratio = 1;
  for (Index c = 0; c < mesh.n_cells(); ++c) {  // in the order of the cells, whatever the number of threads
    const CellQuality& cell = of_cell[c];
    const Real volume = mesh.volume(c);
    heights[c] = mesh.altitude(c);
    q.volume += volume;
    q.smallest_volume = std::min(q.smallest_volume, volume);
    q.largest_volume = std::max(q.largest_volume, volume);
    q.average_mean_ratio += cell.mean_ratio / q.cells;
    q.smallest_angle = std::min(q.smallest_angle, cell.smallest_angle);
    if (cell.mean_ratio < q.smallest_mean_ratio) {
      q.smallest_mean_ratio = cell.mean_ratio;
      q.worst_cell = c;
    }
    q.shortest_edge = std::min(q.shortest_edge, cell.shortest_edge);
    q.longest_edge = std::max(q.longest_edge, cell.longest_edge);
    largest_ratio = std::max(largest_ratio, cell.largest_ratio);
  }
  q.worst_place = centroid<D>(mesh.corners(q.worst_cell));
  q.gradation = std::pow(largest_ratio, 1.0 / D);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    q.largest_ring = std::max(q.largest_ring, static_cast<Index>(mesh.ring_of_node()[n].size()));
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  q.median_altitude = *middle;
  q.smallest_altitude = *std::min_element(heights.begin(), middle + 1);
  q.offsets = star_offsets(mesh);
  return q;
}

template <int D>
std::string to_string(const MeshQuality<D>& q)
{
  const Real degrees = 180 / std::acos(-1.0);
  std::string text =
      fmt::format("{} nodes, {} {}, {} boundary facets\n", q.nodes, q.cells, D == 2 ? "triangles" : "tetrahedra", q.boundary_facets);
  text += fmt::format("{} {:.6g} m^{}, of one cell {:.4g} to {:.4g}\n", D == 2 ? "area" : "volume", q.volume, D, q.smallest_volume,
                      q.largest_volume);
  text += fmt::format("edges {:.4g} to {:.4g} m; altitude {:.4g} m at least, {:.4g} m in the median\n", q.shortest_edge, q.longest_edge,
                      q.smallest_altitude, q.median_altitude);
  text += fmt::format("smallest {} {:.3g} degrees; mean ratio {:.3g} at least, {:.3g} on average (1: regular)\n",
                      D == 2 ? "angle" : "dihedral angle", q.smallest_angle * degrees, q.smallest_mean_ratio, q.average_mean_ratio);
  text += fmt::format("sizes of neighbours differ by a factor of {:.3g} at most; up to {} nodes in a ring\n", q.gradation, q.largest_ring);
  text += fmt::format("worst cell at {}\n", place<D>(q.worst_place));
  return text + to_string(q.offsets);
}

template Real mean_ratio<2>(const Simplex<2>&) noexcept;
template Real mean_ratio<3>(const Simplex<3>&) noexcept;
template Real smallest_angle<2>(const Simplex<2>&) noexcept;
template Real smallest_angle<3>(const Simplex<3>&) noexcept;
template Vec<2> star_offset<2>(std::span<const Vec<2>>, std::span<const std::array<Index, 3>>, std::span<const Index>, Index) noexcept;
template Vec<3> star_offset<3>(std::span<const Vec<3>>, std::span<const std::array<Index, 4>>, std::span<const Index>, Index) noexcept;
template StarOffsets<2> star_offsets<2>(const Mesh<2>&);
template StarOffsets<3> star_offsets<3>(const Mesh<3>&);
template std::string to_string<2>(const StarOffsets<2>&);
template std::string to_string<3>(const StarOffsets<3>&);
template std::string advice<2>(const StarOffsets<2>&);
template std::string advice<3>(const StarOffsets<3>&);
template MeshQuality<2> quality<2>(const Mesh<2>&);
template MeshQuality<3> quality<3>(const Mesh<3>&);
template std::string to_string<2>(const MeshQuality<2>&);
template std::string to_string<3>(const MeshQuality<3>&);

}  // namespace talus
