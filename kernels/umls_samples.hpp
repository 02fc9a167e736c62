#pragma once
// Sample weights of moving least squares and their gradients at one particle, four nodes per pack.
#include "kernels/pack.hpp"
#include "kernels/umls.hpp"

namespace talus {

/// The position of a particle in its cell.
template <int D>
struct Place {
  Real x[D];         ///< relative to the origin of the cell [m]
  Pack coordinates;  ///< barycentric coordinates, one vertex per lane
};
template <int D>
[[gnu::always_inline]] inline Place<D> place_of(const typename Umls<D>::Cell& cell, const Pack (&x)[D], int lane) noexcept
{
  Place<D> at;
  at.coordinates = D == 2 ? Pack{1, 1, 1, 0} / 3 : broadcast(0.25);
  for (int d = 0; d < D; ++d) {
    at.x[d] = x[d][lane] - cell.origin[d];
    at.coordinates += at.x[d] * load(cell.slope[d]);
  }
  return at;
}

template <int D>
[[gnu::always_inline]] inline Real radius_at(const typename Umls<D>::Cell& cell, const Place<D>& at) noexcept
{
  Real radius = cell.radius;
  for (int d = 0; d < D; ++d)
    radius += cell.radius_slope[d] * at.x[d];
  return radius;
}

/// 2 R^2 times the quadratic B-spline d(q), q = distance / R: 3/4 - q^2 up to 1/2, (3/2 - q)^2 / 2 up to 3/2, then 0; written with
/// truncated powers, without branch or division.  The common factor of all samples cancels in the estimate.
struct Profile {
  Pack outer, inner;
  [[gnu::always_inline]] Profile(const Pack& distance, Real radius) noexcept
      : outer(1.5 * radius - smaller(distance, 1.5 * radius)), inner(0.5 * radius - smaller(distance, 0.5 * radius))
  {}
  [[gnu::always_inline]] Pack value() const noexcept { return outer * outer - 3 * inner * inner; }
  [[gnu::always_inline]] Pack per_distance() const noexcept { return 6 * inner - 2 * outer; }  ///< d value / d distance
  [[gnu::always_inline]] Pack per_radius() const noexcept { return 3 * (outer - inner); }      ///< d value / d R
};

/// The sample weights 2 R^2 W.
template <int D>
[[gnu::always_inline]] inline void sample(const typename Umls<D>::Cell& cell, const Place<D>& at, Real* weight) noexcept
{
  const Real radius = radius_at<D>(cell, at);
  for (int i = 0; i < cell.padded_size; i += pack_size) {
    Pack r2{}, eta = at.coordinates[0] * load(cell.adjacent[0] + i);
    for (int d = 0; d < D; ++d) {
      const Pack r = load(cell.x[d] + i) - at.x[d];
      r2 = d == 0 ? r * r : r2 + r * r;
    }
    for (int a = 1; a <= D; ++a)
      eta += at.coordinates[a] * load(cell.adjacent[a] + i);
    store(weight + i, eta * Profile(square_root(r2), radius).value());
  }
}

/// The gradient of 2 R^2 W for the pack of nodes at i, by eta, distance and radius.
template <int D>
void sample_slope(const typename Umls<D>::Cell& cell, const Place<D>& at, Real radius, int i, Pack (&slope)[D]) noexcept
{
  Pack r[D], r2{}, eta{}, eta_slope[D]{};
  for (int d = 0; d < D; ++d) {
    r[d] = load(cell.x[d] + i) - at.x[d];
    r2 += r[d] * r[d];
  }
  for (int a = 0; a <= D; ++a) {
    const Pack adjacent = load(cell.adjacent[a] + i);
    eta += at.coordinates[a] * adjacent;
    for (int d = 0; d < D; ++d)
      eta_slope[d] += cell.slope[d][a] * adjacent;
  }
  const Pack distance = square_root(r2);
  const Profile profile(distance, radius);
  // At the position of a node r and the slope of the profile are zero, so any divisor will do.
  const Pack per_r = profile.per_distance() / (distance > 0 ? distance : broadcast(1));
  for (int d = 0; d < D; ++d)
    slope[d] = eta_slope[d] * profile.value() + eta * (profile.per_radius() * cell.radius_slope[d] - per_r * r[d]);
}

}  // namespace talus
