// Ledgers and their sums by hand, with terms of which no two are alike: a wrong sign, factor or term shows at once.
#include "solver/state/ledger.hpp"

#include <gtest/gtest.h>

#include <array>

#include "solver/state/sums.hpp"

namespace talus::testing::ledger_test {
namespace {

/// Every term another power of two, so that each sum of them belongs to one choice of signs.
EnergyLedger powers_of_two()
{
  EnergyLedger e;
  e.gravity = 1, e.loads = 2, e.walls = 4, e.friction = -8, e.waves = 16, e.damping = -32, e.nodes = 64, e.remap = 128;
  e.internal = 256, e.kinetic_start = 512, e.carried_away = 1024, e.internal_ahead = 2048, e.loads_ahead = 4096;
  return e;
}

TEST(EnergyLedgerByHand, TakesOutWhatWasDoneAfterTheTimeOfTheVelocities)
{
  const EnergyLedger then = powers_of_two().at_velocities();
  EXPECT_EQ(then.internal, 256 - 2048);
  EXPECT_EQ(then.loads, 2 - 4096);
  EXPECT_EQ(then.internal_ahead, 0);
  EXPECT_EQ(then.loads_ahead, 0);
  EXPECT_EQ(then.gravity, 1);
}

TEST(EnergyLedgerByHand, TransferIsWhatNodesGainedAndParticlesDidNotGet)
{
  EXPECT_EQ(powers_of_two().transfer(8192), 64 - 128 - (8192 - 512 + 1024));
}

/// What nodes gained counts by the transfer alone, in which what particles gained and took away cancels.
TEST(EnergyLedgerByHand, DefectIsTheWorkOfWhichNothingIsKnown)
{
  const EnergyLedger e = powers_of_two();
  EXPECT_EQ(e.defect(8192), 1 + 2 + 4 - 8 - 32 - 256 - (64 - 128));
  EXPECT_EQ(e.defect(8192), e.defect(16384));
}

TEST(EnergyLedgerByHand, LargestTermIsThatOfTheGreatestModulus)
{
  EXPECT_EQ(powers_of_two().largest_term(8192), 8192);
  EXPECT_EQ(powers_of_two().largest_term(-8192), 8192);
  for (Real EnergyLedger::*term :
       {&EnergyLedger::kinetic_start, &EnergyLedger::internal, &EnergyLedger::gravity, &EnergyLedger::loads, &EnergyLedger::walls,
        &EnergyLedger::friction, &EnergyLedger::waves, &EnergyLedger::damping, &EnergyLedger::carried_away}) {
    EnergyLedger e = powers_of_two();
    e.*term = -32768;
    EXPECT_EQ(e.largest_term(8192), 32768);
  }
  EnergyLedger e = powers_of_two();
  e.largest_before = 65536;
  EXPECT_EQ(e.largest_term(8192), 65536) << "of the stages before";
}

TEST(Moments, AreCrossProducts)
{
  EXPECT_EQ(moment<2>({2, 3}, {5, 7}), Vec3(0, 0, 2 * 7 - 3 * 5));
  EXPECT_EQ(moment<3>({2, 3, 5}, {7, 11, 19}), Vec3(3 * 19 - 5 * 11, 5 * 7 - 2 * 19, 2 * 11 - 3 * 7));
}

TEST(Pushes, AddForcesMomentsAndTheirModuli)
{
  const ForceAndMoment<2> one = ForceAndMoment<2>::at({2, 1}, {3, 4}), two = ForceAndMoment<2>::of({-6, 8}, {0, 0, -7});
  EXPECT_EQ(one.linear, Vec<2>(3, 4));
  EXPECT_EQ(one.angular, Vec3(0, 0, 5));
  EXPECT_EQ(one.size, 5);
  EXPECT_EQ(one.turn, 5);
  const ForceAndMoment<2> sum = one + two;
  EXPECT_EQ(sum.linear, Vec<2>(-3, 12));
  EXPECT_EQ(sum.angular, Vec3(0, 0, -2));
  EXPECT_EQ(sum.size, 15);
  EXPECT_EQ(sum.turn, 12);
  const ForceAndMoment<2> back = -2 * sum;
  EXPECT_EQ(back.linear, Vec<2>(6, -24));
  EXPECT_EQ(back.angular, Vec3(0, 0, 4));
  EXPECT_EQ(back.size, 30) << "moduli stay positive";
  EXPECT_EQ(back.turn, 24);
}

TEST(MassLedgers, WhatIsDueIsWhatCameLessWhatWent)
{
  MassLedger<2> mass;
  mass.start = 1, mass.placed = 2, mass.deleted = 4, mass.taken = 8;
  EXPECT_EQ(mass.due(), 1 + 2 - 4 - 8);
}

TEST(MassLedgers, BookEverythingThatDeletedParticlesTakeAlong)
{
  MassLedger<3> mass;
  mass.deleted = 1, mass.failed = 2, mass.on_nodes = 4, mass.deleted_count = 8, mass.failed_count = 16, mass.held_count = 32;
  mass.carried_away = ForceAndMoment<3>::of({1, 0, 0}, {0, 1, 0});
  EnergyLedger energy;
  energy.carried_away = 64, energy.plastic_deleted = 128;
  RemovedParticles<3> gone;
  gone.mass = 256, gone.failed = 512, gone.count = 1024, gone.failed_count = 2048, gone.held_count = 4096;
  gone.kinetic = 8192, gone.plastic = 16384;
  gone.momentum = ForceAndMoment<3>::of({3, 0, 4}, {0, 0, 2});
  record_removed(gone, mass, energy);
  EXPECT_EQ(mass.deleted, 1 + 256);
  EXPECT_EQ(mass.failed, 2 + 512);
  EXPECT_EQ(mass.on_nodes, 4 - 512);
  EXPECT_EQ(mass.deleted_count, 8 + 1024);
  EXPECT_EQ(mass.failed_count, 16 + 2048);
  EXPECT_EQ(mass.held_count, 32 + 4096);
  EXPECT_EQ(mass.carried_away.linear, Vec3(4, 0, 4));
  EXPECT_EQ(mass.carried_away.angular, Vec3(0, 1, 2));
  EXPECT_EQ(mass.carried_away.size, 6);
  EXPECT_EQ(mass.carried_away.turn, 3);
  EXPECT_EQ(energy.carried_away, 64 + 8192);
  EXPECT_EQ(energy.plastic_deleted, 128 + 16384);
}

/// Five particles of two bodies in two blocks of cells: (body, block) 0,0: row 2; 0,1: rows 0 and 1; 1,0: row 4; 1,1: row 3.
CellOrder two_bodies_in_two_blocks()
{
  CellOrder order;
  order.row = {2, 0, 1, 4, 3}, order.first = {0, 1, 3, 4, 5}, order.blocks = 2;
  return order;
}

template <int D>
Particles<D> five_particles()
{
  Particles<D> p;
  for (int i = 0; i < 5; ++i) {
    p.id.push_back(i), p.mass.push_back(i + 3);
    Vec<D> x = Vec<D>::Zero(), v = Vec<D>::Zero();
    x[0] = 1, x[1] = i, v[0] = -2, v[1] = 2 * i + 1;
    p.x.push_back(x), p.v.push_back(v);
  }
  return p;
}

template <int D>
void expect_totals_of_the_third()
{
  const auto t = totals_of(five_particles<D>(), 2);  // 5 kg at (1, 2) with (-2, 5) m/s
  EXPECT_EQ(t.mass, 5);
  EXPECT_EQ(t.kinetic, 0.5 * 5 * (4 + 25));
  EXPECT_EQ(t.momentum[0], -10);
  EXPECT_EQ(t.momentum[1], 25);
  EXPECT_EQ(t.angular, Vec3(0, 0, 5 * (1 * 5 + 2 * 2)));
  EXPECT_EQ(t.centre[0], 5);
  EXPECT_EQ(t.centre[1], 10);
}

TEST(TotalsByHand, AreThoseOfAPointMass)
{
  expect_totals_of_the_third<2>();
  expect_totals_of_the_third<3>();
}

TEST(TotalsByHand, OfAllAreTheSumsOfEach)
{
  const auto p = five_particles<2>();
  Communicator alone;
  const Totals<2> all = totals(p, two_bodies_in_two_blocks(), alone);
  Totals<2> expected;
  for (int i = 0; i < 5; ++i) {
    const Real m = i + 3, vy = 2 * i + 1;
    expected.mass += m, expected.kinetic += m * (4 + vy * vy) / 2, expected.momentum += Vec<2>(-2 * m, m * vy);
    expected.angular += Vec3(0, 0, m * (vy + 2 * i)), expected.centre += Vec<2>(m, m * i);
  }
  EXPECT_EQ(all.mass, expected.mass);
  EXPECT_EQ(all.kinetic, expected.kinetic);
  EXPECT_EQ(all.momentum, expected.momentum);
  EXPECT_EQ(all.angular, expected.angular);
  EXPECT_EQ(all.centre, expected.centre);
}

TEST(SumsByHand, TakeTheRangesAndBodiesThatAreAskedFor)
{
  const CellOrder order = two_bodies_in_two_blocks();
  const auto power = [](Index row) { return static_cast<Real>(1 << row); };
  const auto of_bodies = [&](Index first, Index last) {
    ExactSums<Real> sum;
    add_particles(order, {first, last}, sum, power);
    return sum.value();
  };
  EXPECT_EQ(of_bodies(0, 1), 1 + 2 + 4);
  EXPECT_EQ(of_bodies(1, 2), 8 + 16);
  EXPECT_EQ(of_bodies(1, 1), 0);
  ExactSums<Real> all, none, ranges;
  add_particles(order, all, power);
  EXPECT_EQ(all.value(), 31);
  add_particles(CellOrder{}, none, power);
  EXPECT_EQ(none.value(), 0);
  const std::array<IndexRange, 3> some{IndexRange{0, 2}, IndexRange{3, 3}, IndexRange{4, 5}};
  add_ranges<Real>(some, ranges, power);
  EXPECT_EQ(ranges.value(), 1 + 2 + 16);
}

}  // namespace
}  // namespace talus::testing::ledger_test
