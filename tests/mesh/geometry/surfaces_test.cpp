// Surfaces over the plan: rasters, triangles in space, the ground of a mesh; values worked out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mesh/generate/generate.hpp"
#include "mesh/geometry/raster_surface.hpp"
#include "mesh/geometry/triangle_surface.hpp"
#include "mesh/ground.hpp"

namespace talus::surfaces_test {
namespace {

constexpr Real nothing = std::numeric_limits<Real>::quiet_NaN();

/// f at the centres of cells of 2 m by 3 m whose lower left corner is at (10, 20).
template <class F>
Raster raster_of(Index columns, Index rows, F&& f)
{
  Raster r;
  r.west = 10, r.south = 20, r.dx = 2, r.dy = 3, r.columns = columns, r.rows = rows;
  r.values.resize(static_cast<std::size_t>(columns * rows));
  for (Index row = 0; row < rows; ++row)
    for (Index column = 0; column < columns; ++column)
      r.at(column, row) = f(static_cast<Real>(column), static_cast<Real>(row));
  return r;
}

TEST(RasterSurface, IsBilinearAndGoesOnStraightToTheRim)
{
  const auto product = [](Real x, Real y) { return 1 + 2 * x - y + 0.5 * x * y; };
  const Surface surface = surface_of(raster_of(4, 3, product));
  for (const Real x : {-0.5, 0.0, 0.3, 1.0, 2.6, 3.5})  // in columns from the first centre
    for (const Real y : {-0.5, 0.0, 0.7, 2.0, 2.5})
      EXPECT_NEAR(surface({11 + 2 * x, 21.5 + 3 * y}), product(x, y), 1e-12) << x << " " << y;
}

TEST(RasterSurface, IsUnknownOutsideAndBesideCellsWithoutAValue)
{
  const Raster whole = raster_of(3, 3, [](Real x, Real) { return x; });
  EXPECT_TRUE(std::isnan(surface_of(whole)({9.9, 25})));
  EXPECT_TRUE(std::isnan(surface_of(whole)({12, 29.1})));
  const MapBox box = extent_of(whole);
  EXPECT_EQ(box.east, 16);
  EXPECT_EQ(box.north, 29);
  EXPECT_NEAR(surface_of(whole)({box.east, box.north}), 2.5, 1e-12);
  Raster holed = whole;
  holed.at(1, 1) = nothing;
  const Surface surface = surface_of(holed);
  EXPECT_TRUE(std::isnan(surface({13.1, 24.5})));
  EXPECT_EQ(surface({11, 24.5}), 0) << "a neighbour without weight may be unknown";
}

TEST(RasterSurface, HolesAreFilledByAStretchedMembrane)
{
  const auto harmonic = [](Real x, Real y) { return x * x - y * y + 3 * x; };  // the mean of its four neighbours everywhere
  Raster r = raster_of(9, 8, harmonic);
  r.at(2, 2) = r.at(3, 3) = r.at(3, 4) = nothing;  // joined by a corner
  r.at(6, 5) = nothing;
  r.at(0, 7) = nothing;  // at the edge: nothing is known on the other side
  const auto holes = fill_holes(2, r);
  ASSERT_EQ(holes.size(), 2U);
  EXPECT_EQ(holes[0].cells, 3);
  EXPECT_EQ(holes[0].across, 3);
  EXPECT_FALSE(holes[0].filled);
  EXPECT_EQ(holes[0].extent.west, 14);
  EXPECT_EQ(holes[0].extent.east, 18);
  EXPECT_EQ(holes[0].extent.south, 26);
  EXPECT_EQ(holes[0].extent.north, 35);
  EXPECT_TRUE(std::isnan(r.at(3, 3)));
  EXPECT_TRUE(holes[1].filled);
  EXPECT_NEAR(r.at(6, 5), harmonic(6, 5), 1e-9);
  EXPECT_TRUE(std::isnan(r.at(0, 7)));
  EXPECT_EQ(fill_holes(3, r).size(), 1U);
  for (const auto& [column, row] : {std::pair(2, 2), std::pair(3, 3), std::pair(3, 4)})
    EXPECT_NEAR(r.at(column, row), harmonic(column, row), 1e-6);
}

TEST(TriangleSurface, IsTheHighestOfTheTrianglesThere)
{
  const TriangleSheet sheet{
      {{0, 0, 1}, {4, 0, 5}, {0, 4, 1}, {4, 4, 5}, {0, 0, 3}, {2, 0, 3}, {0, 2, 3}, {1, 3, -9}, {3, 1, 99}, {2, 2, 50}},
      {{0, 1, 2}, {3, 2, 1}, {4, 6, 5}, {7, 8, 9}}};  // the plane 1 + x, 3 over a corner of it, an upright one
  const Surface surface = surface_of(sheet);
  EXPECT_NEAR(surface({0.5, 0.5}), 3, 1e-12);
  EXPECT_NEAR(surface({1.5, 2.0}), 2.5, 1e-12);
  EXPECT_NEAR(surface({2, 2}), 3, 1e-12) << "on the common edge; the upright triangle counts for nothing";
  EXPECT_NEAR(surface({4, 4}), 5, 1e-12);
  EXPECT_TRUE(std::isnan(surface({4.1, 2})));
  EXPECT_TRUE(std::isnan(surface({2, -0.1})));
  EXPECT_TRUE(std::isnan(surface_of(TriangleSheet{})({0, 0})));
}

/// A box of 4 m by 2 m (by 2 m) of cubes cut in simplices; what is below 1 m is held for x < 2, with a roof of all between 2 m and 3 m for x < 1.
template <int D>
struct Block {
  Mesh<D> mesh{[] {
    if constexpr (D == 2)
      return box<2>({0, 0}, {4, 4}, {4, 4});
    else
      return box<3>({0, 0, 0}, {4, 2, 4}, {4, 2, 4});
  }()};
  bool holds(Index c) const
  {
    Vec<D> middle = Vec<D>::Zero();
    for (const Index n : mesh.cell(c))
      middle += mesh.node(n) / (D + 1);
    return (middle[D - 1] < 1 && middle[0] < 2) || (middle[D - 1] > 2 && middle[D - 1] < 3 && middle[0] < 1);
  }
  Ground<D> ground{mesh, [this](Index c) { return holds(c); }};
};

template <int D>
void look_at_ground()
{
  const Block<D> block;
  const Real wide = D == 2 ? 1 : 2;
  EXPECT_NEAR(block.ground({0.4, 0.7}), 3, 1e-12) << "the roof";
  EXPECT_NEAR(block.ground({1.3, 0.7}), 1, 1e-12);
  EXPECT_NEAR(block.ground({3.2, 0.7}), 0, 1e-12) << "nothing is held: the lowest side of the mesh";
  EXPECT_NEAR(block.ground({-5, 0.7}), 0, 1e-12) << "beside the mesh";
  Real area = 0;
  for (const auto& piece : block.ground.pieces()) {
    area += piece.area;
    for (const Vec<D>& corner : piece.corners)
      EXPECT_NEAR(corner[D - 1], corner[0] < 1 || piece.corners[0][D - 1] > 2 ? 3 : 1, 1e-12) << "below the roof nothing is seen";
  }
  EXPECT_NEAR(area, 2 * wide, 1e-12);
}

TEST(Ground, IsTheUpperSideOfWhatIsHeldInThePlane) { look_at_ground<2>(); }
TEST(Ground, IsTheUpperSideOfWhatIsHeldInSpace) { look_at_ground<3>(); }

}  // namespace
}  // namespace talus::surfaces_test
