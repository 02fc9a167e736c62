#pragma once
// Geometry of one triangle or tetrahedron: volume, barycentric map and its gradients, altitudes, nearest point of a facet.
//
// A simplex is the array of its D+1 corners [m].  It is positive if its signed volume is: counter-clockwise in 2-D; in 3-D
// corners 0, 1, 2 are counter-clockwise seen from corner 3.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/types.hpp"

namespace talus {

template <int D>
using Simplex = std::array<Vec<D>, D + 1>;

/// Local nodes of the facet opposite each local node, in the order that makes the normal of a positive simplex point outwards.
template <int D>
inline constexpr std::array<std::array<int, D>, D + 1> facet_locals = [] {
  if constexpr (D == 2)
    return std::array<std::array<int, 2>, 3>{{{1, 2}, {2, 0}, {0, 1}}};
  else
    return std::array<std::array<int, 3>, 4>{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
}();

/// The normal of an edge (to its right) or of a triangle (right-hand rule), times its length or area [m^(D-1)].
inline Vec<2> area_vector(const std::array<Vec<2>, 2>& facet) noexcept
{
  const Vec<2> edge = facet[1] - facet[0];
  return {edge[1], -edge[0]};
}
inline Vec<3> area_vector(const std::array<Vec<3>, 3>& facet) noexcept
{
  return 0.5 * Vec<3>(facet[1] - facet[0]).cross(Vec<3>(facet[2] - facet[0]));
}

/// The signed volume times D! [m^D].
template <int D>
Real determinant(const Simplex<D>& s) noexcept
{
  const Vec<D> a = s[1] - s[0], b = s[2] - s[0];
  if constexpr (D == 2)
    return a[0] * b[1] - a[1] * b[0];
  else
    return a.cross(b).dot(s[3] - s[0]);
}

/// The area or volume [m^D], negative for a simplex of negative orientation.
template <int D>
Real signed_volume(const Simplex<D>& s) noexcept
{
  return determinant<D>(s) / (D == 2 ? 2 : 6);
}

template <int D>
Vec<D> centroid(const Simplex<D>& s) noexcept
{
  Vec<D> sum = s[0];
  for (int a = 1; a <= D; ++a)
    sum += s[a];
  return sum / (D + 1);
}

/// Calls f(squared length [m^2]) for each edge.
template <int D, class F>
void for_each_edge(const Simplex<D>& s, F&& f)
{
  for (int a = 0; a < D; ++a)
    for (int b = a + 1; b <= D; ++b)
      f((s[b] - s[a]).squaredNorm());
}

template <int D>
Real longest_edge(const Simplex<D>& s) noexcept
{
  Real longest = 0;
  for_each_edge<D>(s, [&](Real squared) { longest = std::max(longest, squared); });
  return std::sqrt(longest);
}

/// The gradients [1/m] of the barycentric coordinates: normal to the facets, pointing inwards, with the length 1 / altitude.
template <int D>
std::array<Vec<D>, D + 1> gradients(const Simplex<D>& s) noexcept
{
  const Vec<D> a = s[1] - s[0], b = s[2] - s[0];
  std::array<Vec<D>, D + 1> g;
  if constexpr (D == 2) {
    const Real inverse = 1 / (a[0] * b[1] - a[1] * b[0]);
    g[1] = inverse * Vec<2>(b[1], -b[0]);
    g[2] = inverse * Vec<2>(-a[1], a[0]);
    g[0] = -g[1] - g[2];
  } else {
    const Vec<3> c = s[3] - s[0];
    g[1] = b.cross(c);
    const Real inverse = 1 / g[1].dot(a);
    g[1] *= inverse;
    g[2] = inverse * c.cross(a);
    g[3] = inverse * a.cross(b);
    g[0] = -g[1] - g[2] - g[3];
  }
  return g;
}

/// The barycentric coordinates of x from their gradients and the first corner: they sum to one and are >= 0 inside.
template <int D>
std::array<Real, D + 1> barycentric(const std::array<Vec<D>, D + 1>& g, const Vec<D>& first_corner, const Vec<D>& x) noexcept
{
  const Vec<D> r = x - first_corner;
  std::array<Real, D + 1> lambda;
  lambda[0] = 1;
  for (int a = 1; a <= D; ++a) {
    lambda[a] = g[a].dot(r);
    lambda[0] -= lambda[a];
  }
  return lambda;
}

/// The barycentric coordinates of x in a simplex without precomputed gradients.
template <int D>
std::array<Real, D + 1> barycentric(const Simplex<D>& s, const Vec<D>& x) noexcept
{
  return barycentric<D>(gradients<D>(s), s[0], x);
}

/// The point with these barycentric coordinates.
template <int D>
Vec<D> point(const Simplex<D>& s, const std::array<Real, D + 1>& lambda) noexcept
{
  Vec<D> x = lambda[0] * s[0];
  for (int a = 1; a <= D; ++a)
    x += lambda[a] * s[a];
  return x;
}

template <int D>
std::array<Vec<D>, D> facet(const Simplex<D>& s, int local) noexcept
{
  std::array<Vec<D>, D> corners;
  for (int i = 0; i < D; ++i)
    corners[i] = s[facet_locals<D>[local][i]];
  return corners;
}

/// The height [m] of each corner above the opposite facet.
template <int D>
std::array<Real, D + 1> altitudes(const Simplex<D>& s) noexcept
{
  const Real volume = std::abs(signed_volume<D>(s));
  std::array<Real, D + 1> height;
  for (int a = 0; a <= D; ++a)
    height[a] = D * volume / area_vector(facet<D>(s, a)).norm();
  return height;
}

/// The point of an edge nearest to x.
inline Vec<2> closest_point(const std::array<Vec<2>, 2>& edge, const Vec<2>& x) noexcept
{
  const Vec<2> along = edge[1] - edge[0];
  return edge[0] + std::clamp(along.dot(x - edge[0]) / along.squaredNorm(), 0.0, 1.0) * along;
}

/// The point of a triangle nearest to x, by the Voronoi regions of corners and edges (Ericson, Real-Time Collision Detection, 5.1.5).
inline Vec<3> closest_point(const std::array<Vec<3>, 3>& triangle, const Vec<3>& x) noexcept
{
  const auto& [a, b, c] = triangle;
  const Vec<3> ab = b - a, ac = c - a;
  const Real d1 = ab.dot(x - a), d2 = ac.dot(x - a);
  if (d1 <= 0 && d2 <= 0)
    return a;
  const Real d3 = ab.dot(x - b), d4 = ac.dot(x - b);
  if (d3 >= 0 && d4 <= d3)
    return b;
  const Real vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0)
    return a + d1 / (d1 - d3) * ab;
  const Real d5 = ab.dot(x - c), d6 = ac.dot(x - c);
  if (d6 >= 0 && d5 <= d6)
    return c;
  const Real vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0)
    return a + d2 / (d2 - d6) * ac;
  const Real va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + (vb * ab + vc * ac) / (va + vb + vc);
}

}  // namespace talus
