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

template <int D>
std::vector<MovedParticle<D>> gather_moved(const RunView<D>& view, const RunoutSpec& spec, Real least)
{
  const auto among = [](const std::vector<std::string>& names, const Body& body) {
    return std::find(names.begin(), names.end(), body.name) != names.end();
  };
  const Particles<D>& p = view.state.particles;
  std::vector<MovedParticle<D>> here;
  for (const Body& body : view.state.bodies) {
    if (!spec.bodies.empty() && !among(spec.bodies, body))
      continue;
    const std::int64_t eroded = among(spec.eroded, body) ? 1 : 0;
    for (auto row = static_cast<std::size_t>(body.begin); row < static_cast<std::size_t>(body.end); ++row) {
      const Vec3 then = in_space<D>(p.x0[row]), now = in_space<D>(p.x[row]);
      if ((now - then).norm() >= least)
        here.push_back({p.id[row],
                        eroded,
                        {then[0], then[1], then[2]},
                        {now[0], now[1], now[2]},
                        p.mass[row],
                        p.volume[row],
                        Vec<D>(p.v[row]).norm()});
    }
  }
  std::vector<MovedParticle<D>> all;
  for (const std::vector<MovedParticle<D>>& of_rank : gather_rows<MovedParticle<D>>(*view.problem.ranks, here))
    all.insert(all.end(), of_rank.begin(), of_rank.end());
  std::sort(all.begin(), all.end(), [](const MovedParticle<D>& a, const MovedParticle<D>& b) { return a.id < b.id; });
  return all;
}

template <int D>
void count_altogether(const std::vector<MovedParticle<D>>& moved, const Vec3& up, Real mass_share, RunoutNumbers& sums)
{
  std::vector<Vec3> then, now;
  std::vector<Real> masses, speeds;
  Vec3 moment = Vec3::Zero(), moment_then = Vec3::Zero();
  Real mass = 0, mass_times_speed = 0;
  sums.volume = sums.entrained = sums.kinetic = sums.fastest = 0;
  for (const MovedParticle<D>& p : moved) {
    then.push_back(p.then()), now.push_back(p.now()), masses.push_back(p.mass), speeds.push_back(p.speed);
    mass += p.mass, mass_times_speed += p.mass * p.speed;
    moment += p.mass * p.now(), moment_then += p.mass * p.then();
    sums.volume += p.volume;
    sums.entrained += p.eroded != 0 ? p.volume : 0;
    sums.kinetic += p.mass * p.speed * p.speed / 2;
    sums.fastest = std::max(sums.fastest, p.speed);
  }
  sums.mean_speed = mass > 0 ? mass_times_speed / mass : 0;
  sums.bulk = not_exceeded_by(speeds, masses, mass_share);
  const auto reach = reach_of(then, now, masses, up, mass_share);
  const Vec3 nowhere = Vec3::Constant(std::numeric_limits<Real>::quiet_NaN());
  sums.front = reach ? reach->front : nowhere;
  sums.height = reach ? reach->height : std::numeric_limits<Real>::quiet_NaN(),
  sums.length = reach ? reach->length : std::numeric_limits<Real>::quiet_NaN();
  sums.centre = reach ? Vec3(moment / mass) : nowhere;
  const Vec3 way = reach ? Vec3((moment - moment_then) / mass) : nowhere;
  sums.centre_height = 0 - way.dot(up), sums.centre_length = on_the_level(way, up).norm();
}

template std::vector<MovedParticle<2>> gather_moved<2>(const RunView<2>&, const RunoutSpec&, Real);
template std::vector<MovedParticle<3>> gather_moved<3>(const RunView<3>&, const RunoutSpec&, Real);
template void count_altogether<2>(const std::vector<MovedParticle<2>>&, const Vec3&, Real, RunoutNumbers&);
template void count_altogether<3>(const std::vector<MovedParticle<3>>&, const Vec3&, Real, RunoutNumbers&);

}  // namespace talus
