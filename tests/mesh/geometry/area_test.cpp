// Areas on a map: outlines that cross themselves, and outlines cut to a rectangle.
#include "mesh/geometry/area.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace talus::area_test {
namespace {

constexpr MapPlace low{0, 0}, high{10, 8};

/// Whether every place of a lattice inside the rectangle has the same answer for the ring and for its pieces put together.  A piece is closed
/// along the border, so it may have another inside: what counts is that both change at the same places along each row.
void expect_same_sides(const MapLine& ring)
{
  const auto changes = [](const Area& area, Real y) {
    std::vector<Real> x = crossings(area, {low[0], y}, {high[0], y});
    std::sort(x.begin(), x.end());
    return x;
  };
  const Area whole{{ring}}, cut{cut_to(ring, low, high)};
  for (const MapLine& line : cut.rings) {
    EXPECT_GE(line.size(), 3);
    EXPECT_FALSE(crossing_of(line)) << (*crossing_of(line))[0] << ", " << (*crossing_of(line))[1];
    for (const MapPlace& place : line) {
      EXPECT_GE(place[0], low[0]);
      EXPECT_LE(place[0], high[0]);
      EXPECT_GE(place[1], low[1]);
      EXPECT_LE(place[1], high[1]);
    }
  }
  for (int row = 0; row < 40; ++row) {
    const Real y = 0.1 + 0.195 * row;
    const auto before = changes(whole, y), after = changes(cut, y);
    ASSERT_EQ(before.size(), after.size()) << "y = " << y;
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_NEAR(before[i], after[i], 1e-9) << "y = " << y;
  }
}

TEST(CutTo, ARingInsideStaysAsItIs)
{
  const MapLine ring{{1, 1}, {5, 2}, {3, 7}};
  EXPECT_EQ(cut_to(ring, low, high), std::vector<MapLine>{ring});
}

TEST(CutTo, NothingIsLeftOfARingAroundTheRectangleOrBesideIt)
{
  EXPECT_TRUE(cut_to({{-1e6, -1e6}, {1e6, -1e6}, {1e6, 1e6}, {-1e6, 1e6}}, low, high).empty());
  EXPECT_TRUE(cut_to({{20, 1}, {30, 1}, {25, 6}}, low, high).empty());
  EXPECT_TRUE(cut_to({{-5, 5}, {4, 20}, {-20, 20}}, low, high).empty()) << "its box meets the rectangle, it does not";
}

TEST(CutTo, SidesInsideAreThoseOfTheRing)
{
  expect_same_sides({{-3, -3}, {5, -3}, {6, 4}, {-3, 5}});                          // one corner inside
  expect_same_sides({{-3, 3}, {13, 3}, {13, 6}, {-3, 6}});                          // two sides through it
  expect_same_sides({{5, 4}, {15, 3}, {15, 20}, {-4, 20}, {-4, 2}});                // in and out by several borders
  expect_same_sides({{-5, -5}, {2, 9}, {3, 9}, {4, -2}, {6, 9}, {8, 9}, {9, -5}});  // a comb: many pieces
  expect_same_sides({{-5, 4}, {5, -6}, {15, 4}, {5, 14}});                          // cuts the four corners off
}

TEST(CutTo, ManyCornersAroundTheBorder)
{
  MapLine ring;
  for (int i = 0; i < 400; ++i) {
    const Real angle = 2 * std::numbers::pi * i / 400, radius = 5 + 2.5 * std::sin(12 * angle);
    ring.push_back({5 + radius * std::cos(angle), 4 + radius * std::sin(angle)});
  }
  expect_same_sides(ring);
}

TEST(CutTo, CornersOnTheBorder)
{
  expect_same_sides({{10, 2}, {14, 5}, {10, 7}, {3, 4}});
  const MapLine touching{{10, 2}, {7, 7}, {3, 4}};
  EXPECT_EQ(cut_to(touching, low, high), std::vector<MapLine>{touching});
}

TEST(CrossingOf, IsFoundWhereverItIsAmongManySides)
{
  MapLine ring;
  for (int i = 0; i < 20000; ++i)
    ring.push_back({100 * std::cos(i * std::numbers::pi / 10000), 100 * std::sin(i * std::numbers::pi / 10000)});
  EXPECT_FALSE(crossing_of(ring));
  std::swap(ring[7000], ring[7001]);
  const auto place = crossing_of(ring);
  ASSERT_TRUE(place);
  EXPECT_NEAR((*place)[0], 100 * std::cos(0.70005 * std::numbers::pi), 0.1);
}

}  // namespace
}  // namespace talus::area_test
