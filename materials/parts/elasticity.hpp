#pragma once
// Isotropic elastic constants, given by any pair.
#include <optional>
#include <string>
#include <vector>

#include "core/fields.hpp"

namespace talus {

/// All elastic constants of an isotropic solid at small strain [Pa], and Poisson's ratio [-].
struct Moduli {
  Real youngs, poisson, bulk, shear, lambda;
  /// lambda + 2 mu, the modulus of uniaxial strain [Pa].
  Real confined() const noexcept { return lambda + 2 * shear; }
};

/// The elastic parameters that laws inherit: one of the pairs E nu, K G, lambda G, E K, G nu.
struct Elasticity {
  std::optional<Real> youngs_modulus, poisson_ratio, bulk_modulus, shear_modulus, lame_lambda;

  /// Appends errors unless exactly one pair is given and it is stable: -1 < nu < 0.5.
  void check(std::vector<std::string>& problems) const;
  /// The constants from a pair that passes check(); NaN otherwise.
  Moduli moduli() const noexcept;
};

/// The fields of a law that inherits Elasticity, to be joined with its own by std::tuple_cat.
template <class Law>
constexpr auto elastic_fields()
{
  const auto constant = [](std::string_view key, std::optional<Real> Law::*member, const Range& range, std::string_view unit,
                           std::string_view meaning) { return optional(key, member, range, unit, meaning); };
  return std::tuple{
      constant("youngs_modulus", &Law::youngs_modulus, positive, "Pa", "Young's modulus; with poisson_ratio or bulk_modulus"),
      constant("poisson_ratio", &Law::poisson_ratio, between(-1, 0.5), "-", "Poisson's ratio; with youngs_modulus or shear_modulus"),
      constant("bulk_modulus", &Law::bulk_modulus, positive, "Pa", "bulk modulus; with shear_modulus or youngs_modulus"),
      constant("shear_modulus", &Law::shear_modulus, positive, "Pa", "shear modulus; with poisson_ratio, bulk_modulus or lame_lambda"),
      constant("lame_lambda", &Law::lame_lambda, any, "Pa", "first constant of Lame; with shear_modulus")};
}

/// The parameters with E [Pa] and nu in (-1, 0.5).
Elasticity elasticity(Real youngs_modulus, Real poisson_ratio);

}  // namespace talus
