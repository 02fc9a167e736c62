#include "app/commands/report/report_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/error.hpp"

namespace talus {

namespace {

constexpr std::size_t fewest_frames = 12, fewest_fields = 3;
constexpr std::int64_t fewest_particles = 200;

Real bytes_of(std::int64_t particles, std::size_t frames, std::size_t fields, const ParticleCost& cost)
{
  const Real in_a_frame = std::accumulate(cost.fields.begin(), cost.fields.begin() + static_cast<std::ptrdiff_t>(fields), cost.place);
  return static_cast<Real>(particles) * (cost.once + static_cast<Real>(frames) * in_a_frame) + static_cast<Real>(frames) * cost.frame;
}

}  // namespace

std::vector<std::size_t> evenly_spread(std::size_t n, std::size_t of)
{
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < n; ++i)
    numbers.push_back(n == 1 ? of - 1 : (i * (of - 1) + (n - 1) / 2) / (n - 1));
  return numbers;
}

PagePlan plan_page(std::int64_t particles, std::size_t frames, const ParticleCost& cost, Real budget, KeptAnyway requested)
{
  std::size_t n = frames, fields = cost.fields.size();
  const auto too_large = [&] { return bytes_of(particles, n, fields, cost) > budget; };
  while (!requested.frames && too_large() && n > fewest_frames)
    --n;
  while (!requested.fields && too_large() && fields > fewest_fields)
    --fields;
  PagePlan plan{evenly_spread(n, frames), fields, 1, bytes_of(particles, n, fields, cost)};
  if (plan.bytes <= budget)
    return plan;
  const Real of_frames = static_cast<Real>(n) * cost.frame;
  plan.share = std::max((budget - of_frames) / (plan.bytes - of_frames), 0.0);
  plan.bytes = budget;
  if (plan.share * static_cast<Real>(particles) < static_cast<Real>(std::min(fewest_particles, particles)))
    throw Error(fmt::format("--size: too small: the particles would have {:.3g} MB, and {} of them at {} times take {:.3g} MB",
                            budget / 1e6, std::min(fewest_particles, particles), n,
                            bytes_of(std::min(fewest_particles, particles), n, fields, cost) / 1e6));
  return plan;
}

}  // namespace talus
