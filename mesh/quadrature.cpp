#include "mesh/quadrature.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

namespace {

constexpr int most_points = 100;

template <int D>
using Points = std::vector<std::array<Real, D + 1>>;

/// Adds the point and all its mirror images.
template <int D>
void add_orbit(Points<D>& points, std::array<Real, D + 1> lambda)
{
  std::sort(lambda.begin(), lambda.end());
  do
    points.push_back(lambda);
  while (std::next_permutation(lambda.begin(), lambda.end()));
}

/// Scales a symmetric set about the centroid so that the mean of lambda_a^2 is that of the cell, 2 / ((D+1)(D+2)).  By symmetry all
/// quadratic polynomials are then integrated exactly.
template <int D>
Points<D> stretched(Points<D> points)
{
  constexpr Real middle = 1.0 / (D + 1);
  Real spread = 0;
  for (const auto& lambda : points)
    for (const Real l : lambda)
      spread += (l - middle) * (l - middle);
  spread /= static_cast<Real>(points.size()) * (D + 1);
  const Real factor = std::sqrt((2.0 / ((D + 1) * (D + 2)) - middle * middle) / spread);
  for (auto& lambda : points)
    for (Real& l : lambda)
      l = middle + factor * (l - middle);
  return points;
}

/// The points (i, j, ...) / order of a lattice of `order` steps per edge.
template <int D>
Points<D> lattice(int order)
{
  Points<D> points;
  std::array<int, D + 1> at{};
  const auto fill = [&](auto&& self, int axis, int left) -> void {
    if (axis == D) {
      at[D] = left;
      std::array<Real, D + 1> lambda;
      for (int a = 0; a <= D; ++a)
        lambda[a] = static_cast<Real>(at[a]) / order;
      points.push_back(lambda);
      return;
    }
    for (at[axis] = 0; at[axis] <= left; ++at[axis])
      self(self, axis + 1, left - at[axis]);
  };
  fill(fill, 0, order);
  return points;
}

/// Six points of degree 3 (G. Strang, G. Fix, 1973): the roots of t^3 - t^2 + t/4 - 1/60, by the cosines of Vieta.
std::array<Real, 3> strang_fix()
{
  const Real third_of_angle = std::acos(0.8) / 3, pi = std::acos(-1.0);
  std::array<Real, 3> root;
  for (int k = 0; k < 3; ++k)
    root[k] = (1 + std::cos(third_of_angle - 2 * pi * k / 3)) / 3;
  return root;
}

/// The points of a rule in each of the cuts x cuts congruent triangles of a triangle.
Points<2> subdivided(const Points<2>& rule, int cuts)
{
  Points<2> points;
  for (int i = 0; i < cuts; ++i)
    for (int j = 0; i + j < cuts; ++j)
      for (const auto& lambda : rule) {
        const Real k = cuts - 1 - i - j;
        points.push_back({(i + lambda[0]) / cuts, (j + lambda[1]) / cuts, (k + lambda[2]) / cuts});
        if (k > 0)  // the inverted triangle beside it
          points.push_back({(i + 1 - lambda[0]) / cuts, (j + 1 - lambda[1]) / cuts, (k - lambda[2]) / cuts});
      }
  return points;
}

std::optional<Points<2>> triangle_points(int n)
{
  for (int cuts = 1; cuts * cuts <= n; ++cuts) {
    if (n % (cuts * cuts) != 0)
      continue;
    Points<2> rule;
    switch (n / (cuts * cuts)) {
      case 1: add_orbit<2>(rule, {1.0 / 3, 1.0 / 3, 1.0 / 3}); return cuts == 1 ? rule : stretched<2>(subdivided(rule, cuts));
      case 3: add_orbit<2>(rule, {1.0 / 6, 1.0 / 6, 2.0 / 3}); return subdivided(rule, cuts);
      case 6: add_orbit<2>(rule, strang_fix()); return subdivided(rule, cuts);
      default: break;
    }
  }
  return std::nullopt;
}

/// Adds the points with 1/4 + 3t at one corner and 1/4 - t at the others.
void add_corner_orbit(Points<3>& points, Real t) { add_orbit<3>(points, {0.25 - t, 0.25 - t, 0.25 - t, 0.25 + 3 * t}); }
/// Adds the points with 1/4 + u at two corners and 1/4 - u at the others.
void add_edge_orbit(Points<3>& points, Real u) { add_orbit<3>(points, {0.25 - u, 0.25 - u, 0.25 + u, 0.25 + u}); }

/// Points from the moments of the cell: the mean over the points of the sum over corners of (lambda - 1/4)^2 is 0.15, of (lambda - 1/4)^3
/// 0.025.  A corner orbit has 12 t^2 and 24 t^3, an edge orbit 4 u^2 and 0.
std::optional<Points<3>> tetrahedron_points(int n)
{
  Points<3> points;
  switch (n) {
    case 1: points.push_back({0.25, 0.25, 0.25, 0.25}); return points;
    case 4: return stretched<3>(lattice<3>(1));
    case 8:  // t^2 + s^2 = 0.025: every point has the distance 0.1 from its nearest facets
      add_corner_orbit(points, 0.15);
      add_corner_orbit(points, -0.05);
      return points;
    case 10: {  // from the second and third moments
      const Real t = std::cbrt(0.025 * 10 / (24 * 4));
      add_corner_orbit(points, t);
      add_edge_orbit(points, std::sqrt((0.15 * 10 - 48 * t * t) / 24));
      return points;
    }
    case 14:  // one point beside each corner, facet and edge, as far from the facets as the second moment allows
      add_corner_orbit(points, 0.155);
      add_corner_orbit(points, -0.06);
      add_edge_orbit(points, std::sqrt((0.15 * 14 - 48 * (0.155 * 0.155 + 0.06 * 0.06)) / 24));
      return points;
    case 20: return stretched<3>(lattice<3>(3));
    case 35: return stretched<3>(lattice<3>(4));
    case 56: return stretched<3>(lattice<3>(5));
    default: return std::nullopt;
  }
}

}  // namespace

template <int D>
std::optional<std::vector<std::array<Real, D + 1>>> seeding_points(int n)
{
  if (n < 1 || n > most_points)
    return std::nullopt;
  if constexpr (D == 2)
    return triangle_points(n);
  else
    return tetrahedron_points(n);
}

template <int D>
std::vector<int> seeding_counts()
{
  std::vector<int> counts;
  for (int n = 1; n <= most_points; ++n)
    if (seeding_points<D>(n))
      counts.push_back(n);
  return counts;
}

template std::optional<std::vector<std::array<Real, 3>>> seeding_points<2>(int);
template std::optional<std::vector<std::array<Real, 4>>> seeding_points<3>(int);
template std::vector<int> seeding_counts<2>();
template std::vector<int> seeding_counts<3>();

}  // namespace talus
