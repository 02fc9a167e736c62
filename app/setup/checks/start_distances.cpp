#include "app/setup/checks/start_distances.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/parallel/threads.hpp"

namespace talus {

namespace {

/// The point of the table that is nearest to a particle.
struct NearestPoint {
  Index point = none;
  Real distance = 0;  ///< [m]
};

/// How far from each point particles may be; zero where no plane fits.
template <int D>
std::vector<Real> limits_around(const PointCloud<D>& cloud, const std::optional<Real>& reach)
{
  std::vector<Real> limits(static_cast<std::size_t>(cloud.size()), reach.value_or(0));
  if (!reach)
    parallel_for(cloud.size(), [&](Index i) {
      if (const auto fit = cloud.fit(cloud[i]))  // seen from some points of a long thin cloud, all may lie on one line
        limits[static_cast<std::size_t>(i)] = fit->radius;
    });
  return limits;
}

/// The lowest or highest coordinates of all points.
template <int D>
std::vector<Real> corner_of(const PointCloud<D>& cloud, bool highest)
{
  Vec<D> x = cloud[0];
  for (Index i = 1; i < cloud.size(); ++i)
    x = highest ? x.cwiseMax(cloud[i]).eval() : x.cwiseMin(cloud[i]).eval();
  return {x.begin(), x.end()};
}

}  // namespace

template <int D>
std::optional<Real> distance_from_points(const PointCloud<D>& cloud, const BodySpec& spec, const std::string& file, const Body& body,
                                         const Particles<D>& particles, Communicator& ranks, SceneErrorCollector& errors)
{
  const StartStateSpec& start = *spec.initial;
  if (!cloud.fit(cloud[0])) {
    errors.add(
        start.where, "table",
        fmt::format("all {} points of {} lie on one {}: values beside it are not known", cloud.size(), file, D == 2 ? "line" : "plane"));
    return std::nullopt;
  }
  const std::vector<Real> limits = limits_around(cloud, start.reach);
  const auto limit_of = [&](const NearestPoint& near) { return limits[static_cast<std::size_t>(near.point)]; };
  std::vector<NearestPoint> nearest(static_cast<std::size_t>(body.size()));
  parallel_for(body.size(), [&](Index i) {
    const auto [squared, point] = cloud.nearest(particles.x[static_cast<std::size_t>(body.begin + i)], 1).front();
    nearest[static_cast<std::size_t>(i)] = {point, std::sqrt(squared)};
  });
  std::int64_t beyond = 0, worst_id = std::numeric_limits<std::int64_t>::max();
  Real farthest = 0, worst = 0, limit = 0;
  for (const NearestPoint& near : nearest) {
    farthest = std::max(farthest, near.distance);
    if (near.distance > limit_of(near))
      ++beyond, worst = std::max(worst, near.distance);
  }
  farthest = ranks.max(farthest), worst = ranks.max(worst);
  if (beyond = ranks.sum(beyond); beyond == 0)
    return farthest;
  for (Index i = 0; i < body.size(); ++i) {
    const NearestPoint& near = nearest[static_cast<std::size_t>(i)];
    const std::int64_t id = particles.id[static_cast<std::size_t>(body.begin + i)];
    if (near.distance == worst && near.distance > limit_of(near) && id < worst_id)
      worst_id = id, limit = limit_of(near);
  }
  const std::int64_t first = ranks.min(worst_id), count = ranks.sum(std::int64_t{body.size()});
  limit = ranks.max(first == worst_id ? limit : 0);
  const std::string place = place_of_particle(first, body, particles, ranks);
  std::string advice = "extend the table, or allow more (reach)";
  if (beyond == count)
    advice = fmt::format("the points lie between ({:.6g}) and ({:.6g}): give them in the axes and the unit of the scene, or {}",
                         fmt::join(corner_of(cloud, false), ", "), fmt::join(corner_of(cloud, true), ", "), advice);
  errors.add(start.where, "table",
             fmt::format("{} of the {} particles of body \"{}\" lie beyond the points of {}, the worst at ({}), {:.4g} m from its nearest "
                         "point, allowed {:.4g} m; {}",
                         beyond, count, spec.name, file, place, worst, limit, advice));
  return std::nullopt;
}

template <int D>
std::string place_of_particle(std::int64_t id, const Body& body, const Particles<D>& particles, Communicator& ranks)
{
  std::string text;
  for (Index i = body.begin; i < body.end; ++i)
    if (particles.id[static_cast<std::size_t>(i)] == id) {
      const Vec<D> x = particles.x[static_cast<std::size_t>(i)];
      text = fmt::format("{:.6g}", fmt::join(x.begin(), x.end(), ", "));
    }
  return ranks.first(text);
}

template std::optional<Real> distance_from_points<2>(const PointCloud<2>&, const BodySpec&, const std::string&, const Body&,
                                                     const Particles<2>&, Communicator&, SceneErrorCollector&);
template std::optional<Real> distance_from_points<3>(const PointCloud<3>&, const BodySpec&, const std::string&, const Body&,
                                                     const Particles<3>&, Communicator&, SceneErrorCollector&);
template std::string place_of_particle<2>(std::int64_t, const Body&, const Particles<2>&, Communicator&);
template std::string place_of_particle<3>(std::int64_t, const Body&, const Particles<3>&, Communicator&);

}  // namespace talus
