// Cells that cover the same place without sharing a facet, and nodes that are not joined.
#include "mesh/overlap.hpp"

#include <gtest/gtest.h>

#include "mesh/generate/generate.hpp"
#include "tests/mesh/rough_box.hpp"

namespace talus::overlap_test {
namespace {

/// Two meshes in one, with nodes of their own, the second moved.
template <int D>
MeshData<D> with_second(MeshData<D> data, const MeshData<D>& second, const Vec<D>& shift)
{
  const auto n = static_cast<Index>(data.nodes.size());
  for (const Vec<D>& x : second.nodes)
    data.nodes.push_back(x + shift);
  for (auto cell : second.cells) {
    for (Index& node : cell)
      node += n;
    data.cells.push_back(cell);
  }
  data.cell_sets.clear(), data.facet_sets.clear(), data.node_sets.clear();
  return data;
}

template <class T>
class OverlapIn : public ::testing::Test {};
using Dimensions = ::testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(OverlapIn, Dimensions);

TYPED_TEST(OverlapIn, RoughMeshesHaveNone)
{
  constexpr int D = TypeParam::value;
  EXPECT_FALSE(find_overlap(Mesh<D>(rough_box<D>(6))));
}

TYPED_TEST(OverlapIn, IsFoundWhereTwoBlocksPenetrateByATenthOfACell)
{
  constexpr int D = TypeParam::value;
  const auto block = rough_box<D>(4);  // 2 long, cells of 0.25
  Vec<D> shift = Vec<D>::Constant(0.07);
  shift[0] = 2 - 0.025;
  const auto found = find_overlap(Mesh<D>(with_second(block, block, shift)));
  ASSERT_TRUE(found);
  EXPECT_GT(found->pairs, 3);
  EXPECT_LT(found->first, found->second);
  shift[0] = 2 + 1e-12;
  EXPECT_FALSE(find_overlap(Mesh<D>(with_second(block, block, shift)))) << "they touch";
}

TYPED_TEST(OverlapIn, IsFoundWhereABlockLiesInsideAnotherOrIsThereTwice)
{
  constexpr int D = TypeParam::value;
  const auto block = rough_box<D>(4);
  MeshData<D> small = rough_box<D>(1);
  for (auto& x : small.nodes)
    x *= 0.1;
  EXPECT_TRUE(find_overlap(Mesh<D>(with_second(block, small, Vec<D>(Vec<D>::Constant(0.4))))));
  EXPECT_TRUE(find_overlap(Mesh<D>(with_second(block, block, Vec<D>(Vec<D>::Zero())))));
}

TEST(Overlap, OfALargeCellOverManySmallOnesAtTheirNodes)
{
  MeshData<2> grid = box<2>({0, 0}, {1, 1}, {4, 4});
  grid.cells.push_back({0, 4, 20});
  const auto found = find_overlap(Mesh<2>(std::move(grid)));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->pairs, 20);
}

template <int D>
MeshData<D> with_boundary(const MeshData<D>& data)
{
  MeshData<D> with = data;
  const Mesh<D> mesh(data);
  with.nodes.assign(mesh.nodes().begin(), mesh.nodes().end());
  for (const Facet f : mesh.boundary_facets())
    with.facet_sets["boundary"].push_back(mesh.nodes_of(f));
  return with;
}

TYPED_TEST(OverlapIn, NodesAtThePlaceOfOthersAreFoundAndNoOthers)
{
  constexpr int D = TypeParam::value;
  std::array<Index, D> cells;
  cells.fill(3);
  const auto block = box<D>(Vec<D>::Zero(), Vec<D>::Ones(), cells);
  EXPECT_TRUE(unjoined_nodes(with_boundary(block)).empty());
  Vec<D> shift = Vec<D>::Zero();
  shift[0] = 1;
  const auto data = with_boundary(with_second(block, block, shift));
  const auto groups = unjoined_nodes(data);
  EXPECT_EQ(groups.size(), D == 2 ? 4 : 16);
  for (const auto& group : groups) {
    ASSERT_EQ(group.size(), 2);
    EXPECT_LT(group[0], group[1]);
    EXPECT_EQ(data.nodes[static_cast<std::size_t>(group[0])], data.nodes[static_cast<std::size_t>(group[1])]);
    EXPECT_EQ(data.nodes[static_cast<std::size_t>(group[0])][0], 1);
  }
}

}  // namespace
}  // namespace talus::overlap_test
