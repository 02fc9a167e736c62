// Boundary conditions: single ones, edges and corners where several meet, friction against its closed forms.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/solver/boundary/nodes_in_a_square.hpp"

namespace talus::testing::boundary_conditions_test {
namespace {

using Placed = std::pair<std::string, AnyCondition<3>>;  // face and condition

/// One node of the unit cube with unit mass and the velocity given; conditions on the faces named.
Vec3 after(const std::vector<Placed>& faces, const Vec3& node_at, const Vec3& v)
{
  const Mesh<3> mesh(box<3>(Vec3::Zero(), Vec3::Ones(), {2, 2, 2}));
  BoundaryConditions<3> walls;
  for (const auto& [face, kind] : faces)
    add_on(walls, mesh, face, kind);
  walls.finalize();
  Nodes<3> nodes;
  nodes.sum.resize(static_cast<std::size_t>(mesh.n_nodes()));
  nodes.motion.resize(nodes.sum.size());
  nodes.active.assign(nodes.sum.size(), 1);
  std::size_t at = 0;
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if ((mesh.node(n) - node_at).norm() < 1e-9)
      at = static_cast<std::size_t>(n);
  for (auto& row : nodes.sum)
    row.mass = 1;
  nodes.motion[at] = {v, v};
  ExactSums<BoundaryWork> work;
  walls.apply(Kick{0.1, 0.1}, nodes, work);
  return nodes.motion[at].v;
}

TEST(BoundaryConditions, FixedStopsAllAndRollerOnlyTheNormal)
{
  EXPECT_EQ(after({{"x_min", Fixed<3>{}}}, {0, 0.5, 0.5}, {1, 2, 3}), Vec3::Zero());
  EXPECT_LT((after({{"x_min", Roller<3>{}}}, {0, 0.5, 0.5}, {1, 2, 3}) - Vec3(0, 2, 3)).norm(), 1e-15);
}

TEST(BoundaryConditions, RollersThatMeetInAnEdgeOrACornerActTogether)
{
  const auto x = Placed{"x_min", Roller<3>{}};
  const auto y = Placed{"y_min", Roller<3>{}};
  const auto z = Placed{"z_min", Roller<3>{}};
  EXPECT_LT((after({x, y}, {0, 0, 0.5}, {1, 2, 3}) - Vec3(0, 0, 3)).norm(), 1e-15);
  EXPECT_LT(after({x, y, z}, {0, 0, 0}, {1, 2, 3}).norm(), 1e-15);
  EXPECT_LT((after({x, y, z}, {0, 0.5, 0}, {1, 2, 3}) - Vec3(0, 2, 0)).norm(), 1e-15);
}

TEST(BoundaryConditions, FixedWinsOverEveryOtherConditionOfANode)
{
  const PrescribedVelocity<3> moving{{Vec3(5, 0, 0)}};
  const Fixed<3> fixed;
  EXPECT_EQ(after({{"x_min", moving}, {"y_min", fixed}}, {0, 0, 0.5}, {1, 2, 3}), Vec3::Zero());
  EXPECT_EQ(after({{"y_min", fixed}, {"x_min", moving}}, {0, 0, 0.5}, {1, 2, 3}), Vec3::Zero());
  EXPECT_EQ(after({{"x_min", moving}}, {0, 0, 0.5}, {1, 2, 3}), Vec3(5, 0, 0));
}

TEST(BoundaryConditions, FrictionSticksBelowTheLimitSlipsAboveAndLetsGo)
{
  const auto face = [](Real mu) { return Placed{"y_min", Friction<3>{mu}}; };
  const Vec3 at(0.5, 0, 0.5);
  EXPECT_LT(after({face(0.5)}, at, {0.4, -1, 0}).norm(), 1e-15);                      // 0.4 < 0.5 * 1: held
  EXPECT_LT((after({face(0.5)}, at, {0.8, -1, 0}) - Vec3(0.3, 0, 0)).norm(), 1e-15);  // 0.8 - 0.5 * 1 is left
  EXPECT_LT((after({face(0.5)}, at, {0.8, 1, 0}) - Vec3(0.8, 1, 0)).norm(), 1e-15);   // leaving: free
}

TEST(BoundaryConditions, FrictionWallsOfACornerLeaveNoPenetration)
{
  const auto floor = Placed{"y_min", Friction<3>{0.3}};
  const auto side = Placed{"x_min", Friction<3>{0.3}};
  const Vec3 v = after({floor, side}, {0, 0, 0.5}, {-1, -2, 5});
  EXPECT_GE(v[0], -1e-12);
  EXPECT_GE(v[1], -1e-12);
  EXPECT_GT(v[2], 5 - 0.3 * 4);  // each wall rubs with its own normal impulse only
  EXPECT_LT(v[2], 5);
}

/// A mesh whose floor is inclined by `angle`; a rubber block lies on it.  Distances along and off the floor.
struct Incline {
  Real angle;
  Vec<2> along(const Vec<2>& x) const
  {
    return {std::cos(angle) * x[0] - std::sin(angle) * x[1], std::sin(angle) * x[0] + std::cos(angle) * x[1]};
  }
  Model<2> block(Real mu) const
  {
    MeshData<2> data = jittered(box<2>({0, 0}, {12, 2}, {36, 6}), 0.15, 1);
    for (Vec<2>& x : data.nodes)
      x = Vec<2>(std::cos(angle) * x[0] + std::sin(angle) * x[1], -std::sin(angle) * x[0] + std::cos(angle) * x[1]);
    auto m = make_model<Umls<2>>(Mesh<2>(std::move(data)));
    add_body<2>(m, "block", rubber(1e6, 0.3, 1000), 4,
                [&](const Vec<2>& x) { return along(x)[0] > 1 && along(x)[0] < 5 && along(x)[1] < 1; });
    m.state.boundary.add({.name = "floor", .kind = Friction<2>{mu}}, m.problem.mesh, *m.problem.mesh.facet_set("y_min"));
    m.problem.loads.gravity.acceleration = {0, -10};
    make_ready(m);
    return m;
  }
  Vec<2> centre(const Model<2>& m) const
  {
    const auto t = totals(m);
    return along(t.centre / t.mass);
  }
};

/// Coulomb's block: s = g (sin - mu cos) t^2 / 2.
class SlidingBlock : public ::testing::TestWithParam<Real> {};

TEST_P(SlidingBlock, FollowsTheClosedFormOnAnInclinedMeshFace)
{
  const Real mu = GetParam(), time = 1;
  const Incline incline{std::numbers::pi / 4};
  auto m = incline.block(mu);
  const Real start = incline.centre(m)[0];
  run_until(m, time);
  const Real exact = 0.5 * 10 * (std::sin(incline.angle) - mu * std::cos(incline.angle)) * time * time;
  EXPECT_NEAR(incline.centre(m)[0] - start, exact, 0.01 * exact);
}
INSTANTIATE_TEST_SUITE_P(Coefficients, SlidingBlock, ::testing::Values(0.0, 0.3, 0.5));

TEST(RestingBlock, DoesNotCreepBelowTheFrictionAngle)
{
  const Incline incline{25 * std::numbers::pi / 180};
  auto m = incline.block(0.5);  // holds up to 26.6 degrees
  Stage rest = test_stage(10);
  rest.damping = 0.7;
  rest.ramp = 0.5;
  rest.residual = 1e-3;
  run_stage(m, rest, StepLimits{.cfl = 0.5}, [](const auto&, RunEvent) {});
  const Vec<2> start = incline.centre(m);
  run_until(m, m.state.clock.time + 1);
  EXPECT_LT((incline.centre(m) - start).norm(), 1e-6);  // of a block 4 m long
}

}  // namespace
}  // namespace talus::testing::boundary_conditions_test
