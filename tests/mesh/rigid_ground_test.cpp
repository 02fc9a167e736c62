// What is ground in a mesh, counted by hand on a box whose groups have the names that terrain gives.
#include "mesh/rigid_ground.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "mesh/generate/generate.hpp"

namespace talus::rigid_ground_test {

namespace {

/// Facets of a box that lie in a plane across the last axis, between x = low and x = high.
template <int D>
std::vector<std::array<Index, D>> level_facets(const MeshData<D>& data, Real level, Real low, Real high)
{
  std::set<std::array<Index, D>> found;
  for (const auto& cell : data.cells)
    for (std::size_t left_out = 0; left_out <= D; ++left_out) {
      std::array<Index, D> facet{};
      for (std::size_t a = 0, k = 0; a <= D; ++a)
        if (a != left_out)
          facet[k++] = cell[a];
      std::sort(facet.begin(), facet.end());
      if (std::all_of(facet.begin(), facet.end(), [&](Index n) {
            const Vec<D>& x = data.nodes[static_cast<std::size_t>(n)];
            return x[D - 1] == level && x[0] >= low && x[0] <= high;
          }))
        found.insert(facet);
    }
  return {found.begin(), found.end()};
}

TEST(RigidGround, InSpaceItIsTheRigidSurfaceAndTheRimOfEachLayer)
{
  MeshData<3> data = box<3>({0, 0, 0}, {3, 2, 2}, {3, 2, 2});
  data.facet_sets["base"] = level_facets<3>(data, 0, 0, 3);
  EXPECT_FALSE(rigid_ground_of(data)) << "the group terrain is what tells a mesh of terrain";
  data.facet_sets["terrain"] = level_facets<3>(data, 1, 0, 3);
  data.facet_sets["layer:slide:bottom"] = level_facets<3>(data, 0, 0, 2);
  const auto ground = rigid_ground_of(data);
  ASSERT_TRUE(ground);
  EXPECT_EQ(ground->triangles.size(), 2u * 3 * 2);
  EXPECT_EQ(ground->layers.size(), 2u * (2 + 2)) << "around two by two squares";
  EXPECT_TRUE(ground->lines.empty());
  EXPECT_EQ(ground->nodes.size(), 3u * 4 * 3) << "the nodes of the floor alone";
  for (std::size_t n = 0; n < ground->nodes.size(); n += 3)
    EXPECT_EQ(ground->nodes[n + 2], 0);
  for (const Edge& edge : ground->layers)
    for (const Index n : edge)
      EXPECT_LE(ground->nodes[3 * static_cast<std::size_t>(n)], 2);
  data.facet_sets.erase("base");
  EXPECT_FALSE(rigid_ground_of(data)) << "nothing is rigid";
}

TEST(RigidGround, InThePlaneItIsTheRigidLineAndTheBottomsAboveIt)
{
  MeshData<2> data = box<2>({0, 0}, {4, 3}, {4, 3});
  data.facet_sets["base"] = level_facets<2>(data, 0, 0, 4);
  data.facet_sets["terrain"] = level_facets<2>(data, 2, 0, 4);
  data.facet_sets["layer:rock:bottom"] = data.facet_sets["base"];
  data.facet_sets["layer:soil:bottom"] = level_facets<2>(data, 1, 1, 3);
  data.facet_sets["obstacle:dam"] = level_facets<2>(data, 2, 3, 4);
  const auto ground = rigid_ground_of(data);
  ASSERT_TRUE(ground);
  EXPECT_EQ(ground->lines.size(), 4u + 1);
  EXPECT_EQ(ground->layers.size(), 2u) << "the bottom of the rock is the rigid line itself";
  EXPECT_TRUE(ground->triangles.empty());
}

}  // namespace

}  // namespace talus::rigid_ground_test
