// Meshes with nodes doubled along facets inside them.
#include <gmock/gmock.h>

#include "mesh/digest.hpp"
#include "mesh/locate.hpp"
#include "mesh/part.hpp"
#include "mesh/partition.hpp"
#include "tests/mesh/cut_box.hpp"

namespace talus::cuts_test {
namespace {

using testing::HasSubstr;

template <class M>
class Cuts : public testing::Test {};
using Dimensions = testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(Cuts, Dimensions);

template <int D>
Vec<D> middle(const Mesh<D>& mesh, Index cell)
{
  return centroid<D>(mesh.corners(cell));
}

TYPED_TEST(Cuts, NodesAreDoubledExceptAtTips)
{
  constexpr int D = TypeParam::value;
  const Index n = 6;
  const Mesh<D> uncut(cut_box<D>(n, 0.5, 0.2)), mesh = cut_along(cut_box<D>(n, 0.5, 0.2));
  const Index across = D == 2 ? 1 : n + 1;
  EXPECT_EQ(mesh.cuts().pairs.size(), static_cast<std::size_t>(3 * across));
  EXPECT_EQ(mesh.cuts().tips.size(), static_cast<std::size_t>(across));
  EXPECT_EQ(mesh.n_nodes(), uncut.n_nodes() + 3 * across);
  Real area = 0;
  for (const NodePair<D>& pair : mesh.cuts().pairs) {
    EXPECT_EQ(mesh.node(pair.first), mesh.node(pair.second));
    EXPECT_NEAR(pair.area[D - 1], pair.measure, 1e-12);
    EXPECT_GT(pair.measure, 0);
    area += pair.measure;
    for (const Index c : mesh.cells_of_node()[pair.first])
      EXPECT_LT(middle(mesh, c)[D - 1], 0.5);
    for (const Index c : mesh.cells_of_node()[pair.second])
      EXPECT_GT(middle(mesh, c)[D - 1], 0.5);
    for (const Index m : mesh.ring_of_node()[pair.first])
      EXPECT_LE(mesh.node(m)[D - 1], 0.5);
    for (const Index m : mesh.ring_of_node()[pair.second])
      EXPECT_GE(mesh.node(m)[D - 1], 0.5);
  }
  EXPECT_GT(area, 0.3);
  EXPECT_LT(area, 0.5);
}

TYPED_TEST(Cuts, CellsStayNeighboursAndPointsAreFoundAsBefore)
{
  constexpr int D = TypeParam::value;
  const Mesh<D> uncut(cut_box<D>(6, 0.7, 0.2)), mesh = cut_along(cut_box<D>(6, 0.7, 0.2));
  ASSERT_EQ(mesh.n_cells(), uncut.n_cells());
  const Locator<D> locate(mesh), locate_uncut(uncut);
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    EXPECT_EQ(mesh.neighbours(c), uncut.neighbours(c));
    EXPECT_EQ(mesh.corners(c), uncut.corners(c));
    EXPECT_EQ(mesh.volume(c), uncut.volume(c));
  }
  EXPECT_EQ(mesh.boundary_facets().size(), uncut.boundary_facets().size());
  for (Real x = 0.05; x < 1; x += 0.05) {
    Vec<D> at = Vec<D>::Constant(0.5);
    at[0] = x;
    EXPECT_EQ(locate(mesh, at, 0), locate_uncut(uncut, at, none));
  }
}

TYPED_TEST(Cuts, NodesAreNumberedByTheFirstCellThatUsesThem)
{
  constexpr int D = TypeParam::value;
  const Mesh<D> mesh = cut_along(cut_box<D>(6, 0.5));
  Index next = 0;
  for (const auto& cell : mesh.cells())
    for (const Index n : cell) {
      EXPECT_LE(n, next);
      next += n == next ? 1 : 0;
    }
  EXPECT_EQ(next, mesh.n_nodes());
}

TYPED_TEST(Cuts, ACutThroughTheWholeMeshPartsItInTwo)
{
  constexpr int D = TypeParam::value;
  const Mesh<D> mesh = cut_along(cut_box<D>(4, 1));
  EXPECT_TRUE(mesh.cuts().tips.empty());
  Real area = 0;
  for (const NodePair<D>& pair : mesh.cuts().pairs) {
    area += pair.measure;
    if (mesh.node(pair.first)[0] == 0) {
      EXPECT_TRUE(mesh.on_boundary(pair.first) && mesh.on_boundary(pair.second));
    }
  }
  EXPECT_NEAR(area, 1, 1e-12);
  for (const auto& cell : mesh.cells()) {
    const auto above = std::ranges::count_if(cell, [&](Index n) { return mesh.node(n)[D - 1] > 0.5; });
    for (const Index n : cell)
      if (const auto pair = std::ranges::find(mesh.cuts().pairs, n, above > 0 ? &NodePair<D>::first : &NodePair<D>::second);
          pair != mesh.cuts().pairs.end())
        ADD_FAILURE() << "node " << n << " belongs to both sides";
  }
}

TYPED_TEST(Cuts, GroupsKnowBothSides)
{
  constexpr int D = TypeParam::value;
  const Mesh<D> uncut(cut_box<D>(4, 1)), mesh = cut_along(cut_box<D>(4, 1));
  EXPECT_EQ(mesh.node_set("cut")->size(), 2 * uncut.node_set("cut")->size());
  EXPECT_EQ(*mesh.facet_set("cut"), *uncut.facet_set("cut"));
  EXPECT_EQ(mesh.both_sides_of_cuts(*mesh.facet_set("cut")).size(), 2 * mesh.facet_set("cut")->size());
  EXPECT_EQ(uncut.both_sides_of_cuts(*mesh.facet_set("cut")).size(), mesh.facet_set("cut")->size());
  EXPECT_NE(digest(mesh), digest(uncut));
}

TYPED_TEST(Cuts, TheFirstSideOfAClosedCutIsTheInside)
{
  constexpr int D = TypeParam::value;
  MeshData<D> data = cut_box<D>(8, 1);
  for (const Index axis : {0, 1, 2})
    for (const Real end : {0.25, 0.75})
      if (axis < D) {
        add_facets<D>(data, "face",
                      [&](const Vec<D>& x) { return std::abs(x[axis] - end) < 1e-9 && (x.array() - 0.5).abs().maxCoeff() < 0.2501; });
        data.facet_sets["hull"].insert(data.facet_sets["hull"].end(), data.facet_sets["face"].begin(), data.facet_sets["face"].end());
      }
  const Mesh<D> mesh = cut_along(data, {"hull"});
  EXPECT_TRUE(mesh.cuts().tips.empty());
  for (const NodePair<D>& pair : mesh.cuts().pairs) {
    EXPECT_GT(pair.area.dot(mesh.node(pair.first) - Vec<D>::Constant(0.5)), 0);
    for (const Index c : mesh.cells_of_node()[pair.first])
      EXPECT_LT((middle(mesh, c).array() - 0.5).abs().maxCoeff(), 0.25);
  }
}

/// The message about a cut, and its number.
template <int D>
std::pair<std::size_t, std::string> refusal(const MeshData<D>& data, const std::vector<std::string>& groups)
{
  try {
    cut_along(data, groups);
  } catch (const CutError& error) {
    return {error.cut, error.what()};
  }
  return {0, "not refused"};
}

TYPED_TEST(Cuts, WhatIsNoCutIsRefused)
{
  constexpr int D = TypeParam::value;
  MeshData<D> data = cut_box<D>(4, 1);
  add_facets<D>(data, "upright", [](const Vec<D>& x) { return std::abs(x[0] - 0.5) < 1e-9; });
  add_facets<D>(data, "above", [](const Vec<D>& x) { return std::abs(x[0] - 0.5) < 1e-9 && x[D - 1] > 0.5 - 1e-9; });
  add_facets<D>(data, "floor", [](const Vec<D>& x) { return x[D - 1] < 1e-9; });
  add_facets<D>(data, "small", [](const Vec<D>& x) { return std::abs(x[D - 1] - 0.5) < 1e-9 && (x.array() - 0.4).abs().maxCoeff() < 0.2; });
  EXPECT_THAT(refusal(data, {"cut", "floor"}).second, HasSubstr("lie on the boundary of the mesh"));
  EXPECT_EQ(refusal(data, {"cut", "floor"}).first, 1U);
  EXPECT_THAT(refusal(data, {"cut", "upright"}).second, HasSubstr("leave 4 sides"));
  EXPECT_THAT(refusal(data, {"cut", "above"}).second, HasSubstr("leave 3 sides"));
  EXPECT_THAT(refusal(data, {"upright", "above"}).second, HasSubstr("have facets in common"));
  EXPECT_THAT(refusal(data, {"small"}).second, HasSubstr("doubles no node"));
}

TYPED_TEST(Cuts, PartsHaveBothNodesOfAPairAndTheCellsAround)
{
  constexpr int D = TypeParam::value;
  const Mesh<D> mesh = cut_along(cut_box<D>(D == 2 ? 24 : 12, 0.8, 0.2));
  const int ranks = 4;
  const auto rank_of_block = partition<D>(mesh, std::vector<std::int64_t>(static_cast<std::size_t>(blocks_of(mesh.n_cells())), 100), ranks);
  const Locator<D> locate_in_whole(mesh);
  int shared = 0;
  for (int rank = 0; rank < ranks; ++rank) {
    const Part<D> part = cut<D>(mesh, rank_of_block, rank, 2);
    const auto distance = rings_from_own(part);
    const Locator<D> locate(part.mesh);
    for (const NodePair<D>& pair : mesh.cuts().pairs) {
      const Index first = part.subdomain.local_node(pair.first), second = part.subdomain.local_node(pair.second);
      if ((first == none || !part.subdomain.owns_node(first)) && (second == none || !part.subdomain.owns_node(second)))
        continue;
      ASSERT_TRUE(first != none && second != none);
      shared += part.subdomain.owns_node(first) != part.subdomain.owns_node(second) ? 1 : 0;
      EXPECT_EQ(distance[static_cast<std::size_t>(first)], distance[static_cast<std::size_t>(second)]);
      EXPECT_TRUE(part.mesh.is_whole(first) && part.mesh.is_whole(second));
      for (const Index c : mesh.cells_of_node()[pair.second])
        EXPECT_EQ(part.subdomain.whole_cell(locate(part.mesh, middle(mesh, c), none).value()), c);
    }
    for (const Facet f : part.mesh.cuts().facets)
      EXPECT_TRUE(std::ranges::binary_search(mesh.cuts().facets, Facet{part.subdomain.whole_cell(f.cell), f.local},
                                             [](Facet a, Facet b) { return std::tie(a.cell, a.local) < std::tie(b.cell, b.local); }));
  }
  EXPECT_GT(shared, 0) << "no pair has two owners: the test shows nothing";
}

}  // namespace
}  // namespace talus::cuts_test
