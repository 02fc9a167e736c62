// What walls do to a node: velocities, impulses and their moments, and the work, by the formulas of one mass that is pushed.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/solver/boundary/nodes_in_a_square.hpp"

namespace talus::testing::wall_nodes_test {
namespace {

constexpr Real rounding = 1e-13;

/// The unit square in two by two, with walls on its sides; one node has a mass of its own and moves.
struct Square : NodesInASquare {
  static constexpr Real mass = 2;
  static constexpr Kick kick{0.2, 0.6};
  Square() : NodesInASquare(1, kick.length()) {}
  void hold(const std::string& side, const AnyCondition<2>& kind) { add_on(walls, mesh, side, kind); }
  /// The motion of a node that came with v - change, went on with v, and then met the walls.
  NodeMotion<2> meet(const Vec<2>& place, const Vec<2>& v, const Vec<2>& change)
  {
    const NodeMotion<2>& motion = set(place, mass, {v, change});
    walls.apply(kick, nodes, work);
    walls.keep_impulses();
    return motion;
  }
  /// What the walls leave of a remapped velocity, where that of the step was `of_step`.
  Vec<2> held_after_remap(const Vec<2>& place, const Vec<2>& v, const Vec<2>& of_step)
  {
    const std::size_t n = node(place);
    nodes.remapped.resize(nodes.sum.size());
    nodes.remapped[n] = {v, of_step};
    walls.hold(0, nodes);
    return nodes.remapped[n].v;
  }
  const BoundaryCondition<2>& first() const { return walls.conditions().front(); }
};

void expect_near(const Vec<2>& a, const Vec<2>& b) { EXPECT_LT((a - b).norm(), rounding) << a.transpose() << " is not " << b.transpose(); }

/// Twice as fast every second.
Table growing()
{
  Table table;
  table.points = {{0, 0}, {10, 10}};
  return table;
}

TEST(NodesAtWalls, AMovingWallGivesItsVelocityAndKeepsItsImpulse)
{
  Square square;
  square.hold("x_min", PrescribedVelocity<2>{{Vec<2>(3, 1), growing()}});
  square.walls.finalize();
  const Vec<2> v(1, 0.5), change(0.5, -0.25), old = v - change;
  const NodeMotion<2> now = square.meet({0, 0.5}, v, change);
  const Vec<2> end = 0.6 * Vec<2>(3, 1), impulse = 2 * (end - v), mean = 0.4 * Vec<2>(3, 1);
  expect_near(now.v, end);
  expect_near(now.change, end - old);
  expect_near(square.first().impulse, impulse);
  EXPECT_NEAR(square.first().angular[2], -0.5 * impulse[0], rounding);
  const BoundaryWork work = square.work.value();
  EXPECT_NEAR(work.turned[2], -0.5 * impulse[0], rounding);
  EXPECT_EQ(work.friction, 0);
  EXPECT_NEAR(work.moved, impulse.dot(mean), rounding);
  EXPECT_NEAR(work.arrival, impulse.dot(0.5 * (old + end)) - impulse.dot(mean), rounding);
  EXPECT_EQ(work.waves, 0);

  square.meet({0, 0.5}, v, change);
  expect_near(square.first().impulse, 2 * impulse);
}

TEST(NodesAtWalls, TheFirstOfTwoMovingWallsCounts)
{
  for (const bool turned : {false, true}) {
    Square square;
    square.hold(turned ? "y_min" : "x_min", PrescribedVelocity<2>{{Vec<2>(3, 1)}});
    square.hold(turned ? "x_min" : "y_min", PrescribedVelocity<2>{{Vec<2>(7, 2)}});
    square.walls.finalize();
    expect_near(square.meet({0, 0}, {1, 1}, {0, 0}).v, {3, 1});
    EXPECT_EQ(square.walls.holder_of(static_cast<Index>(square.node({0, 0}))), 0);
    EXPECT_EQ(square.walls.holder_of(static_cast<Index>(square.node({1, 1}))), none);
  }
}

TEST(NodesAtWalls, ARollerTakesTheKineticEnergyOfTheNormalVelocity)
{
  Square square;
  square.hold("y_min", Roller<2>{});
  square.walls.finalize();
  const Vec<2> v(1, -3), change(0.5, -1);
  const NodeMotion<2> now = square.meet({0.5, 0}, v, change);
  expect_near(now.v, {1, 0});
  expect_near(now.change, {0.5, 2});
  expect_near(square.first().impulse, {0, 6});
  EXPECT_NEAR(square.first().angular[2], 0.5 * 6, rounding);
  const BoundaryWork work = square.work.value();
  EXPECT_EQ(work.friction, 0);
  EXPECT_EQ(work.moved, 0);
  EXPECT_NEAR(work.arrival, 6 * 0.5 * (-2 + 0), rounding);
}

TEST(NodesAtWalls, FrictionRubsByItsCoefficientTimesTheImpulse)
{
  Square square;
  square.hold("y_min", Friction<2>{0.25});
  square.walls.finalize();
  const Vec<2> v(2, -4), change(1, -1), old = v - change;
  const NodeMotion<2> now = square.meet({0.5, 0}, v, change);
  expect_near(now.v, {1, 0});  // 2 - 0.25 * 4
  expect_near(square.first().impulse, {-2, 8});
  EXPECT_NEAR(square.first().angular[2], 0.5 * 8, rounding);
  const BoundaryWork work = square.work.value();
  EXPECT_NEAR(work.friction, -2 * 0.5 * (old[0] + 1), rounding);
  EXPECT_EQ(work.moved, 0);
  EXPECT_NEAR(work.arrival, 8 * 0.5 * (old[1] + 0), rounding);

  // it rubs now, so that what is remapped is replaced by the step's own
  expect_near(square.held_after_remap({0.5, 0}, {5, 6}, {7, 8}), {7, 8});
}

TEST(NodesAtWalls, FrictionSticksExactlyAndLetsGo)
{
  Square square;
  square.hold("y_min", Friction<2>{0.5});
  square.walls.finalize();
  expect_near(square.meet({0.5, 0}, {1, -4}, {0, 0}).v, {0, 0});
  expect_near(square.first().impulse, {-2, 8});
  expect_near(square.meet({0.5, 0}, {1, 4}, {0, 0}).v, {1, 4});
  expect_near(square.first().impulse, {-2, 8});

  // it does not rub any more: held back from going in, not from leaving
  expect_near(square.held_after_remap({0.5, 0}, {5, -6}, {7, 8}), {5, 0});
  expect_near(square.held_after_remap({0.5, 0}, {5, 6}, {7, 8}), {5, 6});
}

TEST(NodesAtWalls, PlanesThatNothingTouchesDoNotAct)
{
  Square square;
  square.hold("x_min", Friction<2>{0});
  square.hold("y_min", Friction<2>{0.25, true});
  square.walls.finalize();
  const auto planes = square.walls.gap_planes();
  ASSERT_EQ(planes.size(), 3u) << "of three nodes on the one wall with a gap";
  for (const auto& plane : planes)
    expect_near(plane.normal, {0, -1});
  const std::size_t n = square.node({0, 0});
  const auto of_corner = std::ranges::find(planes, static_cast<Index>(n), [](const auto& plane) { return plane.node; });
  ASSERT_NE(of_corner, planes.end());

  square.nodes.open.assign(square.nodes.sum.size(), 0);
  square.nodes.open[n] = static_cast<std::uint8_t>(1 << of_corner->number);
  const Vec<2> into_both(-2, -4), out_of_one(0, -4);
  expect_near(square.meet({0, 0}, into_both, {0, 0}).v, out_of_one);
  expect_near(square.first().impulse, {4, 0});
  const NodeOfField corner = square.nodes.of_field(static_cast<Index>(n));
  expect_near(square.walls.held(corner, 0, into_both), out_of_one);
  expect_near(square.walls.held({corner.node}, 0, into_both), {0, 0});
  square.nodes.slides[n] = 0;
  expect_near(square.held_after_remap({0, 0}, into_both, {7, 8}), out_of_one);
  NodeMotion<2> alone{into_both, {0, 0}};
  square.walls.apply(corner, Square::kick, 4, alone, square.work);
  expect_near(alone.v, out_of_one);
  SparseRows<ProjectedNodeSum<2>> sums(square.nodes.sum.size());
  SparseRows<ProjectedNodeMotion<2>> projected(sums.size());
  sums[n].mass = 5, sums[n].lightest = 1;
  projected[n].v = into_both;
  square.walls.apply(Square::kick, square.nodes, sums, projected, 0, square.work);
  expect_near(projected[n].v, out_of_one);
}

TEST(NodesAtWalls, ARollerAndAFrictionWallInACornerBothHold)
{
  Square square;
  square.hold("x_min", Roller<2>{});
  square.hold("y_min", Friction<2>{0.25});
  square.walls.finalize();
  const NodeMotion<2> now = square.meet({0, 0}, {-3, -4}, {0, 0});
  expect_near(now.v, {0, 0});
  expect_near(square.walls.conditions()[0].impulse, {6, 0});
  expect_near(square.walls.conditions()[1].impulse, {0, 8});
  expect_near(square.walls.held({static_cast<Index>(square.node({0, 0}))}, 0, {5, -6}), {0, 0});
  expect_near(square.walls.held({static_cast<Index>(square.node({0, 0}))}, 0, {5, 6}), {0, 6});
  expect_near(square.walls.held({static_cast<Index>(square.node({1, 1}))}, 0, {5, -6}), {5, -6});
}

/// Two facets of a floor that bends by an angle: the node between has one normal or two.
Vec<2> after_a_bend(Real degrees, const Vec<2>& v)
{
  MeshData<2> data = box<2>({-1, 0}, {1, 1}, {2, 1});
  for (Vec<2>& x : data.nodes)
    if (x[0] > 0.5 && x[1] < 0.5)
      x[1] = -std::tan(degrees * std::numbers::pi / 180);
  const Mesh<2> mesh(std::move(data));
  BoundaryConditions<2> walls;
  walls.add({.name = "floor", .kind = Roller<2>{}}, mesh, *mesh.facet_set("y_min"));
  walls.finalize();
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (mesh.node(n).norm() < 1e-9)
      return walls.held({n}, 0, v);
  return v;
}

TEST(NodesAtWalls, FacetsOfASmoothSurfaceShareTheirMeanNormalUpToThirtyDegrees)
{
  const Vec<2> v(2, 3);
  const Real angle = 29.5 * std::numbers::pi / 180, length = 1 / std::cos(angle);
  const Vec<2> mean = Vec<2>(-length * std::sin(angle), -1 - length * std::cos(angle)).normalized();  // by the areas 1 and `length`
  expect_near(after_a_bend(29.5, v), v - v.dot(mean) * mean);
  expect_near(after_a_bend(30.5, v), {0, 0});
}

TEST(NodesAtWalls, ClosedAreFacetsOfPlanesAndThoseWhoseNodesAreAllHeld)
{
  const auto places = [](const Square& square) {
    std::vector<std::pair<Real, Real>> sorted;
    for (const Facet facet : square.walls.closed_facets(square.mesh)) {
      Vec<2> middle = Vec<2>::Zero();
      for (const Index n : square.mesh.nodes_of(facet))
        middle += square.mesh.node(n) / 2;
      sorted.emplace_back(middle[0], middle[1]);
    }
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  };
  using Places = std::vector<std::pair<Real, Real>>;
  Square square;
  square.hold("x_min", Fixed<2>{});
  square.walls.finalize();
  EXPECT_EQ(places(square), (Places{{0, 0.25}, {0, 0.75}}));
  Square other;
  other.hold("x_min", PrescribedVelocity<2>{});
  other.hold("y_min", Roller<2>{});
  other.walls.finalize();
  EXPECT_EQ(places(other), (Places{{0, 0.25}, {0, 0.75}, {0.25, 0}, {0.75, 0}}));
}

/// Velocities with which particles move obey; the impulse on particles is what their own mean velocity needs, and all of it for what they take
/// from the nodes as it is.
TEST(NodesAtWalls, HatsPushParticlesOnlyAsFarAsTheseDoNotObeyAlready)
{
  struct Case {
    Real own, pic, share, impulse;
  };
  for (const Case& one : {Case{-2, 0, 1, 10}, Case{-0.5, 0, 0.25, 2.5}, Case{1, 0, 0, 0}, Case{1, 0.1, 0, 1}, Case{-0.5, 1, 0.25, 10}}) {
    Square square;
    square.hold("y_min", Friction<2>{0});
    square.walls.finalize();
    const std::size_t n = square.node({0.5, 0});
    SparseRows<ProjectedNodeSum<2>> sums(square.nodes.sum.size());
    SparseRows<ProjectedNodeMotion<2>> projected(sums.size());
    sums[n].mass = 5, sums[n].lightest = 1;
    sums[n].momentum = 5 * (Vec<2>(3, one.own) - Vec<2>(0, 0.25));
    projected[n].v = {3, -2}, projected[n].change = {0, 0.25};
    square.walls.apply(Square::kick, square.nodes, sums, projected, one.pic, square.work);
    square.walls.keep_impulses();
    expect_near(projected[n].v, {3, 0});
    expect_near(projected[n].change, {0, 0.25 + 2 * one.share});
    expect_near(square.first().impulse, {0, one.impulse});
  }
}

TEST(NodesAtWalls, HatsAndSlavesArePushedWithTheirOwnMass)
{
  Square square;
  square.hold("x_min", PrescribedVelocity<2>{{Vec<2>(3, 1)}});
  square.walls.finalize();
  const std::size_t n = square.node({0, 0.5}), unseen = square.node({0, 1});
  SparseRows<ProjectedNodeSum<2>> sums(square.nodes.sum.size());
  SparseRows<ProjectedNodeMotion<2>> projected(sums.size());
  sums[n].mass = 5, sums[n].lightest = 1;
  projected[n].v = {1, 1};
  square.walls.apply(Square::kick, square.nodes, sums, projected, 0, square.work);
  square.walls.keep_impulses();
  expect_near(projected[n].v, {3, 1});
  expect_near(projected[n].change, {2, 0});
  expect_near(projected[unseen].v, {0, 0});
  expect_near(square.first().impulse, {10, 0});

  NodeMotion<2> small_mass_node{{2, 1}, {0, 0}};
  square.walls.apply({static_cast<Index>(n)}, Square::kick, 4, small_mass_node, square.work);
  square.walls.keep_impulses();
  expect_near(small_mass_node.v, {3, 1});
  expect_near(square.first().impulse, {14, 0});
  NodeMotion<2> free{{2, 1}, {0, 0}};
  square.walls.apply({static_cast<Index>(square.node({1, 1}))}, Square::kick, 4, free, square.work);
  expect_near(free.v, {2, 1});
}

}  // namespace
}  // namespace talus::testing::wall_nodes_test
