// What no sound run does is seen, told, and answered as the guards say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::guards_test {
namespace {

using ::testing::HasSubstr;
using M = Model<2>;

M flying_block()
{
  M m = make_model<Projected<2>>(unit_box<2>(8, 0.1));
  add_body<2>(m, "block", rubber(1e5, 0.3, 1000), 3, [](const Vec<2>& x) { return (x.array() > 0.3).all() && (x.array() < 0.7).all(); });
  make_ready(m);
  set_velocity<2>(m, Mat<2>::Zero(), Vec<2>(1, 0.5));
  return m;
}

/// Message of a stage that is stopped, empty if it is not; counts how often the state was shown before.
std::string stopped(M& m, int* shown = nullptr)
{
  try {
    finish_stage(m, test_stage(0.2), {}, [&](const M&, RunEvent event) {
      if (shown && event == RunEvent::given_up)
        ++*shown;
    });
  } catch (const RunError& e) {
    return e.what();
  }
  return {};
}

TEST(RunLimits, ASoundRunPasses)
{
  M m = flying_block();
  m.problem.limits.speed = 3, m.problem.limits.gain = 0.01;
  begin_stage(m, test_stage(0.2), 0);
  EXPECT_EQ(stopped(m), "");
  EXPECT_NEAR(m.state.monitor.fastest, std::sqrt(1.25), 1e-6);
  EXPECT_LT(m.state.monitor.mass, 1e-12);
  EXPECT_LT(m.state.monitor.gain, 1e-6);
}

TEST(RunLimits, MassThatIsNotThereIsMissed)
{
  M m = flying_block();
  m.state.mass.start *= 1 + 1e-6;
  begin_stage(m, test_stage(0.2), 0);
  int shown = 0;
  EXPECT_THAT(stopped(m, &shown), HasSubstr("the mass does not add up"));
  EXPECT_EQ(shown, 1) << "before the run gives up its state can be kept";
}

TEST(RunLimits, EnergyFromNowhereIsSeen)
{
  const auto with_a_push = [](Real gain, bool stops) {
    M m = flying_block();
    m.problem.limits.gain = gain, m.problem.limits.gain_stops = stops;
    begin_stage(m, test_stage(0.2), 0);
    for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
      m.state.particles.v.set(p, 1.2 * m.state.particles.v[p]);
    const std::string message = stopped(m);
    return std::pair{message, m.state.monitor};
  };
  constexpr Real gained = 0.44 / 1.44;
  EXPECT_THAT(with_a_push(0.9 * gained, true).first, HasSubstr("energy grows by what nothing did work for, 0.306 of its largest term"));
  EXPECT_EQ(with_a_push(1.1 * gained, true).first, "");
  const auto [message, seen] = with_a_push(0.9 * gained, false);
  EXPECT_EQ(message, "");
  EXPECT_GT(seen.gaining, 1);
  EXPECT_NEAR(seen.gain, gained, 1e-3);
}

TEST(RunLimits, TheEndOfAStageIsLookedAt)
{
  const auto short_stage = [](M& m) -> std::string {
    const Stage stage = test_stage(1e-4);
    begin_stage(m, stage, 0);
    try {
      finish_stage(m, stage, {}, [](const M&, RunEvent) {});
    } catch (const RunError& e) {
      return e.what();
    }
    return {};
  };
  M fast = flying_block();
  fast.problem.limits.speed = 1;
  EXPECT_THAT(short_stage(fast), HasSubstr("beyond watch.speed"));
  EXPECT_EQ(fast.state.clock.step, 1);
  EXPECT_EQ(fast.state.monitor.speeding, 0) << "it is looked at again when the run goes on";
  M light = flying_block();
  light.state.mass.start *= 1 + 1e-6;
  EXPECT_THAT(short_stage(light), HasSubstr("the mass does not add up"));
  M sound = flying_block();
  EXPECT_EQ(short_stage(sound), "");
  EXPECT_NEAR(sound.state.monitor.fastest, std::sqrt(1.25), 1e-6);
  sound.problem.limits.speed = 1, sound.problem.limits.speed_stops = false;
  EXPECT_EQ(short_stage(sound), "");
  EXPECT_EQ(sound.state.monitor.speeding, 1) << "once for each step, and none for the state that the stage began with";
}

/// One particle is turned inside out before the first step.
M with_a_failed_particle(Real allowed)
{
  M m = flying_block();
  Mat3 F = Mat3::Identity();
  F(0, 0) = -1;
  m.problem.limits.failed = allowed;
  begin_stage(m, test_stage(0.2), 0);
  m.state.particles.F.set(5, F);
  return m;
}

TEST(RunLimits, AFailedParticleStopsTheRunUnlessItMayGo)
{
  M m = with_a_failed_particle(0);
  const std::string message = stopped(m);
  EXPECT_THAT(message, HasSubstr("particle 5"));
  EXPECT_THAT(message, HasSubstr("turned inside out"));

  M without = with_a_failed_particle(0.1);
  const Index before = without.state.particles.size();
  EXPECT_EQ(stopped(without), "");
  EXPECT_EQ(without.state.particles.size(), before - 1);
  EXPECT_EQ(without.state.mass.failed_count, 1);
  EXPECT_NEAR(totals(without).mass + without.state.mass.failed, without.state.mass.start, 1e-12 * without.state.mass.start);
  EXPECT_THAT(without.state.monitor.failure, HasSubstr("particle 5"));
  EXPECT_TRUE(std::isfinite(without.state.energy.internal));
  EXPECT_NEAR(without.state.energy.carried_away, 0.5 * without.state.mass.failed * 1.25, 1e-2 * without.state.mass.failed);
}

TEST(RunLimits, WhatFailedInTheLastStepIsNotMissed)
{
  M m = with_a_failed_particle(0.1);
  const Stage stage = test_stage(1e-4);
  begin_stage(m, stage, 0);
  EXPECT_NO_THROW(finish_stage(m, stage, {}, [](const M&, RunEvent) {}));
  EXPECT_EQ(m.state.mass.failed_count, 1);
  EXPECT_EQ(m.state.clock.step, 1);
}

TEST(RunLimits, NoMoreMayFailThanIsAllowed)
{
  M m = with_a_failed_particle(1e-6);
  EXPECT_THAT(stopped(m), HasSubstr("beyond watch.failed_mass = 1e-06"));
}

}  // namespace
}  // namespace talus::testing::guards_test
