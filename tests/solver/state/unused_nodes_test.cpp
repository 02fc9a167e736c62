// Nodes and cells that particles never come near take no memory of a step.
#include <gtest/gtest.h>

#include "materials/law_examples.hpp"
#include "tests/core/resident_pages.hpp"
#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::unused_nodes_test {
namespace {

TEST(UnusedNodes, AreUnseenBeforeTheyAreWritten)
{
  EXPECT_FALSE(SparseRows<NodeSum<3>>(1)[0].is_seen());
  EXPECT_FALSE(SparseRows<ProjectedNodeSum<2>>(1)[0].is_seen());
  EXPECT_FALSE(NodeSum<3>().is_seen());
  EXPECT_FALSE(SparseRows<NodeMotion<3>>(1)[0].is_seen());
  EXPECT_FALSE(SparseRows<NodePatchRow<2>>(1)[0].is_seen());
  EXPECT_FALSE(SparseRows<CellGroupSum<3>>(1)[0].is_seen());
}

/// Particles may come to a row that has never been written.
TEST(UnusedNodes, KnowTheLightestParticleOnceOneComes)
{
  SparseRows<NodeSum<3>> rows(2);
  for (NodeSum<3>& sum : rows) {
    sum.see_particles(NodeSum<3>::unseen);
    EXPECT_FALSE(sum.is_seen());
    sum.see_particles(2e-30F);
    EXPECT_TRUE(sum.is_seen());
    sum.see_particles(3);
    sum.see_particles(NodeSum<3>::unseen);
    EXPECT_EQ(sum.lightest, 2e-30F);
    sum.see_particles(1e-30F);
    EXPECT_EQ(sum.lightest, 1e-30F);
    sum = {};
  }
  rows[1].see_particles(5);
  rows[0] += rows[1];
  EXPECT_EQ(rows[0].lightest, 5);
  rows[0] += NodeSum<3>();
  EXPECT_EQ(rows[0].lightest, 5);
}

/// A cube of two materials in a corner of a room of `cells` cells on an edge.
Model<3> in_a_room(Index cells)
{
  auto m = make_model<Projected<3>>(Mesh<3>(box<3>({0, 0, 0}, Vec<3>::Constant(0.25 * cells), {cells, cells, cells})));
  const auto soil = law_example<VonMises>();
  add_body<3>(m, "lower", soil, 4, [](const Vec<3>& x) { return x.maxCoeff() < 1 && x[2] < 0.5; });
  add_body<3>(m, "upper", soil, 4, [](const Vec<3>& x) { return x.maxCoeff() < 1 && x[2] > 0.5; });
  m.problem.transfer.scheme = Scheme::aflip;
  make_ready(m);
  for (int step = 0; step < 3; ++step)
    make_step(m, 1e-6);
  return m;
}

TEST(UnusedNodes, TakeNoMemory)
{
  const Model<3> m = in_a_room(20);
  const auto& rows = dynamic_cast<TransferOf<3, Projected<3>>&>(*m.transfer).rows();
  const auto share = [](const auto& array) {
    const Pages pages = pages_of(array);
    EXPECT_GT(pages.all, 100U) << "too few pages to say anything";
    EXPECT_GT(pages.resident, 0U) << "it is not used at all";
    return static_cast<Real>(pages.resident) / static_cast<Real>(pages.all);
  };
  // The body fills 1/125 of the room; steps use nodes two rings around its blocks of cells, and read one ring more.
  constexpr Real most = 0.35;
  EXPECT_LT(share(m.work.fields[0].nodes.sum), most);
  EXPECT_LT(share(m.work.fields[0].nodes.motion), most);
  EXPECT_LT(share(rows.projected.sum), most);
  EXPECT_LT(share(rows.projected.motion), most);
  EXPECT_LT(share(m.work.fields[0].nodes.remapped), most);
  EXPECT_LT(share(rows.gradient_of_remapped), most);
  EXPECT_LT(share(rows.moments), most) << "ten large pages, if the system grants them";
  EXPECT_LT(share(rows.blocks.row), most);
}

TEST(UnusedNodes, AreNotCountedAsMemory)
{
  auto small = in_a_room(8), large = in_a_room(16);
  const Real ratio = static_cast<Real>(large.transfer->bytes(large)) / static_cast<Real>(small.transfer->bytes(small));
  EXPECT_GT(ratio, 1) << "operators are those of all nodes";
  EXPECT_LT(ratio, 4) << "a room of eight times the size";
}

}  // namespace
}  // namespace talus::testing::unused_nodes_test
