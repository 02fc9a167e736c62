#include "materials/parts/elasticity.hpp"

#include <fmt/format.h>

#include <limits>

namespace talus {

namespace {

Moduli from_bulk_and_shear(Real K, Real G) noexcept
{
  return {
      .youngs = 9 * K * G / (3 * K + G), .poisson = (3 * K - 2 * G) / (2 * (3 * K + G)), .bulk = K, .shear = G, .lambda = K - 2 * G / 3};
}
Moduli from_youngs_and_poisson(Real E, Real nu) noexcept
{
  const Real G = E / (2 * (1 + nu));
  return {.youngs = E, .poisson = nu, .bulk = E / (3 * (1 - 2 * nu)), .shear = G, .lambda = 2 * G * nu / (1 - 2 * nu)};
}

}  // namespace

Elasticity elasticity(Real youngs_modulus, Real poisson_ratio)
{
  Elasticity elastic;
  elastic.youngs_modulus = youngs_modulus;
  elastic.poisson_ratio = poisson_ratio;
  return elastic;
}

Moduli Elasticity::moduli() const noexcept
{
  const auto &E = youngs_modulus, &nu = poisson_ratio, &K = bulk_modulus, &G = shear_modulus, &lambda = lame_lambda;
  if (E && nu)
    return from_youngs_and_poisson(*E, *nu);
  if (G && nu)
    return from_youngs_and_poisson(2 * *G * (1 + *nu), *nu);
  if (K && G)
    return from_bulk_and_shear(*K, *G);
  if (lambda && G)
    return from_bulk_and_shear(*lambda + 2 * *G / 3, *G);
  if (E && K)
    return from_youngs_and_poisson(*E, 0.5 - *E / (6 * *K));
  constexpr Real nothing = std::numeric_limits<Real>::quiet_NaN();
  return {nothing, nothing, nothing, nothing, nothing};
}

void Elasticity::check(std::vector<std::string>& problems) const
{
  std::vector<std::string_view> given;
  std::vector<Real> values;
  const auto note = [&](std::string_view key, const std::optional<Real>& value) {
    if (value) {
      given.push_back(key);
      values.push_back(*value);
    }
  };
  note("youngs_modulus", youngs_modulus);
  note("poisson_ratio", poisson_ratio);
  note("bulk_modulus", bulk_modulus);
  note("shear_modulus", shear_modulus);
  note("lame_lambda", lame_lambda);
  const auto has = [](const std::optional<Real>& a, const std::optional<Real>& b) { return a && b; };
  const bool a_pair = has(youngs_modulus, poisson_ratio) || has(bulk_modulus, shear_modulus) || has(lame_lambda, shear_modulus) ||
                      has(youngs_modulus, bulk_modulus) || has(shear_modulus, poisson_ratio);
  if (given.size() != 2 || !a_pair)
    return problems.push_back(
        fmt::format("elastic constants come as one pair: youngs_modulus and poisson_ratio, bulk_modulus and shear_modulus, lame_lambda and "
                    "shear_modulus, youngs_modulus and bulk_modulus, or shear_modulus and poisson_ratio; here {}",
                    given.empty()       ? "there is none"
                    : given.size() == 1 ? fmt::format("there is {} alone", given.front())
                                        : fmt::format("there are {}", fmt::join(given, ", "))));
  const Moduli m = moduli();
  if (!(m.poisson > -1 && m.poisson < 0.5 && m.shear > 0 && m.bulk > 0))
    problems.push_back(fmt::format("{} {:.6g} and {} {:.6g} make Poisson's ratio {:.6g}, which must lie in (-1, 0.5)", given[0], values[0],
                                   given[1], values[1], m.poisson));
}

}  // namespace talus
