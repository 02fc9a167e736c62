// Absorbing boundaries: what a dashpot and the ground beside do to a node in one step, by the equations of Dashpots::apply.
#include <gtest/gtest.h>

#include "tests/solver/boundary/nodes_in_a_square.hpp"

namespace talus::testing::absorbing_boundaries_test {
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

/// A square of two by two cells, 2 m wide, of which one node moves at a time.
struct Ground : NodesInASquare {
  Ground() : NodesInASquare(2, 0.25) {}
  DynamicPhase& phase() { return walls.*std::get<1>(BoundaryConditions<2>::fields()).member; }
  Dashpots<2>& dashpots() { return walls.*std::get<2>(BoundaryConditions<2>::fields()).member; }
  bool& reactions_known() { return dashpots().*std::get<0>(Dashpots<2>::fields()).member; }
  std::vector<Real>& reaction() { return dashpots().*std::get<1>(Dashpots<2>::fields()).member; }
  ColumnMotion& motion_of(std::size_t condition)
  {
    return std::get<FreeField<2>>((walls.*std::get<0>(BoundaryConditions<2>::fields()).member)[condition].kind).motion;
  }
  static CompliantBase<2> compliant() { return {rock, {{4, 1}, growing()}}; }
};

void expect_near(const Vec<2>& a, const Vec<2>& b) { EXPECT_LT((a - b).norm(), rounding) << a.transpose() << " is not " << b.transpose(); }

TEST(AbsorbingBoundaries, ACompliantBaseHoldsUntilTheShakingBegins)
{
  Ground ground;
  add_on<2>(ground.walls, ground.mesh, "y_min", Ground::compliant());
  ground.walls.finalize();
  ground.walls.begin_stage(true, 0);
  const NodeMotion<2>& motion = ground.set({1, 0}, 2, {{1, -1}, {1, -1}});
  EXPECT_EQ(ground.walls.holder_of(static_cast<Index>(ground.node({1, 0}))), 0);
  EXPECT_EQ(ground.walls.closed_facets(ground.mesh).size(), 4u) << "those of the base, twice";
  ground.walls.apply_dashpots(1, 0.25, one_rank(), ground.nodes);
  expect_near(motion.v, {1, -1});
  ground.walls.apply(Kick{0, 0.25}, ground.nodes, ground.work);
  expect_near(motion.v, {0, 0});
  EXPECT_TRUE(ground.reaction().empty());
}

/// What the change of pore pressure pushes, a node with dashpots keeps in part.
TEST(AbsorbingBoundaries, TakeTheirShareOfOtherImpulses)
{
  Ground ground;
  add_on<2>(ground.walls, ground.mesh, "y_min", Ground::compliant());
  ground.walls.finalize();
  ground.walls.begin_stage(true, 0);
  const Real mass = 2, kick = 0.25;
  ground.set({1, 0}, mass, {{1, -1}, {0.5, -0.25}});
  int count = 0;
  const auto share_is_that_of_the_resistance = [&](Index n, Index condition, const Mat<2>& share) {
    ++count;
    EXPECT_EQ(static_cast<std::size_t>(n), ground.node({1, 0}));
    EXPECT_EQ(condition, 0);
    const Vec<2> C(2 * 3, 2 * 5), expected = mass * (Vec<2>(Vec<2>::Constant(mass) + kick * C)).cwiseInverse();
    EXPECT_LT((share - Mat<2>(expected.asDiagonal())).norm(), rounding);
  };
  ground.walls.for_each_dashpot(ground.nodes, share_is_that_of_the_resistance);
  EXPECT_EQ(count, 0) << "the base holds until shaking begins";
  ground.walls.begin_stage(false, 7);
  ground.walls.apply_dashpots(7.5, kick, one_rank(), ground.nodes);
  ground.walls.for_each_dashpot(ground.nodes, share_is_that_of_the_resistance);
  EXPECT_EQ(count, 1);
  ground.walls.apply(Kick{7.5, 7.75}, ground.nodes, ground.work);
  ground.walls.keep_impulses();
  const Vec<2> before = ground.walls.conditions().front().impulse;
  ground.walls.dashpots_react(0, {1, 0}, {3, 4});
  ground.walls.keep_impulses();
  expect_near(ground.walls.conditions().front().impulse, before + Vec<2>(3, 4));
}

TEST(AbsorbingBoundaries, ACompliantBaseGivesTwiceTheWaveAndTakesWhatLeaves)
{
  Ground ground;
  add_on<2>(ground.walls, ground.mesh, "y_min", Ground::compliant());
  ground.walls.finalize();
  ground.walls.begin_stage(true, 0);
  ground.walls.begin_stage(false, 7);
  ground.walls.begin_stage(false, 9);  // it has begun already
  EXPECT_EQ(ground.phase().begin, 7);
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
  const BoundaryCondition<2>& base = ground.walls.conditions().front();
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

TEST(AbsorbingBoundaries, ASideGivesWhatTheFreeFieldDoes)
{
  for (const AnyCondition<2>& below : {AnyCondition<2>(Fixed<2>{}), AnyCondition<2>(PrescribedVelocity<2>{Ground::compliant().motion}),
                                       AnyCondition<2>(Ground::compliant())}) {
    const bool moved = std::holds_alternative<PrescribedVelocity<2>>(below), compliant = std::holds_alternative<CompliantBase<2>>(below);
    Ground ground;
    add_on(ground.walls, ground.mesh, "y_min", below);
    add_on<2>(ground.walls, ground.mesh, "x_max", FreeField<2>(column(), 0));
    ground.walls.finalize();
    ground.walls.begin_stage(true, 0);
    expect_near(ground.walls.held({static_cast<Index>(ground.node({2, 1}))}, 0, {3, 4}), {0, 4});  // a roller
    ground.walls.begin_stage(false, 7);
    expect_near(ground.walls.held({static_cast<Index>(ground.node({2, 1}))}, 0, {3, 4}), {3, 4});

    const Real mass = 2, kick = 0.25, dt = 0.2;
    ColumnBase<2> moves;
    if (moved)
      moves.velocity = 7.5 * Vec<2>(4, 1);  // its table counts from the start of the run
    if (compliant)
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
      EXPECT_EQ(field.norm() == 0, !moved && !compliant);
      ground.walls.apply(Kick{7.5, 7.5 + kick}, ground.nodes, ground.work);
      expect_near(at.v, v);
      EXPECT_EQ(ground.motion_of(1).velocity, motion.velocity);
    }
    ground.walls.keep_impulses();
    EXPECT_GT(ground.walls.conditions()[1].impulse.norm(), 0);
    EXPECT_EQ(ground.walls.conditions()[0].impulse.norm(), 0);
    EXPECT_TRUE(ground.walls.fits());
  }
}

TEST(AbsorbingBoundaries, AFacetAboveTheGroundBesideStaysFree)
{
  Ground ground;
  add_on<2>(ground.walls, ground.mesh, "y_min", Fixed<2>{});
  add_on<2>(ground.walls, ground.mesh, "x_max", FreeField<2>({.level = {0, 1}, .layer = {{rock, 1}}}, 0));
  ground.walls.finalize();
  ground.walls.begin_stage(false, 0);
  const NodeMotion<2>&middle = ground.set({2, 1}, 2, {{1, 0}, {0, 0}}), &top = ground.set({2, 2}, 2, {{1, 0}, {0, 0}});
  ground.walls.apply_dashpots(1, 0.2, one_rank(), ground.nodes);
  expect_near(top.v, {1, 0});
  expect_near(middle.v, {2 / (2 + 0.25 * 0.5 * 2 * 5), 0});  // half of one facet
}

/// In a corner that is not square: whichever was added first, the floor keeps its own normal when the side lets go.
TEST(AbsorbingBoundaries, AnInclinedFloorHoldsAloneOnceTheSideBesideItLetsGo)
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
  const FreeField<2> side({.level = {-1, 2}, .layer = {{rock, 1}}}, none);
  const Vec<2> v(3, 4), normal = Vec<2>(-0.5, -1).normalized();
  for (const bool side_first : {false, true}) {
    BoundaryConditions<2> walls;
    for (const bool now_side : {side_first, !side_first})
      add_on(walls, mesh, now_side ? "x_max" : "y_min", now_side ? AnyCondition<2>(side) : AnyCondition<2>(Roller<2>{}));
    walls.finalize();
    expect_near(walls.held({corner}, 0, v), {0, 0});
    walls.begin_stage(false, 0);
    expect_near(walls.held({corner}, 0, v), v - v.dot(normal) * normal);
  }
}

TEST(AbsorbingBoundaries, RecordsBeginWithTheShaking)
{
  Ground ground;
  add_on<2>(ground.walls, ground.mesh, "y_min", PrescribedVelocity<2>{{{1, 2}, {}, record_of_velocity({0, 1, 2}, {0, 10, 0})}});
  ground.walls.finalize();
  const auto n = static_cast<Index>(ground.node({1, 0}));
  expect_near(ground.walls.held({n}, 0.5, {9, 9}), {0, 0});
  ground.walls.begin_stage(false, 3);
  expect_near(ground.walls.held({n}, 3.5, {9, 9}), {5, 10});
  ground.walls.begin_stage(true, 4);
  expect_near(ground.walls.held({n}, 4.5, {9, 9}), {0, 0});
}

TEST(AbsorbingBoundaries, WhatWasKeptFitsOnlyIfItHasANumberForEachDashpot)
{
  Ground ground;
  add_on<2>(ground.walls, ground.mesh, "y_min", Ground::compliant());
  add_on<2>(ground.walls, ground.mesh, "x_max", FreeField<2>(column(), 0));
  ground.walls.finalize();
  EXPECT_TRUE(ground.walls.fits());
  ground.walls.begin_stage(false, 0);
  ground.walls.apply_dashpots(1, 0.2, one_rank(), ground.nodes);
  EXPECT_EQ(ground.reaction().size(), 2u * 5u);  // three nodes below, three beside, of which one is both
  EXPECT_TRUE(ground.walls.fits());
  const std::vector<Real> reaction = ground.reaction();
  const ColumnMotion motion = ground.motion_of(1);
  const auto fits_with = [&](const auto& change) {
    ground.reaction() = reaction, ground.motion_of(1) = motion, ground.reactions_known() = true;
    change();
    return ground.walls.fits();
  };
  EXPECT_FALSE(fits_with([&] { ground.reaction().pop_back(); }));
  EXPECT_FALSE(fits_with([&] { ground.motion_of(1).velocity.pop_back(); }));
  EXPECT_FALSE(fits_with([&] { ground.motion_of(1).traction.pop_back(); }));
  EXPECT_FALSE(fits_with([&] { ground.reactions_known() = false; }));
  EXPECT_TRUE(fits_with([&] { ground.reactions_known() = false, ground.reaction().clear(); }));
}

}  // namespace
}  // namespace talus::testing::absorbing_boundaries_test
