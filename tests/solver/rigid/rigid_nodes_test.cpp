// A block of particles and a rigid body above it: where they touch, what they exchange, and what they do not.
#include <gtest/gtest.h>

#include "tests/solver/contact_kinds.hpp"

namespace talus::testing::rigid_nodes_test {
namespace {

template <class S>
class RigidIn : public ::testing::Test {};
TYPED_TEST_SUITE(RigidIn, ContactKinds);

/// A block that ends at the height `top`, and a ball of this mass whose lowest point is `gap` above it.
template <class S>
Model<S::D> block_and_ball(const Vec<S::D>& v_block, const Vec<S::D>& v_ball, Real mass, Real friction, Real gap = 0,
                           Scheme scheme = Scheme::flip, Real top = 0.5)
{
  constexpr int D = S::D;
  constexpr Index n = D == 2 ? 12 : 8;
  auto m = make_model<typename S::Kernel>(unit_box<D>(n, 0));
  m.problem.transfer = {.scheme = scheme, .musl = scheme != Scheme::flip, .pic_damping_time = {}, .pic_damping_crossings = {}};
  const auto within = [&](const Vec<D>& x) { return (x.template head<D - 1>().array() - 0.5).abs().maxCoeff() < 0.375; };
  add_body<D>(
      m, "block", rubber(1e4, 0.3, 1000), 4, [&](const Vec<D>& x) { return within(x) && x[D - 1] > 0.1 && x[D - 1] < top; },
      [&](const Vec<D>&) { return v_block; });
  RigidBody<D> ball{.name = "ball", .shape = std::make_shared<const RigidShape<D>>(0.25), .mass = mass, .friction = friction, .motion = {}};
  ball.inertia = 0.4 * mass * 0.25 * 0.25 * Mat3::Identity();
  RigidState<D> state;
  state.x = Vec<D>::Constant(0.5), state.x[D - 1] = top + 0.25 + gap, state.v = v_ball;
  m.problem.rigid.bodies = {ball};
  m.state.rigid = {state};
  make_ready(m);
  return m;
}

template <int D>
Vec<D> momentum_of_all(const Model<D>& m)
{
  return totals(m).momentum + m.problem.rigid.bodies[0].mass * m.state.rigid[0].v;
}
template <int D>
Vec3 turn_of_all(const Model<D>& m)
{
  const RigidState<D>& ball = m.state.rigid[0];
  const RigidBody<D>& body = m.problem.rigid.bodies[0];
  Vec3 own = ball.inertia(body) * ball.spin;
  if (D == 2)
    own.template head<2>().setZero();
  return totals(m).angular + body.mass * moment<D>(ball.x, ball.v) + own;
}

TYPED_TEST(RigidIn, ABallThatFallsOntoABlockGivesItsMomentum)
{
  constexpr int D = TypeParam::D;
  auto m = block_and_ball<TypeParam>(along<D>(D - 1, 0.5), along<D>(D - 1, -1) + along<D>(0, 0.5), 50, 0.3);
  const Vec<D> before = momentum_of_all(m);
  const Real speed = m.state.rigid[0].v[D - 1];
  const auto kinetic = [&m] { return m.state.rigid[0].kinetic(m.problem.rigid.bodies[0]); };
  const Real energy = kinetic();
  for (int step = 0; step < 10; ++step)
    advance(m, 1e-4);
  EXPECT_NEAR(kinetic() - energy, -m.state.rigid[0].done.moved, 1e-11 * energy) << "it loses the work that it does";
  EXPECT_LT((momentum_of_all(m) - before).norm(), 1e-11 * totals(m).mass);
  EXPECT_GT(m.state.rigid[0].v[D - 1], speed);
  EXPECT_LT(m.state.rigid[0].done.impulse[D - 1], 0) << "on the block";
  EXPECT_LE(m.state.rigid[0].done.friction, 0);
  EXPECT_LE(m.state.rigid[0].done.arrival, 0);
}

// One step: later ones move the ball to another place, about which the impulses of nodes turn it.
TYPED_TEST(RigidIn, TheMomentOfImpulsesIsExactInAStep)
{
  constexpr int D = TypeParam::D;
  auto m = block_and_ball<TypeParam>(along<D>(D - 1, 0.5), along<D>(D - 1, -1) + along<D>(0, 2), 50, 0.5);
  make_step(m, 1e-6);
  const RigidSums<D>& done = m.state.rigid[0].done;
  const RigidBody<D>& body = m.problem.rigid.bodies[0];
  const Vec3 spin = m.state.rigid[0].spin;
  EXPECT_GT(done.impulse.norm(), 0);
  EXPECT_LT((body.inertia(2, 2) * spin + done.torque).norm(), 1e-9 * done.torque.norm()) << "the tensor of a ball is a number";
  EXPECT_GT(D == 2 ? -spin[2] : spin[1], 0) << "it slides to the right on top, so it rolls to the right";
  end_sweeps(m);
}

TYPED_TEST(RigidIn, NothingIsFeltAcrossAGapAndNothingAttracts)
{
  constexpr int D = TypeParam::D;
  constexpr Real h = D == 2 ? 1.0 / 12 : 1.0 / 8;
  auto apart = block_and_ball<TypeParam>(along<D>(D - 1, 0.5), along<D>(D - 1, -1), 50, 0.3, 0.1 * h + 0.5 * h);
  make_step(apart, 1e-6);
  EXPECT_TRUE(apart.work.rigid.nodes().empty());
  end_sweeps(apart);
  auto parting = block_and_ball<TypeParam>(along<D>(D - 1, -1), along<D>(D - 1, 1), 50, 0.3);
  advance(parting, 1e-6);
  EXPECT_EQ(parting.state.rigid[0].v, (along<D>(D - 1, 1)));
  EXPECT_EQ(parting.state.rigid[0].done.impulse, (Vec<D>(Vec<D>::Zero())));
}

// What exchanges impulses moves with the ball as a part of it, so nodes farther ahead make the ball larger than it is.
TYPED_TEST(RigidIn, OnlyNodesBesideItsSurfaceMoveWithABall)
{
  constexpr int D = TypeParam::D;
  auto m = block_and_ball<TypeParam>(along<D>(D - 1, 0.5), along<D>(D - 1, -1), 50, 0.3);
  make_step(m, 1e-6);
  EXPECT_FALSE(m.work.rigid.nodes().empty());
  for (const RigidNode<D>& at : m.work.rigid.nodes())
    EXPECT_LE((m.problem.mesh.node(at.node) - m.state.rigid[0].x).norm() - 0.25, 0.7 * m.problem.mesh.node_size(at.node) * (1 + 1e-12));
  end_sweeps(m);
}

// The block is pressed together: it moves up faster the farther below it is, and at the lowest point of the ball, off the nodes, both are at rest.
TYPED_TEST(RigidIn, VelocitiesAreComparedAtThePlaceOfContact)
{
  constexpr int D = TypeParam::D;
  const auto impulse = [](Scheme scheme) {
    constexpr Real top = 0.45, sunk = 0.02;
    auto m = block_and_ball<TypeParam>(Vec<D>(Vec<D>::Zero()), Vec<D>(Vec<D>::Zero()), 50, 0, -sunk, scheme, top);
    Mat<D> A = Mat<D>::Zero();
    A(D - 1, D - 1) = -1;
    set_velocity<D>(m, A, along<D>(D - 1, top - sunk));
    for (int step = 0; step < 3; ++step)
      make_step(m, 1e-6);
    end_sweeps(m);
    return -m.state.rigid[0].done.impulse[D - 1];
  };
  EXPECT_GT(impulse(Scheme::flip), 0) << "its particles carry no affine field";
  EXPECT_LT(impulse(Scheme::aflip), 0.02 * impulse(Scheme::flip));
}

TYPED_TEST(RigidIn, FrictionIsAtMostItsCoefficientTimesThePressure)
{
  constexpr int D = TypeParam::D;
  auto m = block_and_ball<TypeParam>(along<D>(D - 1, 0.1), along<D>(D - 1, -0.1) + along<D>(0, 20), 1e6, 0.25);
  make_step(m, 1e-6);
  Real pressed = 0;
  for (const RigidNode<D>& at : m.work.rigid.nodes()) {
    EXPECT_NEAR(at.touch.normal.norm(), 1, 1e-12);
    EXPECT_NEAR(at.rubbed.dot(at.touch.normal), 0, 1e-12 * at.pressed.norm());
    EXPECT_LE(at.rubbed.norm(), 0.25 * at.pressed.norm() * (1 + 1e-9));
    pressed += at.pressed.norm();
  }
  EXPECT_GT(pressed, 0);
  end_sweeps(m);
}

// A body a thousand times lighter than a node: impulses from its velocity before the step would throw it away.
TYPED_TEST(RigidIn, ALightBallIsCarriedByTheBlock)
{
  constexpr int D = TypeParam::D;
  auto m = block_and_ball<TypeParam>(along<D>(D - 1, 1), Vec<D>(Vec<D>::Zero()), 1e-3, 0);
  for (int step = 0; step < 5; ++step)
    advance(m, 1e-5);
  EXPECT_NEAR(m.state.rigid[0].v[D - 1], 1, 0.05);
}

TYPED_TEST(RigidIn, AGivenMotionIsKeptAndMovesTheBlock)
{
  constexpr int D = TypeParam::D;
  auto m = block_and_ball<TypeParam>(Vec<D>(Vec<D>::Zero()), along<D>(D - 1, -1), 50, 0);
  m.problem.rigid.bodies[0].motion = RigidMotion<D>{along<D>(D - 1, -1), Vec3::Zero(), {}};
  for (int step = 0; step < 10; ++step)
    advance(m, 1e-4);
  EXPECT_EQ(m.state.rigid[0].v, (along<D>(D - 1, -1)));
  EXPECT_NEAR(m.state.rigid[0].x[D - 1], 0.75 - 1e-3, 1e-12);
  EXPECT_LT(totals(m).momentum[D - 1], 0);
  EXPECT_LT((totals(m).momentum - m.state.rigid[0].done.impulse).norm(), 1e-11 * totals(m).mass);
}

}  // namespace
}  // namespace talus::testing::rigid_nodes_test
