#include "mesh/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

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
  for (int a = 0; a < D; ++a)
    for (int b = a + 1; b <= D; ++b) {
      const Vec<D> m = area_vector(facet<D>(s, a)), n = area_vector(facet<D>(s, b));
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
MeshQuality<D> quality(const Mesh<D>& mesh)
{
  constexpr Real infinity = std::numeric_limits<Real>::infinity();
  MeshQuality<D> q{};
  q.nodes = mesh.n_nodes();
  q.cells = mesh.n_cells();
  q.boundary_facets = static_cast<Index>(mesh.boundary_facets().size());
  q.smallest_volume = q.smallest_mean_ratio = q.smallest_angle = q.shortest_edge = infinity;
  q.gradation = 1;
  std::vector<Real> heights(mesh.cells().size());
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    const Simplex<D> s = mesh.corners(c);
    const Real volume = mesh.volume(c), ratio = mean_ratio<D>(s);
    heights[c] = mesh.altitude(c);
    q.volume += volume;
    q.smallest_volume = std::min(q.smallest_volume, volume);
    q.largest_volume = std::max(q.largest_volume, volume);
    q.average_mean_ratio += ratio / q.cells;
    q.smallest_angle = std::min(q.smallest_angle, smallest_angle<D>(s));
    if (ratio < q.smallest_mean_ratio) {
      q.smallest_mean_ratio = ratio;
      q.worst_cell = c;
      q.worst_place = centroid<D>(s);
    }
    for_each_edge<D>(s, [&](Real squared) {
      q.shortest_edge = std::min(q.shortest_edge, std::sqrt(squared));
      q.longest_edge = std::max(q.longest_edge, std::sqrt(squared));
    });
    for (const Index other : mesh.neighbours(c))
      if (other != none)  // computed from both sides, so one of the two ratios is above one
        q.gradation = std::max(q.gradation, std::pow(volume / mesh.volume(other), 1.0 / D));
  }
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    q.largest_ring = std::max(q.largest_ring, static_cast<Index>(mesh.ring_of_node()[n].size()));
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  q.median_altitude = *middle;
  q.smallest_altitude = *std::min_element(heights.begin(), middle + 1);
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
  return text;
}

template Real mean_ratio<2>(const Simplex<2>&) noexcept;
template Real mean_ratio<3>(const Simplex<3>&) noexcept;
template Real smallest_angle<2>(const Simplex<2>&) noexcept;
template Real smallest_angle<3>(const Simplex<3>&) noexcept;
template MeshQuality<2> quality<2>(const Mesh<2>&);
template MeshQuality<3> quality<3>(const Mesh<3>&);
template std::string to_string<2>(const MeshQuality<2>&);
template std::string to_string<3>(const MeshQuality<3>&);

}  // namespace talus
