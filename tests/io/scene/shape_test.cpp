// Shapes of a scene hold the points that they should.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/scene/scene.hpp"

namespace talus::scene_test {
namespace {

using testing::ElementsAre;

TEST(Shape, WrongShapesAreRefused)
{
  const auto problems_of = [](const Polygon& polygon) {
    std::vector<std::string> problems;
    polygon.check(problems);
    return problems;
  };
  const std::vector<std::vector<Real>> square{{0, 0}, {4, 0}, {4, 4}, {0, 4}};
  EXPECT_THAT(problems_of({square, {}, {{{1, 1}, {2, 1}, {1, 2}}}, {}}), ElementsAre());
  EXPECT_THAT(problems_of({square, {}, {{{1, 1}, {5, 1}, {1, 2}}}, {}}), ElementsAre("holes[0] does not lie inside the polygon"));
  EXPECT_THAT(problems_of({square, {}, {{{1, 1}, {2, 1}}}, {}}), ElementsAre("holes[0]: a polygon needs at least 3 points, not 2"));
  EXPECT_THAT(problems_of({square, {}, {{{1, 1}, {3, 1}, {1, 3}}, {{1.2, 1.2}, {1.4, 1.2}, {1.2, 1.4}}}, {}}),
              ElementsAre("holes[0] and holes[1] overlap or touch"));
  EXPECT_THAT(problems_of({square, {}, {}, {"a", "b"}}), ElementsAre("sides needs a name for each of the 4 sides, not 2"));
  EXPECT_THAT(problems_of({square, {}, {}, {"a", "boundary", "c", "d"}}),
              ElementsAre("\"boundary\" cannot be the name of a side: boundary and hole_i are groups of their own"));
  std::vector<std::string> problems;
  Ring{{0, 0}, 2, 1}.check(problems);
  EXPECT_THAT(problems, ElementsAre("inner_radius must be smaller than radius: 2 and 1"));
}

bool holds(const Shape& shape, std::initializer_list<Real> x) { return contains(shape, std::span(x.begin(), x.size())); }

TEST(Shape, BoxHoldsItsSurfaceAndNothingOutside)
{
  const Box box{{0, 0}, {2, 1}};
  EXPECT_TRUE(holds(box, {1, 0.5}));
  EXPECT_TRUE(holds(box, {2, 1}));
  EXPECT_FALSE(holds(box, {2.001, 0.5}));
  EXPECT_FALSE(holds(box, {1, -0.001}));
}

TEST(Shape, SphereHoldsPointsUpToItsRadius)
{
  const Sphere ball{{1, 1, 1}, 2};
  EXPECT_TRUE(holds(ball, {1, 1, 3}));
  EXPECT_FALSE(holds(ball, {1, 1, 3.001}));
  EXPECT_TRUE(holds(Sphere{{0, 0}, 5}, {3, 4}));
}

TEST(Shape, CylinderEndsAtItsFaces)
{
  const Cylinder cylinder{{0, 0, 0}, {2, 2, 0}, 0.5};
  EXPECT_TRUE(holds(cylinder, {1, 1, 0.5}));
  EXPECT_TRUE(holds(cylinder, {0, 0, 0}));
  EXPECT_FALSE(holds(cylinder, {-0.1, -0.1, 0}));
  EXPECT_FALSE(holds(cylinder, {2.1, 2.1, 0}));
  EXPECT_FALSE(holds(cylinder, {1, 1, 0.51}));
}

TEST(Shape, PolygonHoldsItsCornersAndSidesInEitherOrder)
{
  const std::vector<std::vector<Real>> corners{{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}};
  for (const auto& points : {corners, std::vector(corners.rbegin(), corners.rend())}) {
    const Polygon polygon{points, {}};
    EXPECT_TRUE(holds(polygon, {2, 0.5}));
    EXPECT_TRUE(holds(polygon, {3.5, 2}));
    EXPECT_FALSE(holds(polygon, {2, 2}));  // in the notch
    EXPECT_FALSE(holds(polygon, {-1, 0}));
    EXPECT_FALSE(holds(polygon, {-1, 1}));
    EXPECT_FALSE(holds(polygon, {5, 4}));
    for (const auto& corner : points)
      EXPECT_TRUE(contains(polygon, corner));
    EXPECT_TRUE(holds(polygon, {1, 0}));
    EXPECT_TRUE(holds(polygon, {4, 2}));
    EXPECT_TRUE(holds(polygon, {3, 2.5}));
  }
}

TEST(Shape, PolygonIsExtrudedBetweenTwoHeights)
{
  const Polygon prism{{{0, 0}, {1, 0}, {0, 1}}, {-1, 2}};
  EXPECT_TRUE(holds(prism, {0.2, 0.2, 2}));
  EXPECT_FALSE(holds(prism, {0.2, 0.2, 2.1}));
  EXPECT_FALSE(holds(prism, {0.8, 0.8, 0}));
}

TEST(Shape, PolygonOfManyCornersIsCheckedQuickly)
{
  Polygon comb;
  const int teeth = 20'000;
  for (int i = 0; i <= teeth; ++i)
    comb.points.push_back({static_cast<Real>(i), i % 2 == 0 ? 1.0 : 2.0});
  comb.points.push_back({static_cast<Real>(teeth), 0});
  comb.points.push_back({0, 0});
  std::vector<std::string> problems;
  comb.check(problems);
  EXPECT_THAT(problems, ElementsAre());
  comb.points[teeth / 2][1] = -1;
  comb.check(problems);
  EXPECT_EQ(problems.size(), 1U);
}

}  // namespace
}  // namespace talus::scene_test
