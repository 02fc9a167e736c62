// Geometry of single simplices with numbers known by hand, and quality measures of known shapes.
#include "mesh/simplex.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mesh/generate/generate.hpp"
#include "mesh/quality.hpp"

namespace talus::simplex_test {
namespace {

const Real pi = std::acos(-1.0);

const Simplex<2> unit_triangle{Vec<2>(0, 0), Vec<2>(1, 0), Vec<2>(0, 1)};
const Simplex<3> unit_tetrahedron{Vec<3>(0, 0, 0), Vec<3>(1, 0, 0), Vec<3>(0, 1, 0), Vec<3>(0, 0, 1)};
const Simplex<2> regular_triangle{Vec<2>(0, 0), Vec<2>(2, 0), Vec<2>(1, std::sqrt(3.0))};
const Simplex<3> regular_tetrahedron{Vec<3>(1, 1, 1), Vec<3>(-1, 1, -1), Vec<3>(1, -1, -1), Vec<3>(-1, -1, 1)};

TEST(Simplex, VolumeAndOrientation)
{
  EXPECT_DOUBLE_EQ(signed_volume<2>(unit_triangle), 0.5);
  EXPECT_DOUBLE_EQ(signed_volume<3>(unit_tetrahedron), 1.0 / 6);
  EXPECT_DOUBLE_EQ(signed_volume<2>({unit_triangle[0], unit_triangle[2], unit_triangle[1]}), -0.5);
  EXPECT_DOUBLE_EQ(std::abs(signed_volume<3>(regular_tetrahedron)), 8.0 / 3);
}

TEST(Simplex, AltitudesOfUnitSimplices)
{
  EXPECT_THAT(altitudes<2>(unit_triangle), ::testing::Pointwise(::testing::DoubleNear(1e-15), {1 / std::sqrt(2.0), 1.0, 1.0}));
  EXPECT_THAT(altitudes<3>(unit_tetrahedron), ::testing::Pointwise(::testing::DoubleNear(1e-15), {1 / std::sqrt(3.0), 1.0, 1.0, 1.0}));
}

TEST(Simplex, AreaVectorsPointOutwardsAndSumToZero)
{
  Vec<2> plane = Vec<2>::Zero();
  Vec<3> solid = Vec<3>::Zero();
  for (int a = 0; a < 3; ++a)
    plane += area_vector(facet<2>(unit_triangle, a));
  for (int a = 0; a < 4; ++a)
    solid += area_vector(facet<3>(unit_tetrahedron, a));
  EXPECT_EQ(area_vector(facet<2>(unit_triangle, 0)), Vec<2>(1, 1));
  EXPECT_EQ(area_vector(facet<3>(unit_tetrahedron, 0)), Vec<3>(0.5, 0.5, 0.5));
  EXPECT_EQ(area_vector(facet<3>(unit_tetrahedron, 3)), Vec<3>(0, 0, -0.5));
  EXPECT_EQ(plane, Vec<2>(0, 0));
  EXPECT_EQ(solid, Vec<3>(0, 0, 0));
}

TEST(Simplex, BarycentricCoordinatesInvertThePoint)
{
  const std::array<Real, 4> lambda{0.1, 0.2, 0.3, 0.4};
  const Simplex<3> far{Vec<3>(1e4, 0, 0), Vec<3>(1e4 + 1, 0, 0), Vec<3>(1e4, 2, 0), Vec<3>(1e4, 1, 3)};
  const auto found = barycentric<3>(far, point<3>(far, lambda));
  for (int a = 0; a < 4; ++a)
    EXPECT_NEAR(found[a], lambda[a], 1e-11);  // round-off of a coordinate of 1e4 in a cell of 1
}

TEST(Simplex, ClosestPointInEveryRegionOfATriangle)
{
  const std::array<Vec<3>, 3> t{Vec<3>(0, 0, 0), Vec<3>(2, 0, 0), Vec<3>(0, 2, 0)};
  EXPECT_EQ(closest_point(t, {-1, -1, 1}), Vec<3>(0, 0, 0));
  EXPECT_EQ(closest_point(t, {4, -1, 1}), Vec<3>(2, 0, 0));
  EXPECT_EQ(closest_point(t, {-1, 5, 1}), Vec<3>(0, 2, 0));
  EXPECT_EQ(closest_point(t, {1, -3, 1}), Vec<3>(1, 0, 0));
  EXPECT_EQ(closest_point(t, {-3, 1, 1}), Vec<3>(0, 1, 0));
  EXPECT_EQ(closest_point(t, {2, 2, -1}), Vec<3>(1, 1, 0));
  EXPECT_EQ(closest_point(t, {0.5, 0.5, 7}), Vec<3>(0.5, 0.5, 0));
}

TEST(Quality, RegularSimplicesHaveMeanRatioOne)
{
  EXPECT_NEAR(mean_ratio<2>(regular_triangle), 1, 1e-14);
  EXPECT_NEAR(mean_ratio<3>(regular_tetrahedron), 1, 1e-14);
  EXPECT_NEAR(mean_ratio<2>(unit_triangle), std::sqrt(3.0) / 2, 1e-14);
  EXPECT_NEAR(mean_ratio<3>(unit_tetrahedron), 12 * std::pow(0.5, 2.0 / 3) / 9, 1e-14);
}

TEST(Quality, SmallestAnglesOfKnownShapes)
{
  EXPECT_NEAR(smallest_angle<2>(regular_triangle), pi / 3, 1e-14);
  EXPECT_NEAR(smallest_angle<2>(unit_triangle), pi / 4, 1e-14);
  EXPECT_NEAR(smallest_angle<3>(regular_tetrahedron), std::acos(1.0 / 3), 1e-14);
  EXPECT_NEAR(smallest_angle<3>(unit_tetrahedron), std::acos(1 / std::sqrt(3.0)), 1e-14);
  const Real tiny = 1e-9;
  EXPECT_NEAR(smallest_angle<2>({Vec<2>(0, 0), Vec<2>(2, 0), Vec<2>(1, tiny)}), tiny, 1e-6 * tiny);
}

TEST(Quality, StatisticsOfAnUnevenBox)
{
  // Two columns of squares, one metre and three metres wide, cut into triangles.
  MeshData<2> data = box<2>({0, 0}, {2, 1}, {2, 1});
  for (auto& x : data.nodes)
    if (x[0] == 2)
      x[0] = 4;
  const auto q = quality(Mesh<2>(data));
  EXPECT_EQ(q.nodes, 6);
  EXPECT_EQ(q.cells, 4);
  EXPECT_EQ(q.boundary_facets, 6);
  EXPECT_DOUBLE_EQ(q.volume, 4);
  EXPECT_DOUBLE_EQ(q.smallest_volume, 0.5);
  EXPECT_DOUBLE_EQ(q.largest_volume, 1.5);
  EXPECT_NEAR(q.smallest_mean_ratio, 4 * std::sqrt(3.0) * 1.5 / 20, 1e-14);
  EXPECT_NEAR(q.average_mean_ratio, (std::sqrt(3.0) / 2 + 0.3 * std::sqrt(3.0)) / 2, 1e-14);
  EXPECT_NEAR(q.smallest_angle, std::atan(1.0 / 3), 1e-14);
  EXPECT_NEAR(q.smallest_altitude, 1 / std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(q.median_altitude, 3 / std::sqrt(10.0), 1e-14);
  EXPECT_DOUBLE_EQ(q.shortest_edge, 1);
  EXPECT_DOUBLE_EQ(q.longest_edge, std::sqrt(10.0));
  EXPECT_NEAR(q.gradation, std::sqrt(3.0), 1e-14);
  EXPECT_EQ(q.largest_ring, 5);
  EXPECT_GT(q.worst_place[0], 1);
}

TEST(Quality, TextNamesTheWorstPlace)
{
  MeshData<3> data;
  data.nodes.assign(unit_tetrahedron.begin(), unit_tetrahedron.end());
  data.cells = {{0, 1, 2, 3}};
  EXPECT_EQ(to_string(quality(Mesh<3>(data))),
            "4 nodes, 1 tetrahedra, 4 boundary facets\n"
            "volume 0.166667 m^3, of one cell 0.1667 to 0.1667\n"
            "edges 1 to 1.414 m; altitude 0.5774 m at least, 0.5774 m in the median\n"
            "smallest dihedral angle 54.7 degrees; mean ratio 0.84 at least, 0.84 on average (1: regular)\n"
            "sizes of neighbours differ by a factor of 1 at most; up to 4 nodes in a ring\n"
            "worst cell at (0.25, 0.25, 0.25)\n");
}

}  // namespace
}  // namespace talus::simplex_test
