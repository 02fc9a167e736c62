#include "app/observers/runout_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace talus {

ReachRule reach_rule(const std::optional<RunoutSpec>& spec, Real cell)
{
  const RunoutSpec rule = spec.value_or(RunoutSpec{});
  return {rule.moved.value_or(cell), rule.mass_share};
}

namespace {

constexpr Real rounding = 1e-6;  // round-off of single precision, with a margin for a few operations

/// The index of the first item in the given order beyond which at most 1 - mass_share of the mass lies.
std::size_t first_within(std::span<const std::pair<Real, std::size_t>> order, std::span<const Real> mass, Real mass_share)
{
  // The mass that may lie beyond, with a margin for round-off of masses.
  const Real beyond = (1 - mass_share) * std::accumulate(mass.begin(), mass.end(), Real{0}) * (1 + rounding);
  std::size_t i = 0;
  for (Real sum = mass[order[0].second]; sum <= beyond && i + 1 < order.size(); sum += mass[order[i].second])
    ++i;
  return order[i].second;
}

/// Among positions whose value is largest within round-off, the first one whose second value is largest in the same sense.
template <class First, class Second>
std::size_t largest_of_equals(std::size_t n, Real equal, First&& first, Second&& second)
{
  Real most = -std::numeric_limits<Real>::infinity(), most_second = most;
  for (std::size_t p = 0; p < n; ++p)
    most = std::max(most, first(p));
  for (std::size_t p = 0; p < n; ++p)
    if (first(p) >= most - equal)
      most_second = std::max(most_second, second(p));
  std::size_t found = 0;
  for (std::size_t p = n; p-- > 0;)
    if (first(p) >= most - equal && second(p) >= most_second - equal)
      found = p;
  return found;
}

/// The differences of positions that may be due to round-off [m].
Real rounding_of(std::span<const Vec3> then, std::span<const Vec3> now)
{
  Vec3 low = then.front(), high = low;
  for (const auto& places : {then, now})
    for (const Vec3& x : places)
      low = low.cwiseMin(x), high = high.cwiseMax(x);
  return rounding * (high - low).norm();
}

}  // namespace

Real not_exceeded_by(std::span<const Real> values, std::span<const Real> mass, Real mass_share)
{
  if (values.empty())
    return 0;
  std::vector<std::pair<Real, std::size_t>> order;  // largest first
  for (std::size_t p = 0; p < values.size(); ++p)
    order.emplace_back(-values[p], p);
  std::sort(order.begin(), order.end());
  return values[first_within(order, mass, mass_share)];
}

std::optional<Reach> reach_of(std::span<const Vec3> then, std::span<const Vec3> now, std::span<const Real> mass, const Vec3& up,
                              Real mass_share)
{
  if (then.empty())
    return std::nullopt;
  const Real equal = rounding_of(then, now);
  Real whole = 0;
  Vec3 centre = Vec3::Zero();
  for (std::size_t p = 0; p < now.size(); ++p)
    whole += mass[p], centre += mass[p] * (now[p] - now[0]);
  centre = now[0] + (whole > 0 ? Vec3(centre / whole) : Vec3::Zero());
  const auto from = [&](const Vec3& origin, const Vec3& x) { return on_the_level(x - origin, up).norm(); };
  const Vec3 crown = then[largest_of_equals(
      then.size(), equal, [&](std::size_t p) { return then[p].dot(up); }, [&](std::size_t p) { return from(centre, then[p]); })];

  std::vector<std::pair<Real, std::size_t>> way;  // furthest first
  for (std::size_t p = 0; p < now.size(); ++p)
    way.emplace_back(-from(crown, now[p]), p);
  std::sort(way.begin(), way.end());
  const Real length = from(crown, now[first_within(way, mass, mass_share)]);
  const Vec3 front = now[largest_of_equals(
      now.size(), equal, [&](std::size_t p) { return -std::abs(from(crown, now[p]) - length); },
      [&](std::size_t p) { return -now[p].dot(up); })];
  return Reach{crown, front, (crown - front).dot(up), from(crown, front)};
}

}  // namespace talus
