#pragma once
// Dimensions and kernels in which contacts are tested.
#include <gtest/gtest.h>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing {

template <int N, template <int> class K>
struct Kind {
  static constexpr int D = N;
  using Kernel = K<N>;
};
using ContactKinds = ::testing::Types<Kind<2, Projected>, Kind<2, Umls>, Kind<2, Linear>, Kind<3, Projected>, Kind<3, Linear>>;

template <int D>
Vec<D> along(int axis, Real size)
{
  return size * Vec<D>::Unit(axis);
}

}  // namespace talus::testing
