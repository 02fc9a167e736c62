#pragma once
// What the contract tests of laws have in common.
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <numeric>

#include "materials/interface/constitutive_law_of.hpp"
#include "materials/parts/strength.hpp"
#include "tests/materials/samples.hpp"

namespace talus::law_contract_test {

using testing::Dice;
using testing::Point;
using testing::sample;

/// Rounding of a stress made of moduli times differences from one: stiffness x 1e-15 x operations.
inline constexpr Real rounding = 1e-13 * testing::sample_stiffness;

template <class List>
struct AsGtest;
template <class... L>
struct AsGtest<TypeList<L...>> {
  using Types = ::testing::Types<L...>;
};

/// Random stretches and turns up to 60 % in all, in small and in large steps.
inline std::vector<Mat3> random_steps(Dice& dice)
{
  std::vector<Mat3> steps;
  for (int n = 0; n < 40; ++n)
    steps.push_back(Mat3::Identity() + dice.matrix(n % 10 == 9 ? 0.1 : 0.01));
  return steps;
}

}  // namespace talus::law_contract_test
