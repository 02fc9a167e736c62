// Distances to surfaces of facets, and what they enclose.
#include "mesh/geometry/facet_surface.hpp"

#include <gmock/gmock.h>

namespace talus::facet_surface_test {
namespace {

using ::testing::HasSubstr;

FacetSurface<2> rectangle(Real width, Real height)
{
  return {{{0, 0}, {width, 0}, {width, height}, {0, height}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
}

/// A box of these edges, with every triangle of corners of its own, as in an STL file.
FacetSurface<3>::Corners box_corners(const Vec3& size, std::vector<std::array<Index, 3>>& triangles)
{
  FacetSurface<3>::Corners corners;
  for (Index axis = 0; axis < 3; ++axis)
    for (const Real side : {0.0, 1.0}) {
      const Index u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto corner = [&](Real a, Real b) {
        Vec3 x = Vec3::Zero();
        x[axis] = side * size[axis], x[u] = a * size[u], x[v] = b * size[v];
        return x;
      };
      std::vector<Vec3> around{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
      if (side == 0)
        std::ranges::reverse(around);
      for (const std::array<std::size_t, 3> triangle : {std::array<std::size_t, 3>{0, 1, 2}, {0, 2, 3}}) {
        const auto first = static_cast<Index>(corners.size());
        for (const std::size_t c : triangle)
          corners.push_back(around[c]);
        triangles.push_back({first, first + 1, first + 2});
      }
    }
  return corners;
}
FacetSurface<3> box(const Vec3& size)
{
  std::vector<std::array<Index, 3>> triangles;
  auto corners = box_corners(size, triangles);
  return {std::move(corners), std::move(triangles)};
}

TEST(SurfaceOfSegments, DistancesAreThoseOfARectangle)
{
  const FacetSurface<2> surface = rectangle(2, 1);
  EXPECT_EQ(surface.fault(), "");
  const auto expect = [&](const Vec<2>& x, Real distance, const Vec<2>& normal) {
    const auto found = surface.distance(x);
    EXPECT_NEAR(found.distance, distance, 1e-14) << x.transpose();
    EXPECT_LT((found.normal - normal).norm(), 1e-12) << x.transpose() << ": " << found.normal.transpose();
  };
  expect({1, 1.5}, 0.5, {0, 1});
  expect({0.2, 0.5}, -0.2, {-1, 0});
  expect({1, 0.9}, -0.1, {0, 1});
  expect({2 + 3, 1 + 4}, 5, {0.6, 0.8});
  expect({-0.3, 0.5}, 0.3, {-1, 0});
  expect({1, 0}, 0, {0, -1});
  expect({1e-6, 1e-14}, -1e-14, {0, -1});  // not the direction of round-off
}

TEST(SurfaceOfSegments, EnclosesAreaCentreAndInertia)
{
  const auto solid = rectangle(2, 1).solid();
  EXPECT_NEAR(solid.volume, 2, 1e-14);
  EXPECT_LT((solid.centre - Vec<2>(1, 0.5)).norm(), 1e-14);
  EXPECT_NEAR(solid.inertia(2, 2), 2 * (4 + 1) / 12.0, 1e-14);
}

TEST(SurfaceOfTriangles, DistancesAndInertiaAreThoseOfABox)
{
  const Vec3 size(3, 2, 1);
  const FacetSurface<3> surface = box(size);
  EXPECT_EQ(surface.fault(), "");
  EXPECT_EQ(surface.corners().size(), 8u) << "corners at one place are one";
  const auto solid = surface.solid();
  EXPECT_NEAR(solid.volume, 6, 1e-13);
  EXPECT_LT((solid.centre - size / 2).norm(), 1e-13);
  EXPECT_NEAR(solid.inertia(0, 0), 6 * (4 + 1) / 12.0, 1e-12);
  EXPECT_NEAR(solid.inertia(1, 1), 6 * (9 + 1) / 12.0, 1e-12);
  EXPECT_NEAR(solid.inertia(2, 2), 6 * (9 + 4) / 12.0, 1e-12);
  EXPECT_NEAR(solid.inertia(0, 1), 0, 1e-12);
  // Against the closed form, on a grid of points that has none on the surface.
  for (Real x = -0.95; x < 4; x += 0.7)
    for (Real y = -0.95; y < 3; y += 0.6)
      for (Real z = -0.95; z < 2; z += 0.35) {
        const Vec3 at(x, y, z), centred = (at - size / 2).cwiseAbs() - size / 2;
        const Real exact = centred.cwiseMax(0).norm() + std::min(centred.maxCoeff(), Real{0});
        EXPECT_NEAR(surface.distance(at).distance, exact, 1e-13) << at.transpose();
      }
}

// A nearest point at a corner with unequal facets: the sign from a single facet, or from the plain mean of normals, would be wrong.
TEST(SurfaceOfTriangles, TheSideIsRightBehindSharpCorners)
{
  const FacetSurface<3> spike({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.05, 0.05, 5}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  ASSERT_EQ(spike.fault(), "");
  EXPECT_GT(spike.distance({0.05, 0.05, 5.5}).distance, 0);
  EXPECT_GT(spike.distance({-0.5, 0.3, 5.2}).distance, 0);
  EXPECT_GT(spike.distance({2, -0.1, -0.1}).distance, 0);
  EXPECT_LT(spike.distance({0.06, 0.06, 4.5}).distance, 0);
}

TEST(SurfaceOfTriangles, ThatIsOpenOrInsideOutIsAFault)
{
  std::vector<std::array<Index, 3>> triangles;
  auto corners = box_corners({1, 1, 1}, triangles);
  std::vector<std::array<Index, 3>> open(triangles.begin(), triangles.end() - 1), turned = triangles, one_turned = triangles;
  EXPECT_THAT(FacetSurface<3>(corners, open).fault(), HasSubstr("open"));
  for (auto& triangle : turned)
    std::swap(triangle[0], triangle[1]);
  EXPECT_THAT(FacetSurface<3>(corners, turned).fault(), HasSubstr("inside out"));
  std::swap(one_turned[3][0], one_turned[3][1]);
  EXPECT_THAT(FacetSurface<3>(corners, one_turned).fault(), HasSubstr("do not all show the same side"));
}

TEST(SurfaceOfTriangles, OfASheetKnowsItsRim)
{
  const std::vector<Vec3> corners{{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}};
  const FacetSurface<3> sheet(corners, {{0, 1, 2}, {0, 2, 3}});
  EXPECT_EQ(sheet.fault_of_sheet(), "");
  EXPECT_NEAR(sheet.sheet().volume, 6, 1e-13);
  EXPECT_LT((sheet.sheet().centre - Vec3(1.5, 1, 0)).norm(), 1e-13);
  EXPECT_NEAR(sheet.sheet().inertia(0, 0), 6 * 4 / 12.0, 1e-12);
  EXPECT_NEAR(sheet.sheet().inertia(2, 2), 6 * (9 + 4) / 12.0, 1e-12);
  const auto over_diagonal = sheet.distance({1.5, 1, -0.3}), beyond = sheet.distance({-0.4, 1, -0.3}), corner = sheet.distance({4, 3, 1});
  EXPECT_FALSE(over_diagonal.on_rim) << "an edge of two facets";
  EXPECT_NEAR(over_diagonal.distance, -0.3, 1e-13);
  EXPECT_TRUE(beyond.on_rim);
  EXPECT_NEAR(beyond.distance, -0.5, 1e-13);
  EXPECT_LT((beyond.rim_normal - Vec3(0, 0, 1)).norm(), 1e-15);
  EXPECT_EQ(over_diagonal.rim_normal, (Vec3(Vec3::Zero())));
  EXPECT_TRUE(corner.on_rim);
  EXPECT_GT(corner.distance, 0);

  EXPECT_THAT(FacetSurface<3>(corners, {{0, 1, 2}, {0, 3, 2}}).fault_of_sheet(), HasSubstr("show different sides"));
  std::vector<Vec3> three = corners;
  three.push_back({1, 1, 1});
  EXPECT_THAT(FacetSurface<3>(three, {{0, 1, 2}, {0, 2, 3}, {0, 2, 4}}).fault_of_sheet(), HasSubstr("branches"));
  EXPECT_THAT(box({1, 1, 1}).fault_of_sheet(), HasSubstr("closed"));
}

TEST(SurfaceOfSegments, OfASheetKnowsItsRim)
{
  const FacetSurface<2> line({{0, 0}, {2, 0}, {2, 1}}, {{0, 1}, {1, 2}});
  EXPECT_EQ(line.fault_of_sheet(), "");
  EXPECT_NEAR(line.sheet().volume, 3, 1e-13);
  EXPECT_LT((line.sheet().centre - Vec<2>(4.0 / 3, 1.0 / 6)).norm(), 1e-13);
  EXPECT_FALSE(line.distance({2.1, -0.1}).on_rim) << "the corner is within";
  EXPECT_TRUE(line.distance({-0.1, 0.1}).on_rim);
  EXPECT_LT(line.distance({-0.1, 0.1}).distance, 0) << "left of the way is behind";
}

// Second moments about the origin are 1e12 times those about the centre there.
TEST(SurfaceOfTriangles, OfASheetFarFromTheOriginHasTheSameInertia)
{
  const Vec3 far(1e6, 2e6, -1e6);
  const std::vector<Vec3> corners{far, far + Vec3(3, 0, 0), far + Vec3(3, 2, 0), far + Vec3(0, 2, 0)};
  const auto sheet = FacetSurface<3>(corners, {{0, 1, 2}, {0, 2, 3}}).sheet();
  EXPECT_LT((sheet.centre - far - Vec3(1.5, 1, 0)).norm(), 1e-9);
  EXPECT_NEAR(sheet.inertia(0, 0), 6 * 4 / 12.0, 1e-8);
  EXPECT_NEAR(sheet.inertia(1, 1), 6 * 9 / 12.0, 1e-8);
  EXPECT_NEAR(sheet.inertia(2, 2), 6 * (9 + 4) / 12.0, 1e-8);
}

TEST(SurfaceOfTriangles, TrianglesWithTwoCornersAtOnePlaceAreLeftOut)
{
  std::vector<std::array<Index, 3>> triangles;
  auto corners = box_corners({3, 2, 1}, triangles);
  const auto whole = triangles.size();
  const auto one = triangles.front();
  triangles.push_back({one[0], one[0], one[1]});
  corners.push_back(corners[static_cast<std::size_t>(one[2])]);  // another number for the same place
  triangles.push_back({one[2], one[1], static_cast<Index>(corners.size() - 1)});
  const FacetSurface<3> surface(corners, triangles);
  EXPECT_EQ(surface.facets().size(), whole);
  EXPECT_EQ(surface.fault(), "");
  EXPECT_NEAR(surface.solid().volume, 6, 1e-13);
}

TEST(SurfaceOfTriangles, SamplesAreNowhereFartherApartThanAsked)
{
  const FacetSurface<3> surface = box({1, 1, 1});
  const auto samples = surface.samples(0.25);
  for (const Vec3& sample : samples)
    EXPECT_NEAR(surface.distance(sample).distance, 0, 1e-12);
  for (const Vec3& sample : samples) {
    Real nearest = 1;
    for (const Vec3& other : samples)
      if (const Real apart = (other - sample).norm(); apart > 0)
        nearest = std::min(nearest, apart);
    EXPECT_LE(nearest, 0.25);
  }
}

}  // namespace
}  // namespace talus::facet_surface_test
