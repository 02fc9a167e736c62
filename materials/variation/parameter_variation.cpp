#include "materials/variation/parameter_variation.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace talus {

namespace {

Vec3 lengths_of(const std::vector<Real>& given)
{
  Vec3 lengths = Vec3::Constant(given.front());
  for (std::size_t d = 0; d < std::min<std::size_t>(given.size(), 3); ++d)
    lengths[static_cast<Index>(d)] = given[d];
  return lengths;
}

}  // namespace

void ParameterVariation::check(std::vector<std::string>& problems) const
{
  if (coefficient_of_variation > 0 && correlation_length.empty())
    problems.emplace_back("correlation_length is needed");
  if (coefficient_of_variation == 0 && trend.empty())
    problems.emplace_back("nothing varies: coefficient_of_variation is 0, and there is no trend");
  if (correlated_with.empty() != (correlation == 0))
    problems.emplace_back("correlated_with and correlation belong together: give both or none");
  if (minimum && maximum && !(*minimum < *maximum))
    problems.emplace_back("minimum must be below maximum");
}

Real ParameterVariation::unevenness(const Vec3& apart) const
{
  const Real square = coefficient_of_variation * coefficient_of_variation;
  if (square == 0)
    return 0;
  const Real variance = distribution == Distribution::lognormal ? std::log1p(square) : square;
  return variance / 2 * (1 - RandomField::correlation(covariance, lengths_of(correlation_length), apart));
}

bool ParameterVariation::operator==(const ParameterVariation& other) const
{
  const auto all = [](const ParameterVariation& one) {
    return std::tie(one.parameter, one.distribution, one.coefficient_of_variation, one.correlation_length, one.covariance, one.seed,
                    one.correlated_with, one.correlation, one.trend, one.minimum, one.maximum);
  };
  return all(*this) == all(other);
}

VariationFields::VariationFields(std::span<const ParameterVariation> variation)
{
  for (const ParameterVariation& one : variation) {
    const Real v = one.coefficient_of_variation;
    Entry entry{.field = std::nullopt,
                .distribution = one.distribution,
                .deviation = one.distribution == Distribution::lognormal ? std::sqrt(std::log1p(v * v)) : v,
                .with = std::nullopt,
                .correlation = one.correlation};
    if (v > 0)
      entry.field.emplace(one.covariance, lengths_of(one.correlation_length), static_cast<std::uint64_t>(one.seed), one.parameter);
    const auto with = std::ranges::find(variation, one.correlated_with, &ParameterVariation::parameter);
    if (!one.correlated_with.empty() && with != variation.end())
      entry.with = static_cast<std::size_t>(with - variation.begin());
    entries_.push_back(std::move(entry));
  }
}

void VariationFields::operator()(const Vec3& x, std::span<Real> factors) const noexcept
{
  for (std::size_t i = 0; i < entries_.size(); ++i)  // first the Gaussian variables
    factors[i] = entries_[i].field ? (*entries_[i].field)(x) : 0;
  for (std::size_t i = 0; i < entries_.size(); ++i)
    if (const Entry& entry = entries_[i]; entry.with && *entry.with < i)
      factors[i] = entry.correlation * factors[*entry.with] + std::sqrt(1 - entry.correlation * entry.correlation) * factors[i];
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Real s = entries_[i].deviation, g = factors[i];
    factors[i] = entries_[i].distribution == Distribution::lognormal ? std::exp(s * g - s * s / 2) : 1 + s * g;
  }
}

}  // namespace talus
