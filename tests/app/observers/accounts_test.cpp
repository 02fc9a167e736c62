// The accounts of a run of three stages by hand: every term of every stage is another number.
#include "app/observers/accounts.hpp"

#include <gtest/gtest.h>

#include <array>

#include "kernels/linear.hpp"
#include "materials/interface/constitutive_law_of.hpp"
#include "materials/von_mises.hpp"
#include "mesh/generate/generate.hpp"
#include "solver/transfer/transfer_of.hpp"

namespace talus::accounts_test {
namespace {

/// Two particles of 2 kg and 4 kg, of a metal that has dissipated something in 2 m^3 of the first.
struct Scene {
  Model<2> m = make_model<Linear<2>>(Mesh<2>(box<2>(Vec<2>::Zero(), Vec<2>(1, 1), {1, 1})));
  Stage stage;
  BalanceHistory<2> accounts;

  Scene()
  {
    auto& p = m.state.particles;
    p.id = {0, 1};
    p.mass.push_back(2), p.mass.push_back(4);
    p.x.push_back({1, 3}), p.x.push_back({-2, 1});
    p.v.push_back({0, 0}), p.v.push_back({0, 0});
    p.volume0.push_back(2), p.volume0.push_back(1);
    VonMises law;
    law.density = 1, law.youngs_modulus = 1, law.yield_stress = 1;
    m.state.bodies.push_back({"body", 0, 2, {}});
    m.state.materials.push_back(make_material(law, 0, 2, "body"));
    m.work.order.row = {0, 1}, m.work.order.first = {0, 2}, m.work.order.blocks = 1;
  }
  /// The first particle moves at `speed`, so that the kinetic energy is its square.
  void now(Real speed, Real plastic_work)
  {
    m.state.particles.v.set(0, Vec<2>(speed, 0));
    state_of<VonMises>(m.state.materials[0], 0).plastic_work = plastic_work / 2;
  }
  void see(RunEvent event) { accounts.see(view_of(m, stage), event); }
  EnergyNow energy() const { return accounts.energy(view_of(m, stage)); }
};

/// The terms of the stage at hand, `unit` times those of the first one.
void book_terms(EnergyLedger& e, Real unit)
{
  e.gravity = 1 * unit, e.loads = 10 * unit, e.walls = 100 * unit, e.friction = -1000 * unit, e.waves = 3 * unit, e.damping = -30 * unit;
  e.nodes = 5000 * unit, e.remap = 200 * unit, e.internal = 40000 * unit, e.carried_away = 7 * unit, e.plastic_deleted = 70 * unit;
}

/// gravity + loads + walls = all the others.
void expect_balance(const EnergyNow& e)
{
  EXPECT_EQ(e.defect, e.gravity + e.loads + e.walls -
                          (e.kinetic - e.kinetic_start + e.strain + e.plastic + e.friction + e.damping + e.carried_away + e.transfer));
}

TEST(AccountsByHand, JoinTheEnergiesOfStages)
{
  Scene s;
  s.now(2, 10);
  s.m.state.energy = {.kinetic_start = 4, .plastic_start = 10, .largest_seen = 12345};
  s.see(RunEvent::stage_begins);
  book_terms(s.m.state.energy, 1);
  s.now(3, 14);
  s.see(RunEvent::step_done);
  s.m.state.energy.set_to_rest = 50;
  s.see(RunEvent::stage_done);
  const EnergyNow first = s.energy();
  EXPECT_EQ(first.kinetic_start, 4);
  EXPECT_EQ(first.kinetic, 9);
  EXPECT_EQ(first.plastic, 14 - 10 + 70);
  EXPECT_EQ(first.strain, 40000 - first.plastic);
  EXPECT_EQ(first.damping, 30 + 50) << "with what the stage took out at its end";
  const Real transfer_of_first = 5000 - 200 - (9 + 50 - 4 + 7);
  EXPECT_EQ(first.transfer, transfer_of_first);
  EXPECT_EQ(first.size, 12345);
  expect_balance(first);

  s.m.state.energy = {.kinetic_start = 9 + 6, .plastic_start = 14 - 3};  // what came brought 6 J, what went had dissipated 3 J
  s.see(RunEvent::stage_begins);
  book_terms(s.m.state.energy, 2);
  s.now(4, 22);
  s.m.state.energy.set_to_rest = 500;
  s.see(RunEvent::stage_done);
  const Real transfer_of_second = 2 * (5000 - 200) - (16 + 500 - 15 + 2 * 7);

  s.m.state.energy = {.kinetic_start = 16 - 5, .plastic_start = 22 + 8, .largest_seen = 23456};  // 5 J went; what came had dissipated 8 J
  s.see(RunEvent::stage_begins);
  book_terms(s.m.state.energy, 4);
  s.m.state.energy.internal_ahead = 600, s.m.state.energy.loads_ahead = 6;
  s.now(5, 34);
  s.see(RunEvent::step_done);
  const EnergyNow third = s.energy();
  EXPECT_EQ(third.kinetic_start, 4 + 6);
  EXPECT_EQ(third.kinetic, 25);
  EXPECT_EQ(third.gravity, 7);
  EXPECT_EQ(third.loads, 70 - 6);
  EXPECT_EQ(third.walls, 700);
  EXPECT_EQ(third.waves, 21);
  EXPECT_EQ(third.friction, 7000);
  EXPECT_EQ(third.damping, 210 + 50 + 500);
  EXPECT_EQ(third.carried_away, 49 + 5);
  EXPECT_EQ(third.plastic, 34 - 10 + 490 + 3 - 8);
  EXPECT_EQ(third.strain, 280000 - 600 - third.plastic);
  EXPECT_EQ(third.transfer, transfer_of_first + transfer_of_second + 4 * (5000 - 200) - (25 - 11 + 28));
  EXPECT_EQ(third.size, 23456);
  expect_balance(third);
}

TEST(AccountsByHand, AddUpWhatDissipates)
{
  EnergyNow e;
  e.plastic = 1, e.friction = 2, e.damping = 4, e.transfer = 8;
  EXPECT_EQ(e.dissipated(), 7);
}

TEST(AccountsByHand, MeasureByTheTermOfTheGreatestModulus)
{
  for (Real EnergyNow::*term :
       {&EnergyNow::kinetic_start, &EnergyNow::kinetic, &EnergyNow::strain, &EnergyNow::plastic, &EnergyNow::friction, &EnergyNow::damping,
        &EnergyNow::carried_away, &EnergyNow::gravity, &EnergyNow::loads, &EnergyNow::walls, &EnergyNow::waves, &EnergyNow::size}) {
    EnergyNow e;
    e.kinetic = 3, e.gravity = -5;
    e.*term = -8;
    EXPECT_EQ(e.largest_term(), 8);
  }
}

TEST(AccountsByHand, MeasureDefectsByAllMomentumThereWas)
{
  EXPECT_EQ(share(-1, 4), 0.25);
  EXPECT_EQ(share(1, 0), 0);
  MomentumNow<2> now;
  now.start = {{1, 2}, Vec3::Zero(), 6, 30}, now.given = {{10, 20}, Vec3::Zero(), 14, 10}, now.end = {{14, 26}, Vec3::Zero(), 100, 100};
  now.forces = {0, 0, -10}, now.lost = {0, 0, 20};
  EXPECT_EQ(now.linear_defect(), 0.25) << "5 of 20";
  EXPECT_EQ(now.angular_defect(), 0.25);
  EXPECT_EQ(now.angular_loss(), 0.5);
}

ForceAndMoment<2> push(Real f, Real about) { return ForceAndMoment<2>::of({f, 0}, {0, 0, about}); }

TEST(AccountsByHand, NameAllThatGaveMomentum)
{
  Scene s;
  s.now(5, 0);
  s.m.state.particles.v.set(1, Vec<2>(0, 3));  // at (-2, 1) with 4 kg; the other at (1, 3) with 2 kg
  s.see(RunEvent::stage_begins);
  s.now(7, 0);
  s.m.state.momentum.loads = push(1, -2), s.m.state.momentum.damping = push(4, -8), s.m.state.momentum.rest = push(16, -32);
  s.m.state.momentum.changes = push(64, -128), s.m.state.mass.carried_away = push(256, -512), s.m.state.momentum.on_nodes = {0, 0, 10000};
  BoundaryCondition<2> wall;
  wall.impulse = {1024, 0}, wall.angular = {0, 0, -2048};
  s.m.state.boundary.add(wall);
  const MomentumNow<2> now = s.accounts.momentum(view_of(s.m, s.stage));
  EXPECT_EQ(now.start.linear, Vec<2>(10, 12));
  EXPECT_EQ(now.start.angular, Vec3(0, 0, -3 * 10 - 2 * 12));
  EXPECT_EQ(now.start.size, 22);
  EXPECT_EQ(now.start.turn, 30 + 24);
  EXPECT_EQ(now.end.linear, Vec<2>(14, 12));
  EXPECT_EQ(now.given.linear, Vec<2>(1 + 4 + 16 + 64 - 256 + 1024, 0));
  EXPECT_EQ(now.given.angular, Vec3(0, 0, -2 - 8 - 32 - 128 + 512 - 2048));
  EXPECT_EQ(now.given.size, 1 + 4 + 16 + 64 + 256 + 1024);
  EXPECT_EQ(now.given.turn, 2 + 8 + 32 + 128 + 512 + 2048);
  EXPECT_EQ(now.forces, Vec3(0, 0, 10000 + 2 + 8 + 2048)) << "what nodes got and nobody gave";
  EXPECT_EQ(now.lost, Vec3(0, 0, -54 + (-2 - 8 - 32 - 128 + 512 - 2048) + (10000 + 2 + 8 + 2048) - (-42 - 24)));
}

}  // namespace
}  // namespace talus::accounts_test
