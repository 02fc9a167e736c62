// Principal values and axes in lanes, against those of Eigen and against what they are by construction.
#include "materials/parts/principal_axes.hpp"

#include <gtest/gtest.h>

#include "materials/parts/logarithm.hpp"
#include "tests/materials/samples.hpp"

namespace talus::principal_axes_test {
namespace {

using testing::Dice;

constexpr Real rounding = 1e-15;

Real size_of(const Sym3& a) { return std::sqrt(0.5 * squared_norm(a)); }
ShearDirection<Real> direction_of(const Sym3& a) { return {a, size_of(a)}; }
Sym3 turned(const Vec3& values, const Mat3& axes) { return pack(Mat3(axes * values.asDiagonal() * axes.transpose())); }

/// Shapes from two equal values over all between to two others, some as near to equal as numbers can be.
std::vector<Vec3> shapes()
{
  std::vector<Vec3> all;
  for (const Real gap : {0.0, 1e-16, 1e-15, 1e-12, 1e-9, 1e-7, 1e-4, 0.01, 0.3, 1.0}) {
    all.emplace_back(1 + gap, 1, -2 - gap);
    all.emplace_back(2 + gap, -1, -1 - gap);
  }
  return all;
}

TEST(PrincipalAxes, ValuesAreRightToRoundingAlsoWhereTheyAreEqual)
{
  Dice dice(1);
  for (const Vec3& shape : shapes())
    for (const Real scale : {1.0, 1e-12, 1e-30, 1e5})
      for (int n = 0; n < 20; ++n) {
        const Sym3 a = turned(scale * shape, dice.rotation());
        const PrincipalAxes<Real> found = direction_of(a).axes();
        EXPECT_LE((found.values - scale * shape).norm(), 10 * rounding * scale * shape.norm()) << shape.transpose();
        EXPECT_GE(found.values[0], found.values[1]);
        EXPECT_GE(found.values[1], found.values[2]);
      }
}

TEST(PrincipalAxes, AxesAreOrthonormalAndMakeTheTensor)
{
  Dice dice(2);
  for (const Vec3& shape : shapes())
    for (int n = 0; n < 50; ++n) {
      const Sym3 a = turned(shape, dice.rotation());
      const PrincipalAxes<Real> found = direction_of(a).axes();
      EXPECT_NEAR(found.first.norm(), 1, 3 * rounding);
      EXPECT_NEAR(found.last.norm(), 1, 3 * rounding);
      EXPECT_NEAR(found.first.dot(found.last), 0, 3 * rounding);
      EXPECT_LE((found.tensor(found.values) - a).norm(), 10 * rounding * shape.norm()) << shape.transpose();
    }
}

TEST(PrincipalAxes, OfADiagonalTensorAreThoseOfTheCoordinatesExactly)
{
  for (const Vec3& values : {Vec3(1, 1, -2), Vec3(1, -2, 1), Vec3(-2, 1, 1), Vec3(-1, -1, 2), Vec3(2, -1, -1), Vec3(3, -1, -2)}) {
    Sym3 a = Sym3::Zero();
    a.head<3>() = values;
    const PrincipalAxes<Real> found = direction_of(a).axes();
    for (const auto& axis : {found.first, found.last})
      EXPECT_EQ(axis.cwiseAbs().maxCoeff(), 1) << values.transpose();
    if (values[0] == values[1]) {
      EXPECT_EQ(found.tensor(found.values)[0], found.tensor(found.values)[1]);
    }
  }
}

TEST(PrincipalAxes, WithoutShearThereAreAxesAndNoValues)
{
  const PrincipalAxes<Real> found = direction_of(Sym3::Zero()).axes();
  EXPECT_EQ(found.values.norm(), 0);
  EXPECT_NEAR(found.first.norm(), 1, rounding);
  Sym3 isotropic = Sym3::Zero();
  isotropic.head<3>().setConstant(0.3);
  EXPECT_EQ((found.tensor(Vec3::Constant(0.3)) - isotropic).norm(), 0);
}

TEST(PrincipalAxes, RoughExtremesHaveHalfOfTheDigits)
{
  Dice dice(3);
  for (const Vec3& shape : shapes()) {
    const auto [most, least] = direction_of(turned(shape, dice.rotation())).rough_extremes();
    EXPECT_NEAR(most, shape[0], 1e-7);
    EXPECT_NEAR(least, shape[2], 1e-7);
  }
}

TEST(PrincipalAxes, EveryLaneHasItsOwn)
{
  Dice dice(4);
  for (int n = 0; n < 100; ++n) {
    std::array<Sym3, pack_size> each;
    Sym3Of<SimdReal> together;
    SimdReal size = 0;
    for (int lane = 0; lane < pack_size; ++lane) {
      const auto all = shapes();
      Sym3& one = each[static_cast<std::size_t>(lane)];
      one = n % 5 == lane ? Sym3(Sym3::Zero()) : turned(all[static_cast<std::size_t>(n + 3 * lane) % all.size()], dice.rotation());
      size.set(lane, size_of(one));
      for (int k = 0; k < 6; ++k)
        together[k].set(lane, one[k]);
    }
    const PrincipalAxes<SimdReal> found = ShearDirection<SimdReal>(together, size).axes();
    for (int lane = 0; lane < pack_size; ++lane) {
      const PrincipalAxes<Real> alone = direction_of(each[static_cast<std::size_t>(lane)]).axes();
      const Sym3 made = alone.tensor(Vec3(1, 5, 7));
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(found.values[k][lane], alone.values[k], 10 * rounding) << lane;
      if (n % 5 != lane && alone.values[0] - alone.values[1] > 0.01 && alone.values[1] - alone.values[2] > 0.01) {
        for (int k = 0; k < 6; ++k)
          EXPECT_NEAR(found.tensor(Vec3Of<SimdReal>(1, 5, 7))[k][lane], made[k], 1e-12) << lane;
      }
    }
  }
}

}  // namespace
}  // namespace talus::principal_axes_test
