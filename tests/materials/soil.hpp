#pragma once
// Soils for the tests of Drucker-Prager, and what every soil with a cut of tension does.
#include <gtest/gtest.h>

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

/// Soil without cohesion is pulled apart by a logarithmic volume of 0.2 and pushed together again: it bears stress from then on only.
template <class L>
void expect_no_stress_until_closed(Point<L> point)
{
  const auto by = [&](Real log_volume) { point.step(std::exp(log_volume / 3) * Mat3::Identity()); };
  for (int n = 0; n < 10; ++n) {
    by(0.02);
    EXPECT_EQ(point.stress.norm(), 0);
  }
  EXPECT_NEAR(point.state.opened_volume, 0.2, 1e-14);
  for (int n = 0; n < 9; ++n) {
    by(-0.02);
    EXPECT_EQ(point.stress.norm(), 0);
  }
  by(-0.02 - 1e-13);
  by(-1e-12);
  EXPECT_EQ(point.state.opened_volume, 0);
  EXPECT_NEAR(point.stress(0, 0), -1.1e-12 * point.law.constants().bulk, 2e-14 * point.law.constants().bulk);
  EXPECT_EQ(point.state.plastic_work, 0);
}

}  // namespace talus::testing
