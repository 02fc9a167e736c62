// Rigid bodies that touch walls and each other, without material.
#include "solver/rigid/rigid_contacts.hpp"

#include <gtest/gtest.h>

namespace talus::rigid_contacts_test {
namespace {

/// The plane through the origin with this unit normal, wide enough for all tests.
RigidWall<2> ground_2d(const Vec<2>& normal)
{
  const Vec<2> along(normal[1], -normal[0]);
  return {"ground", FacetSurface<2>({-200 * along, 200 * along}, {{1, 0}})};
}

FacetSurface<2> block(Real width, Real height)
{
  return {{{-width / 2, -height / 2}, {width / 2, -height / 2}, {width / 2, height / 2}, {-width / 2, height / 2}},
          {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
}

RigidBody<2> ball(Real radius, Real mass, Real friction)
{
  RigidBody<2> body{
      .name = "ball", .shape = std::make_shared<const RigidShape<2>>(radius), .mass = mass, .friction = friction, .motion = {}};
  body.inertia = 0.4 * mass * radius * radius * Mat3::Identity();
  return body;
}
RigidBody<2> brick(Real width, Real height, Real mass, Real friction)
{
  RigidBody<2> body{.name = "brick",
                    .shape = std::make_shared<const RigidShape<2>>(block(width, height)),
                    .mass = mass,
                    .friction = friction,
                    .motion = {}};
  body.inertia = mass * (width * width + height * height) / 12 * Mat3::Identity();
  return body;
}

template <int D>
void run(const RigidScene<D>& scene, const Vec<D>& gravity, Real dt, int steps, std::vector<RigidState<D>>& states)
{
  for (int step = 0; step < steps; ++step) {
    const Real kick = step == 0 ? dt / 2 : dt, mid = (step + 0.5) * dt;
    begin_step<D>(scene, gravity, kick, mid, states);
    std::vector<RigidContact<D>> contacts = find_contacts<D>(scene, states, dt);
    act_on_contacts<D>(scene, dt, contacts, states);
    move<D>(scene, dt, states);
  }
}

/// The way of a sphere down a plane of 45 degrees in 3 s.
Real way_down(Real friction)
{
  const Vec<2> normal = Vec<2>(1, 1).normalized(), down(normal[1], -normal[0]);
  const RigidScene<2> scene{{ball(2, 1e4, friction)}, {ground_2d(normal)}};
  std::vector<RigidState<2>> states(1);
  states[0].x = 2 * normal;
  run<2>(scene, {0, -9.81}, 1e-3, 3000, states);
  EXPECT_NEAR(states[0].x.dot(normal), 2, 1e-3);
  return states[0].x.dot(down);
}

// g sin a t^2 / 2 = 31.22 m without friction; (sin a - mu cos a) while it slides; sin a / (1 + 2/5) once it rolls, from mu = 2/7 tan a on.
TEST(ABall, SlidesOrRollsDownAnIncline)
{
  const Real free = 9.81 * std::sin(std::numbers::pi / 4) * 4.5;
  EXPECT_NEAR(way_down(0), free, 1e-3 * free);
  EXPECT_NEAR(way_down(0.1), 0.9 * free, 1e-3 * free);
  EXPECT_NEAR(way_down(0.2), 0.8 * free, 1e-3 * free);
  EXPECT_NEAR(way_down(0.28), 0.72 * free, 1e-3 * free);
  EXPECT_NEAR(way_down(0.29), free / 1.4, 1e-3 * free);
  EXPECT_NEAR(way_down(1), free / 1.4, 1e-3 * free);
}

TEST(ABrick, RestsOnTheGroundAndOnAnother)
{
  const RigidScene<2> scene{{brick(1, 0.5, 100, 0.5), brick(0.8, 0.5, 300, 0.5)}, {ground_2d({0, 1})}};
  std::vector<RigidState<2>> states(2);
  states[0].x = {0, 0.25}, states[1].x = {0.1, 0.75};
  run<2>(scene, {0, -9.81}, 1e-3, 3000, states);
  EXPECT_LT((states[0].x - Vec<2>(0, 0.25)).norm(), 1e-3);
  EXPECT_LT((states[1].x - Vec<2>(0.1, 0.75)).norm(), 1e-3);
  EXPECT_LT(std::abs(states[0].spin[2]) + std::abs(states[1].spin[2]), 1e-6);
}

// Half of it stands over the edge of the lower one, and a little more.
TEST(ABrick, ThatStandsTooFarOutFalls)
{
  RigidScene<2> scene{{brick(1, 0.5, 100, 0.9), brick(1, 0.5, 100, 0.9)}, {}};
  scene.bodies[0].motion = RigidMotion<2>{};
  std::vector<RigidState<2>> states(2);
  states[1].x = {0.45, 0.5};
  run<2>(scene, {0, -9.81}, 1e-3, 1000, states);
  EXPECT_LT((states[1].x - Vec<2>(0.45, 0.5)).norm(), 1e-3);
  states[1] = {};
  states[1].x = {0.55, 0.5};
  run<2>(scene, {0, -9.81}, 1e-3, 1000, states);
  EXPECT_LT(states[1].spin[2], -0.5);
}

TEST(ABrick, SlidesAsCoulombSays)
{
  const RigidScene<2> scene{{brick(1, 0.5, 100, 0.3)}, {ground_2d({0, 1})}};
  const auto way = [&](Real slope) {
    std::vector<RigidState<2>> states(1);
    states[0].x = {0, 0.25};
    run<2>(scene, {9.81 * slope, -9.81}, 1e-3, 1000, states);
    return states[0].x[0];
  };
  EXPECT_LT(way(0.297), 1e-9);
  EXPECT_NEAR(way(0.6), 9.81 * 0.3 / 2, 0.005 * 9.81 * 0.3 / 2);
}

TEST(RigidBodies, ThatMeetKeepMomentumAndLoseEnergy)
{
  const RigidScene<2> scene{{ball(0.5, 10, 0.4), brick(1, 0.6, 20, 0.4)}, {}};
  std::vector<RigidState<2>> states(2);
  states[0].x = {-1.2, 0.2}, states[0].v = {3, 0}, states[0].spin[2] = 4;
  states[1].x = {0.3, 0};
  const auto sums = [&] {
    Vec<2> linear = Vec<2>::Zero();
    Real angular = 0, energy = 0;
    for (std::size_t r = 0; r < 2; ++r) {
      linear += scene.bodies[r].mass * states[r].v;
      angular += scene.bodies[r].mass * moment<2>(states[r].x, states[r].v)[2] + scene.bodies[r].inertia(2, 2) * states[r].spin[2];
      energy += states[r].kinetic(scene.bodies[r]);
    }
    return std::tuple{linear, angular, energy};
  };
  const auto [p, l, e] = sums();
  run<2>(scene, Vec<2>::Zero(), 1e-3, 600, states);
  const auto [p_end, l_end, e_end] = sums();
  EXPECT_LT((p_end - p).norm(), 1e-11);
  EXPECT_NEAR(l_end, l, 1e-3 * std::abs(l)) << "where they overlap they are moved apart, which turns their momentum";
  EXPECT_LT(e_end, 0.95 * e);
  EXPECT_GT(states[1].v[0], 0.5);
}

/// A wall over the ground from one place to another; its front is above.
RigidWall<2> floor_between(Real from, Real to) { return {"floor", FacetSurface<2>({{from, 0}, {to, 0}}, {{1, 0}})}; }

TEST(AWall, EndsAtItsRim)
{
  const RigidScene<2> scene{{ball(0.3, 10, 0.5), brick(0.4, 0.4, 10, 0.5)}, {floor_between(-1, 1)}};
  std::vector<RigidState<2>> states(2);
  states[0].x = {1.4, -0.2}, states[1].x = {-1.5, -0.3};
  EXPECT_TRUE(find_contacts<2>(scene, states, 1e-3).empty());
  run<2>(scene, {0, -10}, 1e-3, 500, states);
  for (const RigidState<2>& state : states) {
    EXPECT_NEAR(state.v[1], -10 * 0.4995, 1e-12) << "they fall freely";
    EXPECT_EQ(state.v[0], 0);
  }
}

TEST(ABall, RollsOverTheRimOfAWallAndFalls)
{
  const RigidScene<2> scene{{ball(0.3, 10, 0)}, {floor_between(-1, 1)}};
  std::vector<RigidState<2>> states(1);
  states[0].x = {0.8, 0.3}, states[0].v = {1, 0};
  run<2>(scene, {0, -10}, 1e-3, 1000, states);
  EXPECT_LT(states[0].x[1], -1);
  EXPECT_GT(states[0].v[0], 0.99) << "the rim pushes it outwards";
  EXPECT_LT(0.5 * states[0].v.squaredNorm() + 10 * states[0].x[1], 0.5 + 10 * 0.3 + 0.02);
}

TEST(ABrick, SlidesOffTheEndOfAWall)
{
  const RigidScene<2> scene{{brick(1, 0.5, 100, 0)}, {floor_between(-1, 1)}};
  std::vector<RigidState<2>> states(1);
  states[0].x = {0.3, 0.25}, states[0].v = {3, 0};
  run<2>(scene, {0, -10}, 1e-3, 1000, states);
  EXPECT_GT(states[0].x[0], 2.5);
  EXPECT_LT(states[0].x[1], -0.5);
}

TEST(ABrick, SlidesAcrossTheJointOfTwoWalls)
{
  const RigidScene<2> scene{{brick(1, 0.5, 100, 0)}, {floor_between(-20, 0), floor_between(0, 20)}};
  for (const Real speed : {2.0, -2.0, 30.0}) {
    std::vector<RigidState<2>> states(1);
    states[0].x = {-speed / 4, 0.25}, states[0].v = {speed, 0};
    run<2>(scene, {0, -10}, 1e-3, 500, states);
    EXPECT_NEAR(states[0].v[0], speed, 1e-9 * std::abs(speed));
    EXPECT_NEAR(states[0].x[1], 0.25, 1e-4);
  }
}

// Its corner is just past the rims of both.
TEST(AWedge, InACornerOfTwoWallsTouchesBoth)
{
  RigidBody<2> wedge = brick(1, 1, 100, 0);
  wedge.shape = std::make_shared<const RigidShape<2>>(FacetSurface<2>({{-0.6, -0.6}, {0.4, 0.2}, {0.2, 0.4}}, {{0, 1}, {1, 2}, {2, 0}}));
  const RigidScene<2> scene{{wedge}, {floor_between(0, 20), {"left", FacetSurface<2>({{0, 0}, {0, 20}}, {{0, 1}})}}};
  std::vector<RigidState<2>> states(1);
  states[0].x = {0.6 - 1e-4, 0.6 - 2e-4};
  const auto contacts = find_contacts<2>(scene, states, 0);
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_LT((contacts[0].normal - Vec<2>(0, 1)).norm(), 1e-12);
  EXPECT_LT((contacts[1].normal - Vec<2>(1, 0)).norm(), 1e-12);
  EXPECT_NEAR(contacts[0].gap, -2e-4, 1e-12);
  EXPECT_NEAR(contacts[1].gap, -1e-4, 1e-12);
}

TEST(ABrick, IsMovedOutByAFifthOfItsOverlapInAStep)
{
  const RigidScene<2> scene{{brick(1, 0.5, 100, 0.5)}, {ground_2d({0, 1})}};
  std::vector<RigidState<2>> states(1);
  states[0].x = {0, 0.24};
  run<2>(scene, Vec<2>::Zero(), 1e-3, 1, states);
  EXPECT_NEAR(states[0].x[1], 0.24 + 0.2 * 0.01, 1e-5) << "whatever the number of points";
}

// The points of the sheet that are looked at are 0.5 apart, the ball is 0.2 wide.
TEST(ABall, DoesNotPassBetweenTheSamplesOfASheet)
{
  RigidBody<2> sheet{.name = "sheet",
                     .shape = std::make_shared<const RigidShape<2>>(FacetSurface<2>({{-4, 0}, {4, 0}}, {{1, 0}}), FacetsOf::sheet),
                     .mass = 0,
                     .friction = 0.3,
                     .motion = RigidMotion<2>{}};
  for (const Real side : {1.0, -1.0})
    for (const std::size_t of_ball : {0u, 1u}) {
      RigidScene<2> scene{{sheet, sheet}, {}};
      scene.bodies[of_ball] = ball(0.1, 1, 0.3);
      std::vector<RigidState<2>> states(2);
      states[of_ball].x = {0.26, side * 0.5};
      run<2>(scene, {0, -side * 10}, 1e-3, 1000, states);
      EXPECT_NEAR(side * states[of_ball].x[1], 0.1, 1e-4);
      states[of_ball].x = {4.2, side * 0.5}, states[of_ball].v = Vec<2>::Zero();
      run<2>(scene, {0, -side * 10}, 1e-3, 1000, states);
      EXPECT_LT(side * states[of_ball].x[1], -1) << "it falls past the end";
    }
}

// The intermediate axis theorem: rotation about the middle axis turns over, that about the others stays; energy and momentum are kept.
TEST(ABodyInSpace, TumblesWithItsAngularMomentum)
{
  RigidBody<3> body{.name = "book", .shape = std::make_shared<const RigidShape<3>>(1.0), .mass = 1, .friction = 0, .motion = {}};
  body.inertia = Vec3(1, 2, 3).asDiagonal();
  const RigidScene<3> scene{{body}, {}};
  std::vector<RigidState<3>> states(1);
  states[0].spin = {0.01, 5, 0.01};
  const Vec3 momentum = states[0].inertia(body) * states[0].spin;
  const Real energy = states[0].kinetic(body);
  Real least = 1;
  for (int step = 0; step < 4000; ++step) {
    move<3>(scene, 1e-3, states);
    least = std::min(least, (states[0].turn * Vec3::UnitY())[1]);
  }
  EXPECT_LT(least, -0.9) << "it turns over";
  EXPECT_LT((states[0].inertia(body) * states[0].spin - momentum).norm(), 1e-10 * momentum.norm());
  EXPECT_NEAR(states[0].kinetic(body), energy, 5e-3 * energy);
}

}  // namespace
}  // namespace talus::rigid_contacts_test
