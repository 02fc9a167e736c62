#pragma once
// Goes into tests/materials/samples.hpp: the parameters with which the contract tests try the law.
#include "tests/materials/samples.hpp"

namespace talus::testing {

template <>
inline Maxwell sample<Maxwell>()
{
  Maxwell law;
  law.density = 2000;
  law.youngs_modulus = sample_stiffness;
  law.poisson_ratio = 0.3;
  law.relaxation_time = 0.5;
  return law;
}

}  // namespace talus::testing
