#include "app/reach.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace talus {

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
  // What may lie beyond, with room for the rounding of sums.
  const Real beyond = (1 - mass_share) * std::accumulate(mass.begin(), mass.end(), Real{0}) * (1 + 1e-12);
  std::size_t i = 0;
  for (Real sum = mass[way[0].second]; sum <= beyond && i + 1 < way.size(); sum += mass[way[i].second])
    ++i;
  const Vec3& front = now[way[i].second];
  return Reach{crown, front, (crown - front).dot(up), -way[i].first};
}

}  // namespace talus
