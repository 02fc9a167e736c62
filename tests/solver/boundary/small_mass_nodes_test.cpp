// Nodes with next to no mass.
#include <gtest/gtest.h>

#include <numeric>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::small_mass_nodes_test {
namespace {

/// Room for the sums of a mesh, all of them zero.
Nodes<2> nodes_of(const Mesh<2>& mesh)
{
  Nodes<2> nodes;
  const auto n = static_cast<std::size_t>(mesh.n_nodes());
  nodes.sum.resize(n);
  nodes.motion.resize(n);
  nodes.active.resize(n);
  nodes.in_use = NodesInUse(mesh.n_nodes());
  nodes.least_share = 1e-8;
  return nodes;
}

TEST(SmallMassNodes, HandOnEverythingTheyHoldAndMoveWithTheirHosts)
{
  const Mesh<2> mesh(box<2>({0, 0}, {1, 1}, {3, 3}));
  Nodes<2> nodes = nodes_of(mesh);
  const std::size_t n = nodes.sum.size();
  NodeSum<2> before;
  for (std::size_t i = 0; i < n; ++i) {
    nodes.sum[i].mass = i % 4 == 0 ? (i % 8 == 0 ? 1e-9 : -1e-3) : 1;  // tiny and negative ones among the others
    nodes.sum[i].lightest = 1;
    nodes.sum[i].momentum = nodes.sum[i].mass * Vec<2>(3, -2);
    nodes.sum[i].force = Vec<2>(1, static_cast<Real>(i));
    before += nodes.sum[i];
  }
  SmallMassNodes<2> small_mass_nodes;
  small_mass_nodes.lump(mesh, all_nodes(mesh), nodes);
  EXPECT_GT(small_mass_nodes.size(), 2);
  NodeSum<2> after;
  for (std::size_t i = 0; i < n; ++i)
    if (nodes.active[i])
      after += nodes.sum[i];
  EXPECT_NEAR(after.mass, before.mass, 1e-13);
  EXPECT_LT((after.momentum - before.momentum).norm(), 1e-12);
  EXPECT_LT((after.force - before.force).norm(), 1e-11);

  for (auto& row : nodes.motion)
    row = {Vec<2>(3, -2), Vec<2>(0.5, 0)};
  BoundaryConditions<2> none_at_all;
  ExactSums<BoundaryWork> work;
  small_mass_nodes.extrapolate(all_nodes(mesh), Kick{}, none_at_all, nodes, work);
  for (const auto& row : nodes.motion)
    EXPECT_LT((row.v - Vec<2>(3, -2)).norm() + (row.change - Vec<2>(0.5, 0)).norm(), 1e-14) << "a uniform motion stays one";
}

/// A force on a node that no particle reaches: in trials of an increment it goes to the nodes around, in steps there is none.
TEST(SmallMassNodes, OfATrialAreThoseWithoutParticlesToo)
{
  const Mesh<2> mesh(box<2>({0, 0}, {1, 1}, {3, 3}));
  Nodes<2> nodes = nodes_of(mesh);
  std::vector<Vec<2>> forces(nodes.sum.size(), Vec<2>::Zero());
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (const auto i = static_cast<std::size_t>(n); mesh.node(n)[0] > 0.1)
      nodes.sum[i].mass = nodes.sum[i].lightest = 1;
    else
      forces[i] = Vec<2>(2, 1 + static_cast<Real>(n));
  const Vec<2> all = std::accumulate(forces.begin(), forces.end(), Vec<2>(Vec<2>::Zero()));
  ASSERT_GT(all.norm(), 1);
  const auto of_active = [&](ActiveNodes which) {
    SmallMassNodes<2> small_mass_nodes;
    small_mass_nodes.lump(mesh, all_nodes(mesh), nodes, which);
    std::vector<Vec<2>> given = forces;
    small_mass_nodes.give(
        all_nodes(mesh), [](Index, const Vec<2>& force) { return force; }, given);
    Vec<2> sum = Vec<2>::Zero();
    for (std::size_t i = 0; i < given.size(); ++i)
      if (nodes.active[i])
        sum += given[i];
    return sum;
  };
  EXPECT_EQ(of_active(ActiveNodes::by_mass), Vec<2>(0, 0));
  EXPECT_LT((of_active(ActiveNodes::as_before) - all).norm(), 1e-13);
}

/// A body that turns and is strained: the column of nodes of small mass, beside the others and not between them, moves with it.
TEST(SmallMassNodes, KeepALinearVelocityField)
{
  const Mesh<2> mesh(box<2>({0, 0}, {1, 1}, {3, 3}));
  Nodes<2> nodes = nodes_of(mesh);
  const Mat<2> slope{{0.3, -2}, {1.5, 0.7}};
  const auto velocity = [&](Index n) { return Vec<2>(Vec<2>(3, -2) + slope * mesh.node(n)); };
  Vec<2> before = Vec<2>::Zero();
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    NodeSum<2>& sum = nodes.sum[static_cast<std::size_t>(n)];
    sum.mass = mesh.node(n)[0] < 0.1 ? 1e-3 * static_cast<Real>(n - 5) : 1 + 0.1 * static_cast<Real>(n);
    sum.lightest = 1;
    sum.momentum = sum.mass * velocity(n);
    before += sum.momentum;
  }
  nodes.least_share = 0.1;
  SmallMassNodes<2> small_mass_nodes;
  small_mass_nodes.lump(mesh, all_nodes(mesh), nodes);
  ASSERT_EQ(small_mass_nodes.size(), 4);
  Vec<2> after = Vec<2>::Zero();
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    const auto i = static_cast<std::size_t>(n);
    if (nodes.active[i]) {
      nodes.motion[i] = {nodes.sum[i].momentum / nodes.sum[i].mass, Vec<2>(slope * mesh.node(n))};
      EXPECT_LT((nodes.motion[i].v - velocity(n)).norm(), 1e-13);
      after += nodes.sum[i].momentum;
    }
  }
  EXPECT_LT((after - before).norm(), 1e-12);
  BoundaryConditions<2> none_at_all;
  ExactSums<BoundaryWork> work;
  small_mass_nodes.extrapolate(all_nodes(mesh), Kick{}, none_at_all, nodes, work);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    EXPECT_LT((nodes.motion[static_cast<std::size_t>(n)].v - velocity(n)).norm() +
                  (nodes.motion[static_cast<std::size_t>(n)].change - slope * mesh.node(n)).norm(),
              1e-13);
}

/// Hosts on a line tell nothing of a slope across it, and a single one of no slope at all.
TEST(SmallMassNodes, HaveNoSlopeAcrossHostsOnALine)
{
  const Mesh<2> mesh(box<2>({0, 0}, {3, 3}, {3, 3}));
  for (const Real end : {2.5, 0.5}) {  // three hosts at y = 0 beside the node at (3, 1), or one
    Nodes<2> nodes = nodes_of(mesh);
    Index outside = none;
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      const Vec<2> x = mesh.node(n);
      NodeSum<2>& sum = nodes.sum[static_cast<std::size_t>(n)];
      if (x[1] < 0.5 && x[0] > 3 - end - 0.1)
        sum.mass = 1, sum.momentum = Vec<2>(x[0], 1);
      else if ((x - Vec<2>(3, 1)).norm() < 0.1)
        sum.mass = 1e-10, outside = n;
      else
        continue;
      sum.lightest = 1;
    }
    SmallMassNodes<2> small_mass_nodes;
    small_mass_nodes.lump(mesh, all_nodes(mesh), nodes);
    ASSERT_EQ(small_mass_nodes.size(), 1);
    for (std::size_t i = 0; i < nodes.sum.size(); ++i)
      if (nodes.active[i])
        nodes.motion[i].v = nodes.sum[i].momentum / nodes.sum[i].mass;
    BoundaryConditions<2> none_at_all;
    ExactSums<BoundaryWork> work;
    small_mass_nodes.extrapolate(all_nodes(mesh), Kick{}, none_at_all, nodes, work);
    EXPECT_LT((nodes.motion[static_cast<std::size_t>(outside)].v - Vec<2>(3, 1)).norm(), 1e-9) << "the slope along the line is known";
  }
}

/// A heavy body beyond a gap of one row of nodes without mass is within two rings of the last node of a light one, and must not move it.
TEST(SmallMassNodes, LeaveABodyAcrossAGapOut)
{
  const Mesh<2> mesh(box<2>({0, 0}, {6, 3}, {6, 3}));
  Nodes<2> nodes = nodes_of(mesh);
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    const Real x = mesh.node(n)[0];
    NodeSum<2>& sum = nodes.sum[static_cast<std::size_t>(n)];
    sum.mass = x < 1.5 ? 1 : x < 2.5 ? 1e-10 : x < 3.5 ? 0 : 1000;
    sum.lightest = x < 2.5 ? 1 : 1000;
    sum.momentum = sum.mass * Vec<2>(x < 2.5 ? 1 : -5, 0);
    if (x > 2.5 && x < 3.5)
      sum = {};
  }
  SmallMassNodes<2> small_mass_nodes;
  small_mass_nodes.lump(mesh, all_nodes(mesh), nodes);
  ASSERT_EQ(small_mass_nodes.size(), 4);
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    const auto i = static_cast<std::size_t>(n);
    small_mass_nodes.for_each_host(n, [&](Index host, Real) { EXPECT_LT(mesh.node(host)[0], 1.5); });
    if (nodes.active[i] && mesh.node(n)[0] > 3.5) {
      EXPECT_EQ(nodes.sum[i].mass, 1000);
    }
  }
}

/// One particle dragged across a vertex meets nodes of vanishing mass on its way; nothing acts on it.
template <class K>
void drag_across_a_vertex(Scheme scheme)
{
  auto m = make_model<K>(unit_box<2>(4, 0.2));
  m.problem.transfer = {.scheme = scheme, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  const auto one_cell = [&, done = false](const Vec<2>& x) mutable { return !done && x[0] > 0.3 && x[1] > 0.3 ? (done = true) : false; };
  add_body<2>(m, "grain", rubber(1000, 0.3, 1000), 1, one_cell);
  ASSERT_EQ(m.state.particles.size(), 1);
  Index vertex = 0;
  for (Index n = 0; n < m.problem.mesh.n_nodes(); ++n)
    if ((m.problem.mesh.node(n) - Vec<2>(0.5, 0.5)).norm() < (m.problem.mesh.node(vertex) - Vec<2>(0.5, 0.5)).norm())
      vertex = n;
  const Vec<2> v(1, 0.4);
  m.state.particles.x.set(0, m.problem.mesh.node(vertex) - 0.02 * v);
  m.state.particles.cell[0] = m.problem.locator(m.problem.mesh, m.state.particles.x[0], none).value();
  m.state.particles.v.set(0, v);
  make_ready(m);
  for (int step = 0; step < 40; ++step)  // hits the vertex exactly after half of them
    advance(m, 1e-3);
  EXPECT_LT((m.state.particles.v[0] - v).norm(), 1e-12);
}

TEST(SmallMassNodes, LeaveALoneParticleItsVelocityAcrossAVertex)
{
  drag_across_a_vertex<Linear<2>>(Scheme::flip);
  drag_across_a_vertex<Umls<2>>(Scheme::flip);
  drag_across_a_vertex<Linear<2>>(Scheme::tpic);
  drag_across_a_vertex<Umls<2>>(Scheme::tpic);
}

/// Particles exactly on a face of a tetrahedron give the vertex opposite neither mass nor force, yet their gradient reads it.
TEST(SmallMassNodes, AreNodesWhoseCellsCancel)
{
  const Mesh<2> mesh(box<2>({0, 0}, {1, 1}, {3, 3}));
  Nodes<2> nodes = nodes_of(mesh);
  nodes.least_share_of_gross = 0.3;
  NodeSum<2> gets, loses;
  gets.mass = gets.gross = 1;
  loses.mass = -0.9;
  loses.gross = 0.9F;
  gets.lightest = loses.lightest = 1;
  for (auto& sum : nodes.sum)
    sum = gets;
  nodes.sum[5] += loses;
  SmallMassNodes<2> small_mass_nodes;
  small_mass_nodes.lump(mesh, all_nodes(mesh), nodes);
  EXPECT_EQ(small_mass_nodes.size(), 1);
  EXPECT_FALSE(nodes.active[5]);
}

TEST(SmallMassNodes, BeginJustBelowTheirShareOfTheLightestParticleAndOfWhatCellsBring)
{
  const Mesh<2> mesh(box<2>({0, 0}, {1, 1}, {3, 3}));
  Nodes<2> nodes = nodes_of(mesh);
  nodes.least_share_of_gross = 0.3;
  for (auto& sum : nodes.sum)
    sum.mass = sum.gross = sum.lightest = 1;
  const auto set = [&](std::size_t node, Real mass, Real gross) {
    nodes.sum[node].mass = mass;
    nodes.sum[node].gross = static_cast<float>(gross);
  };
  set(5, 0.29, 1), set(6, 0.31, 1);
  set(9, 0.99e-8, 0.99e-8), set(10, 1.01e-8, 1.01e-8);
  SmallMassNodes<2> small_mass_nodes;
  small_mass_nodes.lump(mesh, all_nodes(mesh), nodes);
  EXPECT_FALSE(nodes.active[5]);
  EXPECT_TRUE(nodes.active[6]);
  EXPECT_FALSE(nodes.active[9]);
  EXPECT_TRUE(nodes.active[10]);
  EXPECT_EQ(small_mass_nodes.size(), 2);
}

TEST(SmallMassNodes, LendANodeWithoutMassTheMotionAroundIt)
{
  auto m = make_model<Linear<3>>(unit_box<3>(2, 0));
  m.problem.transfer = {.scheme = Scheme::flip, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  add_body<3>(
      m, "dust", rubber(1000, 0.3, 1000), 1, [](const Vec<3>&) { return true; }, [](const Vec<3>&) { return Vec<3>(1, 0.4, 0.2); });
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    const auto& vertices = m.problem.mesh.cell(m.state.particles.cell[p]);
    m.state.particles.x.set(p,
                            (m.problem.mesh.node(vertices[0]) + m.problem.mesh.node(vertices[1]) + m.problem.mesh.node(vertices[2])) / 3);
  }
  make_ready(m);
  advance(m, 1e-4);
  for (std::size_t p = 0; p < m.state.particles.L.size(); ++p)
    EXPECT_LT(m.state.particles.L[p].norm(), 1e-11) << "all move alike, and nothing is strained";
}

/// How far the bounces of a light block have strained it, alone or beside one a thousand times as dense that it never meets.
template <class K>
std::vector<Mat3> strained(bool beside_a_heavy_one)
{
  auto m = make_model<K>(unit_box<2>(12, 0.1));
  add_body<2>(
      m, "light", rubber(100, 0.3, 1), 3, [](const Vec<2>& x) { return x[0] < 0.4; },
      [](const Vec<2>& x) { return Vec<2>(0.5 * x[0], -0.3 * x[1]); });
  if (beside_a_heavy_one)
    add_body<2>(m, "heavy", rubber(1e5, 0.3, 1000), 3, [](const Vec<2>& x) { return x[0] > 0.8; });
  make_ready(m);
  for (int step = 0; step < 50; ++step)
    advance(m, 1e-3);
  std::vector<Mat3> F(static_cast<std::size_t>(m.state.bodies[0].size()));
  for (std::size_t p = 0; p < F.size(); ++p)  // the first body has the first ids
    F[static_cast<std::size_t>(m.state.particles.id[p])] = m.state.particles.F[p];
  return F;
}
template <class K>
void strain_apart()
{
  const auto alone = strained<K>(false), beside = strained<K>(true);
  Real most = 0;
  for (std::size_t p = 0; p < alone.size(); ++p) {
    EXPECT_EQ(alone[p], beside[p]);
    most = std::max(most, (alone[p] - Mat3::Identity()).norm());
  }
  EXPECT_GT(most, 1e-2);
}

TEST(SmallMassNodes, AreFoundByTheParticlesAroundAndNotByThoseOfAHeavyBodyElsewhere)
{
  strain_apart<Linear<2>>();
  strain_apart<Umls<2>>();
}

}  // namespace
}  // namespace talus::testing::small_mass_nodes_test
