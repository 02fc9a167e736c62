// The sides of shapes: names, distances, and the carrier field of loads, which crosses no free side.
#include "app/setup/body_sides.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace talus::body_sides_test {
namespace {

using ::testing::ElementsAre;
constexpr Real rounding = 1e-12;

/// A trapezium: the base is 4 m, the top 2 m, 1 m above; the left side leans by 45 degrees, the right one too.
Polygon trapezium()
{
  Polygon polygon;
  polygon.points = {{0, 0}, {4, 0}, {3, 1}, {1, 1}};
  polygon.sides = {"base", "slope", "top", "slope"};
  polygon.holes = {{{1.8, 0.2}, {2.2, 0.2}, {2.2, 0.6}, {1.8, 0.6}}};
  return polygon;
}

TEST(BodySides, HaveTheNamesOfTheShape)
{
  EXPECT_THAT(side_names<2>(Box{{0, 0}, {1, 1}}), ElementsAre("boundary", "x_min", "x_max", "y_min", "y_max"));
  EXPECT_THAT(side_names<2>(trapezium()), ElementsAre("boundary", "base", "slope", "top", "hole_1"));
  EXPECT_THAT(side_names<2>(Ring{{0, 0}, 1, 2}), ElementsAre("boundary", "inner", "outer"));
  EXPECT_THAT(side_names<3>(Cylinder{{0, 0, 0}, {0, 0, 2}, 1}), ElementsAre("boundary", "from", "to", "mantle"));
  EXPECT_THAT(side_names<2>(Sphere{{0, 0}, 1}), ElementsAre("boundary"));
  EXPECT_FALSE(side_of<2>(trapezium(), "roof"));
}

/// m . N = 1 on the side, m . n = 0 on the sides beside it, and no divergence, by differences.
TEST(BodySides, CarryALoadWithoutCrossingTheSidesBeside)
{
  const Shape shape = trapezium();
  const BodySide<2> top = side_of<2>(shape, "top").value();
  const auto m = [&](Real x, Real y) { return top.near({x, y}).carrier; };
  EXPECT_NEAR(m(1.7, 1)[1], 1, rounding);
  EXPECT_NEAR(m(0.8001, 0.8).dot(Vec<2>(-1, 1)), 0, 1e-3) << "beside the left slope";
  EXPECT_NEAR(m(3.1999, 0.8).dot(Vec<2>(1, 1)), 0, 1e-3) << "beside the right slope";
  EXPECT_EQ(m(0.7, 0.8).norm(), 0) << "beside the columns on the top";
  constexpr Real step = 1e-5;
  for (const Vec<2>& x : {Vec<2>(1.3, 0.7), Vec<2>(2.9, 0.5), Vec<2>(2, 0.9)}) {
    const Real divergence =
        (m(x[0] + step, x[1])[0] - m(x[0] - step, x[1])[0] + m(x[0], x[1] + step)[1] - m(x[0], x[1] - step)[1]) / (2 * step);
    EXPECT_NEAR(divergence, 0, 1e-8);
  }
  EXPECT_NEAR(top.near({1.5, 0.75}).depth, 0.25, rounding);
  EXPECT_NEAR(top.near({4, 1}).depth, 1, rounding) << "beyond its end the distance from the end";
  EXPECT_NEAR(top.thickness(10), 0.4, 0.02) << "down to the hole";
  EXPECT_FALSE(top.is_closed);
}

TEST(BodySides, OfAHoleHaveNoEnd)
{
  const Shape shape = trapezium();
  const BodySide<2> hole = side_of<2>(shape, "hole_1").value();
  EXPECT_TRUE(hole.is_closed);
  EXPECT_EQ(hole.pieces.size(), 4u);
  EXPECT_LT((hole.near({2, 0.7}).normal - Vec<2>(0, -1)).norm(), rounding) << "out of the body, into the hole";
  EXPECT_NEAR(hole.near({2.3, 0.7}).carrier.dot(Vec<2>(1, -1).normalized()), 0, 1e-9) << "along the line halfway between two sides";
  EXPECT_NEAR(hole.near({2.3, 0.7}).depth, std::numbers::sqrt2 / 10, rounding);
}

TEST(BodySides, ThatAreRoundSpreadWhatTheyCarry)
{
  const BodySide<2> inner = side_of<2>(Ring{{1, 0}, 1, 3}, "inner").value();
  const NearSide<2> near = inner.near({3, 0});
  EXPECT_EQ(near.depth, 1);
  EXPECT_LT((near.normal - Vec<2>(-1, 0)).norm(), rounding);
  EXPECT_LT((near.carrier - Vec<2>(-0.5, 0)).norm(), rounding) << "on a circle twice as long";
  EXPECT_EQ(inner.thickness(10), 2);
  const BodySide<3> ball = side_of<3>(Ring{{1, 0, 0}, 1, 3}, "outer").value();
  EXPECT_LT((ball.near({3, 0, 0}).carrier - Vec<3>(2.25, 0, 0)).norm(), rounding) << "on a sphere 4/9 as large";
  const BodySide<3> mantle = side_of<3>(Cylinder{{0, 0, 0}, {0, 0, 2}, 1}, "mantle").value();
  EXPECT_LT((mantle.near({0.5, 0, 1.7}).carrier - Vec<3>(2, 0, 0)).norm(), rounding);
  EXPECT_FALSE(mantle.is_closed) << "it ends at the faces";
}

TEST(BodySides, OfABoxAreItsFaces)
{
  const BodySide<3> face = side_of<3>(Box{{0, 0, 0}, {1, 2, 3}}, "y_max").value();
  EXPECT_NEAR(face.near({0.5, 1.5, 1}).depth, 0.5, rounding);
  EXPECT_LT((face.near({0.5, 1.5, 1}).carrier - Vec<3>(0, 1, 0)).norm(), rounding);
  EXPECT_EQ(face.thickness(10), 2);
  EXPECT_EQ(face.thickness(1), 1);
  EXPECT_TRUE(side_of<3>(Box{{0, 0, 0}, {1, 2, 3}}, "boundary")->is_whole);
}

}  // namespace
}  // namespace talus::body_sides_test
