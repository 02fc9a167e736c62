#include "io/scene/study_samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

namespace talus {

namespace {

constexpr Real deviations_kept = 3;  // limits in standard deviations, unless the ends are given

bool is_normal(const Spread& spread) noexcept { return spread.mean.has_value(); }

Real lowest(const Spread& s) noexcept { return s.low.value_or(is_normal(s) ? *s.mean - deviations_kept * *s.deviation : 0); }
Real highest(const Spread& s) noexcept { return s.high.value_or(is_normal(s) ? *s.mean + deviations_kept * *s.deviation : 0); }

/// The standard normal distribution function at x.
Real normal_share(Real x) noexcept { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

/// The quantile of the standard normal distribution, by bisection: samples are few.
Real normal_quantile(Real share) noexcept
{
  Real low = -40, high = 40;
  for (int i = 0; i < 100; ++i) {
    const Real middle = 0.5 * (low + high);
    (normal_share(middle) < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// FNV-1a, to give each key its own random numbers.
std::uint64_t number_of(std::string_view text) noexcept
{
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text)
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

}  // namespace

void Spread::check(std::vector<std::string>& problems) const
{
  if (mean.has_value() != deviation.has_value())
    problems.emplace_back("mean and deviation belong together");
  if (mean && mode)
    problems.emplace_back("mode is of a triangular distribution, mean of a normal one: one of them");
  if (!mean && !(low && high))
    problems.emplace_back("low and high are needed, with mode or without; or mean and deviation");
  if (!problems.empty())
    return;
  if (!(lowest(*this) < highest(*this)))
    problems.push_back(fmt::format("low {} must be below high {}", lowest(*this), highest(*this)));
  const auto centre = mode ? mode : mean;
  if (problems.empty() && centre && !(*centre >= lowest(*this) && *centre <= highest(*this)))
    problems.push_back(
        fmt::format("{} {} is not between low {} and high {}", mode ? "mode" : "mean", *centre, lowest(*this), highest(*this)));
}

Real quantile(const Spread& s, Real p) noexcept
{
  const Real low = lowest(s), high = highest(s);
  if (is_normal(s)) {
    const Real below = normal_share((low - *s.mean) / *s.deviation), above = normal_share((high - *s.mean) / *s.deviation);
    return std::clamp(*s.mean + *s.deviation * normal_quantile(below + p * (above - below)), low, high);
  }
  if (s.mode) {
    const Real rise = (*s.mode - low) / (high - low);
    return p < rise ? low + std::sqrt(p * (high - low) * (*s.mode - low)) : high - std::sqrt((1 - p) * (high - low) * (high - *s.mode));
  }
  return low + p * (high - low);
}

LowMiddleHigh three_of(const Spread& s) noexcept
{
  const Real low = lowest(s), high = highest(s);
  if (is_normal(s))
    return {std::max(low, *s.mean - *s.deviation), *s.mean, std::min(high, *s.mean + *s.deviation)};
  return {low, s.mode.value_or(0.5 * (low + high)), high};
}

std::vector<Real> latin_column(std::string_view key, std::uint64_t seed, std::size_t count)
{
  // The engine gives the same numbers everywhere, which the standard library does not guarantee for its distributions.
  std::mt19937_64 random(number_of(key) ^ (seed * 0x9e3779b97f4a7c15U));
  std::vector<std::size_t> part(count);
  std::iota(part.begin(), part.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i)
    std::swap(part[i - 1], part[random() % i]);
  std::vector<Real> shares;
  for (const std::size_t k : part) {
    const Real within = (static_cast<Real>(random() >> 11) + 0.5) * 0x1p-53;
    shares.push_back((static_cast<Real>(k) + within) / static_cast<Real>(count));
  }
  return shares;
}

}  // namespace talus
