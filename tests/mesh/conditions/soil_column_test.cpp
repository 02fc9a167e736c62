// Waves in the column of the free field, against those of a homogeneous bar.
#include "mesh/conditions/soil_column.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace talus::soil_column_test {
namespace {

constexpr Halfspace soil{2000, 200, 400};

/// 20 layers of 1 m from a height of 5 m on.
template <int D>
SoilColumn<D> column_of(const Halfspace& ground)
{
  SoilColumn<D> column;
  for (int l = 0; l <= 20; ++l)
    column.level.push_back(5 + l);
  column.layer.assign(20, {ground, 1});
  return column;
}

TEST(SoilColumn, ImpedanceIsThatOfPlaneWaves)
{
  const Vec<3> area(0, 0, 2);
  const Mat<3> Z = impedance<3>(soil, area);
  EXPECT_NEAR(Z(0, 0), 2 * 2000 * 200, 1e-6);
  EXPECT_NEAR(Z(2, 2), 2 * 2000 * 400, 1e-6);
  EXPECT_NEAR(Z(0, 2), 0, 1e-6);
}

TEST(SoilColumn, TellsVelocityBetweenLevelsAndKeepsItBeyond)
{
  const SoilColumn<2> column = column_of<2>(soil);
  ColumnMotion motion = column.at_rest();
  for (std::size_t l = 0; l <= 20; ++l)
    motion.velocity[2 * l] = static_cast<Real>(l), motion.velocity[2 * l + 1] = -2 * static_cast<Real>(l);
  EXPECT_EQ(column.layer_at(0), 0U);
  EXPECT_EQ(column.layer_at(7.5), 2U);
  EXPECT_EQ(column.layer_at(99), 19U);
  EXPECT_NEAR((column.velocity_at(7.5, motion) - Vec<2>(2.5, -5)).norm(), 0, 1e-12);
  EXPECT_NEAR((column.velocity_at(0, motion) - Vec<2>(0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((column.velocity_at(99, motion) - Vec<2>(20, -40)).norm(), 0, 1e-12);
}

TEST(SoilColumn, MovesAsAWholeWithItsFoot)
{
  const SoilColumn<3> column = column_of<3>(soil);
  ColumnMotion motion = column.at_rest();
  const Vec<3> v(0.1, -0.2, 0.3);
  for (std::size_t k = 0; k < motion.velocity.size(); ++k)
    motion.velocity[k] = v[static_cast<Index>(k % 3)];
  ColumnBase<3> base;
  base.velocity = v;
  advance(column, base, 0.05, motion);  // several parts: a wave crosses a layer in 2.5 ms
  for (const Real traction : motion.traction)
    EXPECT_EQ(traction, 0);
  for (std::size_t k = 0; k < motion.velocity.size(); ++k)
    EXPECT_EQ(motion.velocity[k], v[static_cast<Index>(k % 3)]);
}

/// Velocity of a wave that rises smoothly from 0 to 1 within a second.
Real rising(Real t) { return t <= 0 ? 0 : t >= 1 ? 1 : (1 - std::cos(std::numbers::pi * t)) / 2; }

/// A wave comes up from below that rises so within `crossing` [s], the time that it takes to the free ground at the top: velocity there after
/// so many crossings.
Vec<2> top_after(Real crossings, Real crossing, const Vec<2>& along)
{
  const SoilColumn<2> column = column_of<2>(soil);
  ColumnMotion motion = column.at_rest();
  const int steps = static_cast<int>(std::lround(400 * crossings));
  for (int step = 0; step < steps; ++step)
    advance(column, {rising((step + 1) / 400.0) * along, soil}, crossing / 400, motion);
  return column.velocity_at(25, motion);
}

TEST(SoilColumn, AWaveComesWithItsSpeedIsDoubledByTheFreeGroundAndLeaves)
{
  constexpr Real close = 0.01;  // layers are a twentieth of the way in which it rises, steps a four hundredth of the time
  for (const Real crossings : {0.9, 1.25, 1.5, 1.75, 2.0, 3.0, 6.0}) {
    const Vec<2> shear = top_after(crossings, 20.0 / 200, {1, 0}), pressure = top_after(crossings, 20.0 / 400, {0, 1});
    EXPECT_NEAR(shear[0], 2 * rising(crossings - 1), close) << crossings;
    EXPECT_NEAR(pressure[1], 2 * rising(crossings - 1), close) << crossings;
    EXPECT_EQ(shear[1], 0);
    EXPECT_EQ(pressure[0], 0);
  }
}

TEST(SoilColumn, PushesOnAnUprightFacetAsItsStressDoes)
{
  SoilColumn<2> column = column_of<2>(soil);
  ColumnMotion motion = column.at_rest();
  motion.traction[2 * 3] = 7, motion.traction[2 * 3 + 1] = 12;  // shear and vertical stress of layer 3
  const Vec<2> area(-2, 0);                                     // 2 m2, looking along -x
  // lambda / (lambda + 2 mu) = 1 - 2 (200 / 400)^2 = 1/2: stress across 6 Pa, shear 7 Pa.
  EXPECT_NEAR((column.force_on(area, 3, motion) - Vec<2>(-12, -14)).norm(), 0, 1e-12);
  column.layer[3].filled = 0.5;
  EXPECT_NEAR((column.force_on(area, 3, motion) - Vec<2>(-6, -7)).norm(), 0, 1e-12);
}

}  // namespace
}  // namespace talus::soil_column_test
