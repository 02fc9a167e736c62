// Blocks of cells shared out among ranks: evenly, with short borders, the same every time, whatever the weights.
#include "mesh/partition.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "core/error.hpp"
#include "tests/mesh/rough_box.hpp"

namespace talus::partition_test {
namespace {

using Weights = std::vector<std::int64_t>;

template <int D>
Weights equal_weights(const Mesh<D>& mesh)
{
  return Weights(static_cast<std::size_t>(blocks_of(mesh.n_cells())), 1000);
}

bool all_within(const std::vector<int>& ranks, int parts)
{
  return std::all_of(ranks.begin(), ranks.end(), [&](int rank) { return rank >= 0 && rank < parts; });
}

template <int D>
Index facets_cut(const Mesh<D>& mesh, const std::vector<int>& ranks)
{
  Index count = 0;
  for (Index c = 0; c < mesh.n_cells(); ++c)
    for (const Index other : mesh.neighbours(c))
      if (other > c && ranks[static_cast<std::size_t>(other / block_cells)] != ranks[static_cast<std::size_t>(c / block_cells)])
        ++count;
  return count;
}

TEST(Partition, OnlyTheLastBlockIsShort)
{
  EXPECT_EQ(blocks_of(0), 0);
  EXPECT_EQ(blocks_of(1), 1);
  EXPECT_EQ(blocks_of(block_cells), 1);
  EXPECT_EQ(blocks_of(block_cells + 1), 2);
  EXPECT_EQ(blocks_of(std::numeric_limits<Index>::max()), 1 << 24);
}

TEST(Partition, SharesOfEqualBlocksAreEvenAndTheSameAgain)
{
  const Mesh<2> plane(rough_box<2>(64));  // 128 blocks
  const Mesh<3> solid(rough_box<3>(12));  // 162 blocks
  for (const int parts : {2, 3, 4, 7, 16}) {
    const auto of_plane = partition<2>(plane, equal_weights(plane), parts);
    const auto of_solid = partition<3>(solid, equal_weights(solid), parts);
    EXPECT_TRUE(all_within(of_plane, parts));
    EXPECT_TRUE(all_within(of_solid, parts));
    EXPECT_LT(imbalance(equal_weights(plane), of_plane, parts), 1.13);  // nine blocks, where eight would be even
    EXPECT_LT(imbalance(equal_weights(solid), of_solid, parts), 1.13);
    EXPECT_EQ(partition<2>(plane, equal_weights(plane), parts), of_plane);
    EXPECT_EQ(partition<3>(solid, equal_weights(solid), parts), of_solid);
  }
}

TEST(Partition, HalvesOfALongBoxMeetInAShortBorder)
{
  const Mesh<2> mesh(rough_box<2>(64));
  const auto ranks = partition<2>(mesh, equal_weights(mesh), 2);
  EXPECT_LT(facets_cut(mesh, ranks), 2 * 64);  // a straight border cuts 64 edges of squares, and blocks have steps
}

TEST(Partition, ParticlesCountMoreThanEmptyCells)
{
  const Mesh<2> mesh(rough_box<2>(64));
  Weights weights = equal_weights(mesh);
  std::fill(weights.begin() + 32, weights.end(), 0);
  const auto ranks = partition<2>(mesh, weights, 4);
  EXPECT_LT(imbalance(weights, ranks, 4), 1.3);
  Weights blocks_of_rank(4, 0);
  for (const int rank : ranks)
    ++blocks_of_rank[static_cast<std::size_t>(rank)];
  EXPECT_GE(*std::min_element(blocks_of_rank.begin(), blocks_of_rank.end()), 7);  // eight hold its particles
}

TEST(Partition, EmptySpaceIsSharedOutToo)
{
  const Mesh<3> mesh(rough_box<3>(12));
  const Weights nothing(static_cast<std::size_t>(blocks_of(mesh.n_cells())), 0);
  const auto ranks = partition<3>(mesh, nothing, 4);
  EXPECT_LT(imbalance(equal_weights(mesh), ranks, 4), 1.1);
  EXPECT_EQ(imbalance(nothing, ranks, 4), 1);
}

TEST(Partition, OneRankTakesAllAndMoreRanksThanBlocksOneEach)
{
  const Mesh<2> mesh(rough_box<2>(12));  // 4.5 blocks
  const Weights weights = equal_weights(mesh);
  EXPECT_EQ(partition<2>(mesh, weights, 1), (std::vector<int>{0, 0, 0, 0, 0}));
  EXPECT_EQ(partition<2>(mesh, weights, 5), (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(partition<2>(mesh, weights, 9), (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_DOUBLE_EQ(imbalance(weights, partition<2>(mesh, weights, 9), 9), 9.0 / 5);
}

TEST(Partition, AnyWeightsAndNumberOfRanksWillDo)
{
  const Mesh<3> mesh(rough_box<3>(6));  // 20.25 blocks
  const Index n_blocks = blocks_of(mesh.n_cells());
  std::mt19937_64 random(7);
  ::testing::internal::CaptureStdout();
  for (int parts = 1; parts < n_blocks + 5; ++parts)
    for (const std::int64_t most : {std::int64_t{1}, std::int64_t{100000}, std::int64_t{1} << 52}) {
      Weights weights(static_cast<std::size_t>(n_blocks));
      for (auto& weight : weights)
        weight = random() % 3 == 0 ? 0 : static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(most));
      const auto ranks = partition<3>(mesh, weights, parts);
      EXPECT_EQ(ranks.size(), weights.size());
      EXPECT_TRUE(all_within(ranks, parts));
      EXPECT_GE(imbalance(weights, ranks, parts), 1);
      const auto costs = costs_of_blocks(weights, mesh.n_cells());
      EXPECT_LE(imbalance(costs, ranks, parts), imbalance_in_reach(costs, parts));
      EXPECT_LE(imbalance(weights, ranks, parts), parts * (1 + 1e-12));
    }
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "") << "METIS may talk, but not in between what a run prints";
}

TEST(Partition, AMeshMayConsistOfSeparatePieces)
{
  MeshData<2> data = rough_box<2>(32);
  std::erase_if(data.cells, [&](const auto& cell) {
    return std::all_of(cell.begin(), cell.end(), [&](Index n) {
      const Real x = 4 * data.nodes[static_cast<std::size_t>(n)][0];
      return static_cast<Index>(x) % 2 == 1;
    });
  });
  data.facet_sets.clear();
  data.cell_sets.clear();
  data.node_sets.clear();
  const Mesh<2> mesh(data);
  for (const int parts : {2, 3, 5}) {
    const auto ranks = partition<2>(mesh, equal_weights(mesh), parts);
    EXPECT_TRUE(all_within(ranks, parts));
    EXPECT_LT(imbalance(equal_weights(mesh), ranks, parts), 1.3);
  }
}

TEST(Partition, NonsenseIsRefused)
{
  const Mesh<2> mesh(rough_box<2>(12));
  Weights weights = equal_weights(mesh);
  EXPECT_THROW(partition<2>(mesh, weights, 0), std::invalid_argument);
  weights[2] = -1;
  EXPECT_THROW(partition<2>(mesh, weights, 2), std::invalid_argument);
  weights.pop_back();
  EXPECT_THROW(partition<2>(mesh, weights, 2), std::invalid_argument);
}

TEST(Partition, ImbalanceIsLargestOverMean)
{
  const Weights weights{1, 2, 3, 6};
  EXPECT_DOUBLE_EQ(imbalance(weights, std::vector<int>{0, 0, 0, 1}, 2), 1);
  EXPECT_DOUBLE_EQ(imbalance(weights, std::vector<int>{0, 0, 1, 1}, 2), 1.5);
  EXPECT_DOUBLE_EQ(imbalance(weights, std::vector<int>{1, 1, 1, 1}, 3), 3);
}

}  // namespace
}  // namespace talus::partition_test
