// Symmetric matrices by their entries, against the same matrices of Eigen.
#include "kernels/symmetric.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

namespace talus::test::symmetric_test {
namespace {

template <int D>
Symmetric<D> of(const Mat<D>& full)
{
  Symmetric<D> packed;
  for (int i = 0; i < D; ++i)
    for (int j = i; j < D; ++j)
      packed.entry[Symmetric<D>::place(i, j)] = full(i, j);
  return packed;
}

template <int D>
void expect_as_eigen(const Mat<D>& full)
{
  const Symmetric<D> packed = of<D>(full), adjoint = adjugate(packed);
  const Mat<D> expected = full.determinant() * full.inverse();
  EXPECT_NEAR(packed.trace(), full.trace(), 1e-14);
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) {
      EXPECT_EQ(packed(i, j), full(i, j)) << i << " " << j;
      EXPECT_NEAR(adjoint(i, j), expected(i, j), 1e-12) << i << " " << j;
    }
  EXPECT_NEAR(determinant(packed, adjoint), full.determinant(), 1e-12);
  EXPECT_NEAR(round_determinant(packed), std::pow(full.trace() / D, D), 1e-12);
}

TEST(Symmetric, IsWhatEigenSaysOfTheFullMatrix)
{
  Mat<2> plane;
  plane << 2, 0.5, 0.5, 3;
  expect_as_eigen<2>(plane);
  Mat<3> space;
  space << 2, 0.5, -0.25, 0.5, 3, 0.75, -0.25, 0.75, 5;
  expect_as_eigen<3>(space);
}

}  // namespace
}  // namespace talus::test::symmetric_test
