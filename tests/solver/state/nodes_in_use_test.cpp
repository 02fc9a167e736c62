// The nodes that a step visits: near particles, and once more where they have left.
#include "solver/state/nodes_in_use.hpp"

#include <gmock/gmock.h>

#include <set>

#include "mesh/generate/generate.hpp"

namespace talus::nodes_in_use_test {
namespace {

using ::testing::IsEmpty;

/// A strip of many blocks of cells.
Mesh<2> strip() { return Mesh<2>(box<2>({0, 0}, {64, 4}, {256, 16})); }

std::set<Index> visited(const NodesInUse& in_use)
{
  std::set<Index> nodes;
  in_use.for_each_ascending([&](Index n) { EXPECT_TRUE(nodes.insert(n).second); });
  return nodes;
}

/// Nodes within two rings of the cells of a block.
std::set<Index> near_block(const Mesh<2>& mesh, Index block)
{
  std::set<Index> nodes;
  for (Index c = block * block_cells; c < std::min(mesh.n_cells(), (block + 1) * block_cells); ++c)
    nodes.insert(mesh.cell(c).begin(), mesh.cell(c).end());
  for (int ring = 0; ring < 2; ++ring)
    for (const Index n : std::set<Index>(nodes))
      nodes.insert(mesh.ring_of_node()[n].begin(), mesh.ring_of_node()[n].end());
  return nodes;
}

class NodesInUseOf : public ::testing::Test {
 protected:
  NodesInUseOf() { in_use_.prepare(mesh_, all_nodes(mesh_)); }
  void occupy(std::initializer_list<std::size_t> blocks, bool everything = false)
  {
    std::vector<std::uint8_t> occupied(static_cast<std::size_t>(blocks_of(mesh_.n_cells())), 0);
    for (const std::size_t b : blocks)
      occupied[b] = 1;
    in_use_.find(occupied, everything);
  }
  Mesh<2> mesh_ = strip();
  NodesInUse in_use_{mesh_.n_nodes()};
};

TEST_F(NodesInUseOf, AreAllBeforeAnybodyAsks) { EXPECT_EQ(visited(in_use_).size(), static_cast<std::size_t>(mesh_.n_nodes())); }

TEST_F(NodesInUseOf, AreThoseNearParticlesAndFewMore)
{
  const auto last = static_cast<std::size_t>(blocks_of(mesh_.n_cells())) - 1;
  for (const std::size_t block : {std::size_t{0}, last / 2, last}) {
    occupy({block}), occupy({block});
    const std::set<Index> now = visited(in_use_), near = near_block(mesh_, static_cast<Index>(block));
    EXPECT_TRUE(std::ranges::includes(now, near)) << block;
    EXPECT_LT(now.size(), static_cast<std::size_t>(mesh_.n_nodes()) / 4) << block;
  }
}

TEST_F(NodesInUseOf, AreVisitedOnceMoreWhenParticlesHaveLeft)
{
  const auto last = static_cast<std::size_t>(blocks_of(mesh_.n_cells())) - 1;
  occupy({0});
  const std::set<Index> before = visited(in_use_);
  occupy({last});
  EXPECT_TRUE(std::ranges::includes(visited(in_use_), before));
  occupy({last});
  std::set<Index> common;
  const std::set<Index> now = visited(in_use_);
  std::ranges::set_intersection(now, before, std::inserter(common, common.end()));
  EXPECT_THAT(common, IsEmpty());
}

TEST_F(NodesInUseOf, AreAllWhereLoadsActOnTheMesh)
{
  occupy({0}, true);
  EXPECT_EQ(visited(in_use_).size(), static_cast<std::size_t>(mesh_.n_nodes()));
  occupy({0}, false);
  EXPECT_EQ(visited(in_use_).size(), static_cast<std::size_t>(mesh_.n_nodes())) << "once more";
  occupy({0}, false);
  EXPECT_LT(visited(in_use_).size(), static_cast<std::size_t>(mesh_.n_nodes()) / 4);
}

TEST_F(NodesInUseOf, SumOverRangesOfOwnBlocks)
{
  occupy({0}), occupy({0});
  const std::set<Index> now = visited(in_use_);
  Index nodes = 0;
  for (const IndexRange& range : in_use_.own())
    nodes += range.end - range.begin;
  EXPECT_GE(static_cast<std::size_t>(nodes), near_block(mesh_, 0).size() / 2);
  EXPECT_LT(nodes, mesh_.n_nodes() / 2);
}

}  // namespace
}  // namespace talus::nodes_in_use_test
