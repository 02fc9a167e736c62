#pragma once
// Soils for the tests of Drucker-Prager.
#include <numbers>

#include "tests/materials/samples.hpp"

namespace talus::testing {

inline Real radians(Real degrees) { return degrees * (std::numbers::pi / 180); }

/// E = 10 MPa, nu = 0.3.
inline DruckerPrager soft_soil(ConeMatch match, Real friction, Real cohesion, Real dilation = 0)
{
  DruckerPrager law;
  law.density = 2000;
  law.youngs_modulus = 1e7;
  law.poisson_ratio = 0.3;
  law.friction_angle = friction;
  law.cohesion = cohesion;
  law.match = match;
  law.dilation_angle = dilation;
  return law;
}

/// The same, so stiff that strains under soil stresses are about 1e-12: small-strain formulas become exact.
inline constexpr Real stiffening = 1e10;
inline DruckerPrager soil(ConeMatch match, Real friction, Real cohesion, Real dilation = 0)
{
  DruckerPrager law = soft_soil(match, friction, cohesion, dilation);
  *law.youngs_modulus *= stiffening;
  return law;
}

}  // namespace talus::testing
