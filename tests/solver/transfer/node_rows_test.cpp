// Rows of nodes and hats: how they add up and when they count as seen; the share of PIC.
#include <gtest/gtest.h>

#include "solver/options/transfer_options.hpp"
#include "solver/state/nodes.hpp"

namespace talus::node_rows_test {
namespace {

NodeSum<2> row(Real mass, float lightest, float gross, const Vec<2>& momentum, const Vec<2>& force)
{
  NodeSum<2> sum;
  sum.mass = mass, sum.lightest = lightest, sum.gross = gross, sum.momentum = momentum, sum.force = force;
  return sum;
}

TEST(NodeRows, AddUpEntryByEntryAndKeepTheLightestParticle)
{
  for (const bool turned : {false, true}) {
    NodeSum<2> a = row(1, 7, 2, {3, 4}, {5, 6});
    NodeSum<2> b = row(10, 3, 20, {30, 40}, {50, 60});
    if (turned)
      std::swap(a, b);
    a += b;
    EXPECT_EQ(a.mass, 11);
    EXPECT_EQ(a.lightest, 3);
    EXPECT_EQ(a.gross, 22);
    EXPECT_EQ(a.momentum, Vec<2>(33, 44));
    EXPECT_EQ(a.force, Vec<2>(55, 66));
  }
}

TEST(NodeRows, HandOnTheirMomentumAlone)
{
  NodeSum<2> a = row(1, 7, 2, {3, 4}, {5, 6});
  EXPECT_TRUE(a.has_momentum());
  a.add_momentum(row(10, 3, 20, {30, 40}, {50, 60}));
  EXPECT_EQ(a.momentum, Vec<2>(33, 44));
  EXPECT_EQ(a.mass, 1);
  EXPECT_EQ(a.lightest, 7);
  a.clear_momentum();
  EXPECT_FALSE(a.has_momentum());
  EXPECT_EQ(a.force, Vec<2>(5, 6));
}

TEST(NodeRows, AreSeenOnceAParticleIsNear)
{
  NodeSum<2> sum;
  EXPECT_FALSE(sum.is_seen());
  sum.lightest = 1;
  EXPECT_TRUE(sum.is_seen());
  NodeMotion<2> motion;
  EXPECT_FALSE(motion.is_seen());
  motion.v = {0, 1e-300};
  EXPECT_TRUE(motion.is_seen());
  motion = {{0, 0}, {-1, 0}};
  EXPECT_TRUE(motion.is_seen());
  motion = {{0, 0}, {0, -0.0}};
  EXPECT_TRUE(motion.is_seen()) << "any bit of it";
}

TEST(NodeRows, OfHatsHaveMomentumIfTheyHaveAnAffineField)
{
  ProjectedNodeSum<2> shape_value, other;
  EXPECT_FALSE(shape_value.has_momentum());
  other.momentum = {1, 2};
  EXPECT_TRUE(other.has_momentum());
  other.momentum.setZero();
  other.affine << 1, 2, 3, 4;
  EXPECT_TRUE(other.has_momentum());
  other.momentum = {5, 6};
  shape_value.add_momentum(other), shape_value.add_momentum(other);
  EXPECT_EQ(shape_value.momentum, Vec<2>(10, 12));
  EXPECT_EQ(shape_value.affine, 2 * other.affine);
  EXPECT_EQ(shape_value.momentum_about({1, -1}), Vec<2>(10 - 2, 12 - 2));
  other.tension << 7, 8, 9, 10;
  shape_value += other;
  shape_value += other;
  EXPECT_EQ(shape_value.affine, 4 * other.affine);
  EXPECT_EQ(shape_value.tension, 2 * other.tension);
  shape_value.clear_momentum();
  EXPECT_FALSE(shape_value.has_momentum());
}

TEST(Transfer, TheShareOfPicIsTheStepByItsTimeAndAtMostOne)
{
  TransferOptions transfer;
  EXPECT_EQ(transfer.pic_share(0.5, 0.125, false), 0);
  transfer.pic_damping_time = 2;
  EXPECT_EQ(transfer.pic_share(0.5, 0.125, false), 0.25);
  EXPECT_EQ(transfer.pic_share(3, 0.125, false), 1);
  transfer.pic_damping_time.reset();
  transfer.pic_damping_crossings = 16;
  EXPECT_EQ(transfer.pic_share(0.5, 0.125, false), 0.25);
  EXPECT_EQ(transfer.pic_share(3, 0.125, false), 1);
  EXPECT_EQ(transfer.pic_share(0.5, 0, false), 0) << "not known";
}

TEST(Transfer, DampingOfAflipFollowsTheFallOfABodyThatFlowsAndTheWaveElsewhere)
{
  const auto damping = [](const TransferOptions& given, Real fall, bool flows) {
    const TransferOptions all = given.with_damping(fall, flows);
    return std::pair{all.pic_damping_time.value_or(0), all.pic_damping_crossings.value_or(0)};
  };
  const TransferOptions aflip, flip{.scheme = Scheme::flip};
  EXPECT_EQ(damping(aflip, 0.5, true), (std::pair<Real, Real>{0.5, 25})) << "waves where a stage seeks rest";
  EXPECT_EQ(damping(aflip, 0.5, false), (std::pair<Real, Real>{0, 25})) << "only elastic bodies";
  EXPECT_EQ(damping(aflip, 0, true), (std::pair<Real, Real>{0, 25})) << "no gravity";
  EXPECT_EQ(damping(flip, 0.5, true), (std::pair<Real, Real>{0, 0}));
  TransferOptions given;
  given.pic_damping_fall_times = 3;
  EXPECT_EQ(damping(given, 0.5, false), (std::pair<Real, Real>{1.5, 0}));
  given = {};
  given.pic_damping_crossings = 100;
  EXPECT_EQ(damping(given, 0.5, true), (std::pair<Real, Real>{0, 100}));
  given = {};
  given.pic_damping_time = 7;
  EXPECT_EQ(damping(given, 0.5, true), (std::pair<Real, Real>{7, 0}));

  const TransferOptions both = aflip.with_damping(0.5, true);
  EXPECT_EQ(both.pic_share(0.1, 0.02, false), 0.1 / 0.5);
  EXPECT_EQ(both.pic_share(0.1, 0.02, true), 0.1 / (25 * 0.02));
  EXPECT_EQ(given.pic_share(0.1, 0.02, true), 0.1 / 7) << "as given";
}

TEST(Transfer, SymmetricAffineFlipIsDampedWhereAStageSeeksRest)
{
  const TransferOptions free = TransferOptions{.scheme = Scheme::saflip}.with_damping(0.5, true);
  EXPECT_EQ(free.pic_share(0.1, 0.02, false), 0);
  EXPECT_EQ(free.pic_share(0.1, 0.02, true), 0.1 / (25 * 0.02));
  const TransferOptions given = TransferOptions{.scheme = Scheme::saflip, .pic_damping_crossings = 100}.with_damping(0.5, true);
  EXPECT_EQ(given.pic_share(0.1, 0.02, false), 0.1 / (100 * 0.02));
}

TEST(Transfer, KindsOfSchemes)
{
  const auto of = [](Scheme scheme, bool musl) {
    return TransferOptions{.scheme = scheme, .musl = musl, .pic_damping_time = {}, .pic_damping_crossings = {}};
  };
  EXPECT_TRUE(TransferOptions{.scheme = Scheme::flip}.uses_musl() && TransferOptions{.scheme = Scheme::aflip}.uses_musl());
  EXPECT_FALSE(TransferOptions{.scheme = Scheme::apic}.uses_musl() || TransferOptions{.scheme = Scheme::tpic}.uses_musl());
  for (const Scheme scheme : {Scheme::flip, Scheme::apic, Scheme::tpic, Scheme::aflip, Scheme::saflip})
    for (const bool musl : {false, true}) {
      const TransferOptions transfer = of(scheme, musl);
      EXPECT_EQ(transfer.affine(), scheme != Scheme::flip && scheme != Scheme::saflip);
      EXPECT_EQ(transfer.increments(), scheme == Scheme::flip || scheme == Scheme::aflip || scheme == Scheme::saflip);
      EXPECT_EQ(transfer.own_affine_field(), scheme == Scheme::apic || (musl && transfer.affine()));
    }
}

}  // namespace
}  // namespace talus::node_rows_test
