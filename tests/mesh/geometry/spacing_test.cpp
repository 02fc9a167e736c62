// Disks around points: wide enough to close holes between neighbours, no wider, and voids stay open.
#include "mesh/geometry/spacing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace talus::spacing_test {

namespace {

std::vector<Real> lattice(int n, Real distance)
{
  std::vector<Real> x;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      x.insert(x.end(), {i * distance, j * distance, 0});
  return x;
}

bool is_covered(Real x, Real y, const std::vector<Real>& points, const std::vector<Real>& radii)
{
  for (std::size_t p = 0; p < radii.size(); ++p)
    if (std::hypot(points[3 * p] - x, points[3 * p + 1] - y) <= radii[p])
      return true;
  return false;
}

TEST(ClosingRadii, HolesBetweenNeighboursAreClosed)
{
  const std::vector<Real> points = lattice(8, 1);
  const std::vector<Real> radii = closing_radii(points, 0.6);  // the middle of each square is 0.707 away
  for (Real x = 0; x <= 7; x += 0.0371)
    for (Real y = 0; y <= 7; y += 0.0371)
      ASSERT_TRUE(is_covered(x, y, points, radii)) << x << " " << y;
  EXPECT_LT(*std::max_element(radii.begin(), radii.end()), 0.708 + 0.6 / 6);
}

TEST(ClosingRadii, HolesThatANarrowGapJoinsToTheOutsideAreClosed)
{
  std::vector<Real> points;  // clumps of four, 2 apart; those of neighbours are 1.4 apart at least
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      for (const auto& [dx, dy] : {std::pair{0.3, 0.0}, {0.0, 0.3}, {-0.3, 0.0}, {0.0, -0.3}})
        points.insert(points.end(), {2.0 * i + dx, 2.0 * j + dy, 0});
  for (const Real radius : {0.6, 0.69, 0.705, 0.75}) {  // gaps of 0.2 and 0.02, and disks that overlap by less than a place of the grid
    const std::vector<Real> radii = closing_radii(points, radius);
    for (Real x = 0; x <= 10; x += 0.0371)
      for (Real y = 0; y <= 10; y += 0.0371)
        ASSERT_TRUE(is_covered(x, y, points, radii)) << x << " " << y << " at a radius of " << radius;
    EXPECT_LT(*std::max_element(radii.begin(), radii.end()), 1.23 + radius / 6) << "the middle of a gap is 1.22 from the next point";
  }
  EXPECT_EQ(closing_radii(points, 0.5), std::vector<Real>(points.size() / 3, 0.5)) << "2.2 times this does not reach the middle";
}

TEST(ClosingRadii, TwoDisksThatOverlapAreNoHole)
{
  for (const Real apart : {1.5, 1.9, 1.99, 2.1, 3.5})
    for (const Real angle : {0.0, 0.3, 0.7854, 1.2})
      EXPECT_EQ(closing_radii(std::vector<Real>{0, 0, 0, apart * std::cos(angle), apart * std::sin(angle), 0}, 1), std::vector<Real>(2, 1))
          << apart << " apart, at an angle of " << angle;
}

TEST(ClosingRadii, DisksThatTouchStayAsTheyAreAndVoidsStayOpen)
{
  const std::vector<Real> dense = lattice(8, 1);
  EXPECT_EQ(closing_radii(dense, 0.8), std::vector<Real>(64, 0.8));
  std::vector<Real> ring;
  for (int k = 0; k < 24; ++k)
    ring.insert(ring.end(), {3 * std::cos(k * M_PI / 12), 3 * std::sin(k * M_PI / 12), 0});
  EXPECT_EQ(closing_radii(ring, 0.5), std::vector<Real>(24, 0.5)) << "its inside is five radii wide";
  EXPECT_EQ(closing_radii(lattice(2, 10), 0.5), std::vector<Real>(4, 0.5)) << "apart";
  EXPECT_TRUE(closing_radii({}, 1).empty());
}

TEST(ClosingRadii, HolesOfCoarseCellsAreClosedAndVoidsOfFineOnesStayOpen)
{
  std::vector<Real> points, areas;
  std::vector<std::int64_t> ids;
  const auto add = [&](Real x, Real y, Real area) {
    points.insert(points.end(), {x, y, 0});
    areas.push_back(area);
    ids.push_back(static_cast<std::int64_t>(100 + 2 * ids.size()));
  };
  for (int i = 0; i < 12; ++i)  // distances of 1, and a void 4 wide: they are the most
    for (int j = 0; j < 12; ++j)
      if (!(i > 3 && i < 7 && j > 3 && j < 7))
        add(i, j, 1);
  for (int i = 0; i < 5;
       ++i)  // and far from them distances of 3: the middle of each square is 2.12 away, which 2.2 times 0.85 does not reach
    for (int j = 0; j < 5; ++j)
      add(40 + 3 * i, 3 * j, 9);
  constexpr Real radius = 0.85;
  const std::vector<Real> radii = closing_radii(points, radius, Spread(ids, areas).of(ids));
  for (Real x = 40; x <= 52; x += 0.0971)
    for (Real y = 0; y <= 12; y += 0.0971)
      ASSERT_TRUE(is_covered(x, y, points, radii)) << x << " " << y;
  EXPECT_FALSE(is_covered(5, 5, points, radii));
  for (std::size_t p = 0; p < radii.size(); ++p)
    EXPECT_LE(radii[p], areas[p] > 1 ? 1.2 * 3 * radius : radius) << p;
  EXPECT_FALSE(is_covered(41.5, 1.5, points, closing_radii(points, radius)));
  EXPECT_EQ(closing_radii(points, radius, std::vector<Real>(ids.size(), 1)), closing_radii(points, radius)) << "no spread";
  EXPECT_EQ(closing_radii(points, radius, std::vector<Real>(ids.size(), 0.2)), closing_radii(points, radius)) << "radii never shrink";
}

TEST(Spread, IsTheRootOfTheAreaOverTheMedianAndOneForWhatWasNotThere)
{
  const Spread spread(std::vector<std::int64_t>{7, 3, 9, 4, 1}, std::vector<Real>{1, 4, 4, 36, 4});
  EXPECT_EQ(spread.of(std::vector<std::int64_t>{4, 2, 7, 3}), (std::vector<Real>{3, 1, 0.5, 1}));
  EXPECT_EQ(Spread().of(std::vector<std::int64_t>{4}), std::vector<Real>{1});
  EXPECT_EQ(Spread(std::vector<std::int64_t>{4}, {}).of(std::vector<std::int64_t>{4}), std::vector<Real>{1}) << "a file without volumes";
}

TEST(Spacing, IsThatOfALattice)
{
  std::vector<Real> places;
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 12; ++j)
      places.insert(places.end(), {0.25 * i, 0.25 * j, 0});
  EXPECT_NEAR(spacing_of(places, 2), 0.25, 1e-12);
  EXPECT_EQ(spacing_of({}, 3), 1);
  EXPECT_EQ(spacing_of(std::vector<Real>{1, 2, 3}, 3), 1);
  EXPECT_NEAR(spacing_of(std::vector<Real>{0, 0, 0, 0, 3, 4}, 3), 5, 1e-12) << "fewer than six neighbours";
}

}  // namespace

}  // namespace talus::spacing_test
