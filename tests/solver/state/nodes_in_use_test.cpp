// The nodes that a step visits: near particles, and once more where they have left.
#include "solver/state/nodes_in_use.hpp"

#include <gmock/gmock.h>

#include <set>

#include "mesh/generate/generate.hpp"
#include "tests/solver/blocks_of_particles.hpp"

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

/// A grain that flies over many blocks.  A load of zero on the mesh puts all nodes in use.
template <class K>
Model<2> flying_grain(bool everything)
{
  auto m = make_model<K>(testing::unit_box<2>(32, 0.2));
  m.problem.transfer.pic_damping_crossings = 25;
  testing::add_body<2>(m, "grain", testing::rubber(1e4, 0.3, 1000), 3,
                       [](const Vec<2>& x) { return (x.array() - 0.2).abs().maxCoeff() < 0.08; });
  if (everything)
    m.problem.loads.on_mesh.emplace_back();
  make_ready(m);
  testing::set_velocity<2>(m, Mat<2>(Mat<2>::Identity() * 0.3), Vec<2>(2, 1));
  testing::run_until(m, 0.25);
  return m;
}

template <class K>
class NodesInUseUnder : public ::testing::Test {};
using AllKernels = ::testing::Types<Linear<2>, Umls<2>, Projected<2>>;
TYPED_TEST_SUITE(NodesInUseUnder, AllKernels);

TYPED_TEST(NodesInUseUnder, ChangeNoBit)
{
  const Model<2> near = flying_grain<TypeParam>(false), all = flying_grain<TypeParam>(true);
  ASSERT_EQ(near.state.clock.step, all.state.clock.step);
  ASSERT_GT(near.state.clock.step, 50);
  EXPECT_GT(near.state.particles.x[0][0], 0.5) << "it must have left the blocks in which it began";
  EXPECT_LT(visited(near.work.fields[0].nodes.in_use).size(), visited(all.work.fields[0].nodes.in_use).size());
  for (std::size_t p = 0; p < near.state.particles.id.size(); ++p) {
    EXPECT_EQ(near.state.particles.x[p], all.state.particles.x[p]);
    EXPECT_EQ(near.state.particles.v[p], all.state.particles.v[p]);
    EXPECT_EQ(near.state.particles.stress[p], all.state.particles.stress[p]);
  }
  EXPECT_EQ(near.state.momentum.on_nodes, all.state.momentum.on_nodes);
  for (std::size_t n = 0; n < near.work.fields[0].nodes.motion.size(); ++n)
    EXPECT_EQ(near.work.fields[0].nodes.motion[n].v, all.work.fields[0].nodes.motion[n].v) << n;
}

}  // namespace
}  // namespace talus::nodes_in_use_test
