// The affine field that particles give to the nodes after they have moved.
#include <gtest/gtest.h>

#include <random>

#include "core/particles.hpp"
#include "solver/strips/affine_field.hpp"

namespace talus::testing::affine_field_test {
namespace {

template <class T>
class AffineFieldIn : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(AffineFieldIn, Dimensions);

/// What a particle that has read C and has then moved for a time dt gives to the nodes; with G, it has a reference.
template <int D>
Mat<D> given(const Mat<D>& C, Real dt, bool has_reference = false)
{
  constexpr int lane = 2;
  Real read[D * D * pack_size]{}, moved[D * D * pack_size]{};
  StripColumns<D> columns;
  columns.L = {read, pack_size};
  columns.L.set(lane, C);
  if (has_reference)
    columns.G = {moved, pack_size};
  return lane_of<D, D>(affine_field(columns, 0, dt), lane);
}

template <int D>
Mat<D> any_matrix(std::mt19937& random)
{
  std::uniform_real_distribution<Real> number(-1, 1);
  return Mat<D>::NullaryExpr([&] { return number(random); });
}
/// (I - S)^-1 (I + S), S skew (Cayley).
template <int D>
Mat<D> any_rotation(std::mt19937& random)
{
  const Mat<D> any = any_matrix<D>(random), S = any - any.transpose();
  return (Mat<D>::Identity() - S).inverse() * (Mat<D>::Identity() + S);
}
template <int D>
Mat<D> entry(int row, int column)
{
  Mat<D> one = Mat<D>::Zero();
  one(row, column) = 1;
  return one;
}

/// A linear field of velocity in which points at r move to (I + dt C) r, with the velocity C r that they had.
template <int D>
void is_carried_exactly(const Mat<D>& C, Real dt)
{
  EXPECT_LT((given<D>(C, dt) * (Mat<D>::Identity() + dt * C) - C).norm(), 1e-14 * C.norm());
}

TYPED_TEST(AffineFieldIn, CarriesRotationsShearAndExpansionExactly)
{
  constexpr int D = TypeParam::value;
  std::mt19937 random(1);
  for (int i = 0; i < 20; ++i) {
    const Mat<D> Q = any_rotation<D>(random);
    is_carried_exactly<D>(3 * Q * (entry<D>(0, 1) - entry<D>(1, 0)) * Q.transpose(), 0.1);
    is_carried_exactly<D>(3 * Q * entry<D>(0, D - 1) * Q.transpose(), 0.1);
    is_carried_exactly<D>(3 * Q * (Mat<D>::Identity() + 0.1 * entry<D>(0, D - 1)) * Q.transpose(), 0.1);
  }
}

TYPED_TEST(AffineFieldIn, StaysWhatItIsUnderCompression)
{
  constexpr int D = TypeParam::value;
  const Mat<D> C = -Mat<D>::Identity();
  for (const Real dt : {0.1, 0.5, 0.999})  // with 1 all points about the particle would meet
    EXPECT_LT((given<D>(C, dt) - C).norm(), 1e-13) << dt;
}

TYPED_TEST(AffineFieldIn, IsNeverLongerThanWhatWasRead)
{
  constexpr int D = TypeParam::value;
  std::mt19937 random(2);
  for (int i = 0; i < 10000; ++i) {
    const Mat<D> C = any_matrix<D>(random);
    const Real dt = std::pow(10, std::uniform_real_distribution<Real>(-3, 3)(random));
    EXPECT_LE(given<D>(C, dt).norm(), C.norm() * (1 + 1e-14)) << C << ", " << dt;
  }
  // det(I + dt C) is zero
  EXPECT_NEAR(given<D>(-entry<D>(0, 0), 1).norm(), 1, 1e-14);
  EXPECT_LE(given<D>(-entry<D>(0, 0) - entry<D>(0, 1), 1).norm(), std::sqrt(2) + 1e-14);
}

TYPED_TEST(AffineFieldIn, OfNothingIsNothing)
{
  constexpr int D = TypeParam::value;
  EXPECT_EQ(given<D>(Mat<D>::Zero(), 0.1), Mat<D>(Mat<D>::Zero()));
}

TYPED_TEST(AffineFieldIn, IsThatOfTheReferenceOrOfTheSamePlaceAsItWasRead)
{
  constexpr int D = TypeParam::value;
  std::mt19937 random(3);
  const Mat<D> C = any_matrix<D>(random);
  EXPECT_EQ(given<D>(C, 0.1, true), C);
  EXPECT_EQ(given<D>(C, 0), C);
}

}  // namespace
}  // namespace talus::testing::affine_field_test
