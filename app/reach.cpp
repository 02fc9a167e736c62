#include "app/reach.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace talus {

ReachRule reach_rule(const std::optional<RunoutSpec>& spec, Real cell)
{
  const RunoutSpec rule = spec.value_or(RunoutSpec{});
  return {rule.moved.value_or(cell), rule.mass_share};
}

namespace {

/// Number of the first item, in that order, beyond which no more than 1 - mass_share of the mass lies.
std::size_t first_within(std::span<const std::pair<Real, std::size_t>> order, std::span<const Real> mass, Real mass_share)
{
  // What may lie beyond, with room for the rounding of sums.
  const Real beyond = (1 - mass_share) * std::accumulate(mass.begin(), mass.end(), Real{0}) * (1 + 1e-12);
  std::size_t i = 0;
  for (Real sum = mass[order[0].second]; sum <= beyond && i + 1 < order.size(); sum += mass[order[i].second])
    ++i;
  return order[i].second;
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
  const Vec3 crown = *std::max_element(then.begin(), then.end(), [&](const Vec3& a, const Vec3& b) { return a.dot(up) < b.dot(up); });
  std::vector<std::pair<Real, std::size_t>> way;  // furthest first
  for (std::size_t p = 0; p < now.size(); ++p)
    way.emplace_back(-on_the_level(now[p] - crown, up).norm(), p);
  std::sort(way.begin(), way.end());
  const std::size_t p = first_within(way, mass, mass_share);
  const Vec3& front = now[p];
  return Reach{crown, front, (crown - front).dot(up), on_the_level(front - crown, up).norm()};
}

}  // namespace talus
