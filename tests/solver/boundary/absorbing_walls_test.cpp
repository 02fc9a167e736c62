// Walls that give way: what a dashpot and the ground beside do to a node in one step, by the equations of give_way.
#include <gtest/gtest.h>

#include "tests/solver/boundary/nodes_in_a_square.hpp"

namespace talus::testing::giving_walls_test {
namespace {

constexpr Real rounding = 1e-12;
const Halfspace rock{.density = 2, .s_wave = 3, .p_wave = 5};
const Halfspace soil{.density = 1.5, .s_wave = 2, .p_wave = 4};

Table growing()
{
  Table table;
  table.points = {{0, 0}, {100, 100}};
  return table;
}

Wall<2> wall(WallKind kind, const std::string& name)
{
  Wall<2> w;
  w.name = name;
  w.kind = kind;
  return w;
}

/// A square of two by two cells, 2 m wide, of which one node moves at a time.
struct Ground : NodesInASquare {
  Ground() : NodesInASquare(2, 0.25) {}
  DynamicPhase& shaking() { return walls.*std::get<1>(BoundaryConditions<2>::fields()).member; }
  Wall<2> compliant() const
  {
    Wall<2> base = wall(WallKind::compliant_base, "base");
    base.velocity = {4, 1};
    base.table = growing();
    base.halfspace = rock;
    return base;
  }
};

void expect_near(const Vec<2>& a, const Vec<2>& b) { EXPECT_LT((a - b).norm(), rounding) << a.transpose() << " is not " << b.transpose(); }

TEST(GivingWalls, ACompliantBaseHoldsUntilTheShakingBegins)
{
  Ground ground;
  ground.walls.add(ground.compliant(), ground.mesh, *ground.mesh.facet_set("y_min"));
  ground.walls.settle();
  ground.walls.begin_stage(true, 0);
  const NodeMotion<2>& motion = ground.set({1, 0}, 2, {{1, -1}, {1, -1}});
  EXPECT_EQ(ground.walls.holder_of(static_cast<Index>(ground.node({1, 0}))), 0);
  EXPECT_EQ(ground.walls.closed_facets(ground.mesh).size(), 4u) << "those of the base, twice";
  ground.walls.apply_dashpots(1, 0.25, one_rank(), ground.nodes);
  expect_near(motion.v, {1, -1});
  ground.walls.apply(Kick{0, 0.25}, ground.nodes, ground.work);
  expect_near(motion.v, {0, 0});
  EXPECT_TRUE(ground.shaking().reaction.empty());
}

TEST(GivingWalls, ACompliantBaseGivesTwiceTheWaveAndTakesWhatLeaves)
{
  Ground ground;
  ground.walls.add(ground.compliant(), ground.mesh, *ground.mesh.facet_set("y_min"));
  ground.walls.settle();
  ground.walls.begin_stage(true, 0);
  ground.walls.begin_stage(false, 7);
  ground.walls.begin_stage(false, 9);  // it has begun already
  EXPECT_EQ(ground.shaking().begin, 7);
  const Real mass = 2, kick = 0.25;
  const NodeMotion<2>& motion = ground.set({1, 0}, mass, {{1, -1}, {0.5, -0.25}});
  const Vec<2> reaction = -mass / kick * Vec<2>(0.5, -0.25);  // what kept it in balance
  ground.walls.apply_dashpots(7.5, kick, one_rank(), ground.nodes);

  const Vec<2> C(2 * 3, 2 * 5);            // of half of each of two facets of 1 m: along it s waves, across p waves
  const Vec<2> wave = 0.5 * Vec<2>(4, 1);  // half a second after the shaking began
  const Vec<2> momentum = mass * Vec<2>(1, -1) + kick * reaction + kick * 2 * Vec<2>(C.cwiseProduct(wave));
  const Vec<2> v = momentum.cwiseQuotient(Vec<2>(Vec<2>::Constant(mass) + kick * C)), by = v - Vec<2>(1, -1);
  expect_near(motion.v, v);
  expect_near(motion.change, Vec<2>(0.5, -0.25) + by);

  ground.walls.apply(Kick{7.5, 7.75}, ground.nodes, ground.work);
  ground.walls.keep_impulses();
  expect_near(motion.v, v);
  const Wall<2>& base = ground.walls.walls().front();
  expect_near(base.impulse, mass * by);
  EXPECT_NEAR(base.angular[2], mass * by[1], rounding);  // the node is at (1, 0)
  const BoundaryWork work = ground.work.value();
  EXPECT_NEAR(work.moved, (mass * by).dot(motion.v - 0.5 * motion.change), rounding);
  EXPECT_NEAR(work.waves, kick * wave.dot(C.cwiseProduct(wave)), rounding);
  EXPECT_EQ(work.friction, 0);
  EXPECT_EQ(work.arrival, 0);

  // in the next step the reaction goes on, whatever the node did meanwhile
  ground.set({1, 0}, mass, {{0, 0}, {9, 9}});
  ground.walls.apply_dashpots(7, kick, one_rank(), ground.nodes);  // no wave yet
  expect_near(motion.v, (kick * reaction).cwiseQuotient(Vec<2>(Vec<2>::Constant(mass) + kick * C)));
  EXPECT_TRUE(ground.walls.fits());
}

/// Two layers, the upper one filled by half; the foot of both is that of the model.
SoilColumn<2> column()
{
  SoilColumn<2> two;
  two.level = {0, 1, 2};
  two.layer = {{rock, 1}, {soil, 0.5}};
  return two;
}

TEST(GivingWalls, ASideGivesWhatTheFreeFieldDoes)
{
  for (const WallKind below : {WallKind::fixed, WallKind::velocity, WallKind::compliant_base}) {
    Ground ground;
    Wall<2> foot = ground.compliant();
    foot.kind = below;
    if (below == WallKind::compliant_base)
      ground.walls.add(foot, ground.mesh, *ground.mesh.facet_set("y_min"));
    else
      ground.walls.add(foot, ground.mesh, *ground.mesh.node_set("y_min"));
    Wall<2> side = wall(WallKind::free_field, "side");
    side.column = column();
    side.foot = 0;
    ground.walls.add(side, ground.mesh, *ground.mesh.facet_set("x_max"));
    ground.walls.settle();
    ground.walls.begin_stage(true, 0);
    expect_near(ground.walls.held(static_cast<Index>(ground.node({2, 1})), 0, {3, 4}), {0, 4});  // a roller
    ground.walls.begin_stage(false, 7);
    expect_near(ground.walls.held(static_cast<Index>(ground.node({2, 1})), 0, {3, 4}), {3, 4});

    const Real mass = 2, kick = 0.25, dt = 0.2;
    Foot<2> moves;
    if (below == WallKind::velocity)
      moves.velocity = 7.5 * Vec<2>(4, 1);  // its table counts from the start of the run
    if (below == WallKind::compliant_base)
      moves.velocity = 0.5 * Vec<2>(4, 1), moves.halfspace = rock;
    ColumnMotion motion = column().at_rest();
    for (int step = 0; step < 2; ++step) {
      const ColumnMotion then = motion;
      advance(column(), moves, dt, motion);
      const NodeMotion<2>& at = ground.set({2, 1}, mass, {{1, -1}, {0, 0}});  // in balance before, so no reaction
      ground.walls.apply_dashpots(7.5, dt, one_rank(), ground.nodes);
      const Vec<2> face(0.5, 0);  // half a facet of each layer, out of the model
      const Vec<2> C(0.5 * (2 * 5 + 0.5 * 1.5 * 4), 0.5 * (2 * 3 + 0.5 * 1.5 * 2));
      const Vec<2> field = column().velocity_at(1, motion);
      const Vec<2> force = C.cwiseProduct(field) + column().force_on(face, 0, then) + column().force_on(face, 1, then);
      const Vec<2> v = (mass * Vec<2>(1, -1) + kick * force).cwiseQuotient(Vec<2>(Vec<2>::Constant(mass) + kick * C));
      expect_near(at.v, v);
      EXPECT_EQ(field.norm() == 0, below == WallKind::fixed);
      ground.walls.apply(Kick{7.5, 7.5 + kick}, ground.nodes, ground.work);
      expect_near(at.v, v);
      EXPECT_EQ(ground.shaking().columns.size(), 1u);
      EXPECT_EQ(ground.shaking().columns[0].velocity, motion.velocity);
    }
    ground.walls.keep_impulses();
    EXPECT_GT(ground.walls.walls()[1].impulse.norm(), 0);
    EXPECT_EQ(ground.walls.walls()[0].impulse.norm(), 0);
    EXPECT_TRUE(ground.walls.fits());
  }
}

TEST(GivingWalls, AFacetAboveTheGroundBesideStaysFree)
{
  Ground ground;
  ground.walls.add(wall(WallKind::fixed, "foot"), ground.mesh, *ground.mesh.node_set("y_min"));
  Wall<2> side = wall(WallKind::free_field, "side");
  side.column.level = {0, 1};
  side.column.layer = {{rock, 1}};
  side.foot = 0;
  ground.walls.add(side, ground.mesh, *ground.mesh.facet_set("x_max"));
  ground.walls.settle();
  ground.walls.begin_stage(false, 0);
  const NodeMotion<2>&middle = ground.set({2, 1}, 2, {{1, 0}, {0, 0}}), &top = ground.set({2, 2}, 2, {{1, 0}, {0, 0}});
  ground.walls.apply_dashpots(1, 0.2, one_rank(), ground.nodes);
  expect_near(top.v, {1, 0});
  expect_near(middle.v, {2 / (2 + 0.25 * 0.5 * 2 * 5), 0});  // half of one facet
}

/// In a corner that is not square: whichever was added first, the floor keeps its own normal when the side lets go.
TEST(GivingWalls, AnInclinedFloorHoldsAloneOnceTheSideBesideItLetsGo)
{
  MeshData<2> data = box<2>(Vec<2>::Zero(), {2, 2}, {2, 2});
  for (Vec<2>& x : data.nodes)
    if (x[1] == 0)
      x[1] = -0.5 * x[0];
  const Mesh<2> mesh(std::move(data));
  Index corner = 0;
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (mesh.node(n)[0] > 1.5 && mesh.node(n)[1] < -0.5)
      corner = n;
  Wall<2> side = wall(WallKind::free_field, "side");
  side.column.level = {-1, 2};
  side.column.layer = {{rock, 1}};
  const Vec<2> v(3, 4), normal = Vec<2>(-0.5, -1).normalized();
  for (const bool side_first : {false, true}) {
    BoundaryConditions<2> walls;
    for (const bool now_side : {side_first, !side_first})
      walls.add(now_side ? side : wall(WallKind::roller, "floor"), mesh, *mesh.facet_set(now_side ? "x_max" : "y_min"));
    walls.settle();
    expect_near(walls.held(corner, 0, v), {0, 0});
    walls.begin_stage(false, 0);
    expect_near(walls.held(corner, 0, v), v - v.dot(normal) * normal);
  }
}

TEST(GivingWalls, RecordsBeginWithTheShaking)
{
  Ground ground;
  Wall<2> shaken = wall(WallKind::velocity, "shaken");
  shaken.velocity = {1, 2};
  shaken.record = record_of_velocity({0, 1, 2}, {0, 10, 0});
  ground.walls.add(shaken, ground.mesh, *ground.mesh.node_set("y_min"));
  ground.walls.settle();
  const auto n = static_cast<Index>(ground.node({1, 0}));
  expect_near(ground.walls.held(n, 0.5, {9, 9}), {0, 0});
  ground.walls.begin_stage(false, 3);
  expect_near(ground.walls.held(n, 3.5, {9, 9}), {5, 10});
  ground.walls.begin_stage(true, 4);
  expect_near(ground.walls.held(n, 4.5, {9, 9}), {0, 0});
}

TEST(GivingWalls, WhatWasKeptFitsOnlyIfItHasANumberForEachDashpot)
{
  Ground ground;
  ground.walls.add(ground.compliant(), ground.mesh, *ground.mesh.facet_set("y_min"));
  Wall<2> side = wall(WallKind::free_field, "side");
  side.column = column();
  side.foot = 0;
  ground.walls.add(side, ground.mesh, *ground.mesh.facet_set("x_max"));
  ground.walls.settle();
  EXPECT_TRUE(ground.walls.fits());
  ground.walls.begin_stage(false, 0);
  ground.walls.apply_dashpots(1, 0.2, one_rank(), ground.nodes);
  EXPECT_EQ(ground.shaking().reaction.size(), 2u * 5u);  // three nodes below, three beside, of which one is both
  EXPECT_TRUE(ground.walls.fits());
  const DynamicPhase right = ground.shaking();
  const auto fits_with = [&](const auto& change) {
    ground.shaking() = right;
    change(ground.shaking());
    return ground.walls.fits();
  };
  EXPECT_FALSE(fits_with([](DynamicPhase& s) { s.reaction.pop_back(); }));
  EXPECT_FALSE(fits_with([](DynamicPhase& s) { s.columns.pop_back(); }));
  EXPECT_FALSE(fits_with([](DynamicPhase& s) { s.columns[0].velocity.pop_back(); }));
  EXPECT_FALSE(fits_with([](DynamicPhase& s) { s.columns[0].traction.pop_back(); }));
  EXPECT_FALSE(fits_with([](DynamicPhase& s) { s.knows_reactions = false; }));
  EXPECT_FALSE(fits_with([](DynamicPhase& s) { s.knows_reactions = false, s.columns.clear(); }));
  EXPECT_FALSE(fits_with([](DynamicPhase& s) { s.knows_reactions = false, s.reaction.clear(); }));
  EXPECT_TRUE(fits_with([](DynamicPhase& s) { s = {}; }));
}

}  // namespace
}  // namespace talus::testing::giving_walls_test
