// A Prony series against its closed forms: relaxation, creep, and steady oscillation.
#include <gmock/gmock.h>

#include <array>
#include <complex>

#include "tests/materials/samples.hpp"

namespace talus::viscoelastic_test {
namespace {

using testing::Point;
using testing::sample;

std::array<PronyTerm, 3> terms(const Viscoelastic& law)
{
  return {PronyTerm{law.relaxing_share, law.relaxation_time}, law.second.value(), law.third.value()};
}

/// The relaxation modulus over that of fast loading.
Real relaxed(const Viscoelastic& law, Real time)
{
  Real share = 1;
  for (const PronyTerm& term : terms(law))
    share -= term.share * (1 - std::exp(-time / term.time));
  return share;
}

Mat3 shear_by(Real angle)
{
  Mat3 F = Mat3::Identity();
  F(0, 1) = angle;
  return F;
}

TEST(Viscoelastic, StressAtConstantStrainFollowsTheSeries)
{
  Point<Viscoelastic> point{.law = sample<Viscoelastic>()};
  constexpr Real angle = 1e-6, dt = 1e-3;
  point.step(shear_by(angle), true, 1e-12);  // at once
  const Real start = point.stress(0, 1);
  EXPECT_NEAR(start, point.constants.shear * angle, 1e-6 * start);
  for (int i = 1; i <= 3000; ++i) {
    point.step(Mat3::Identity(), false, dt);
    if (i % 500 == 0) {
      EXPECT_NEAR(point.stress(0, 1), start * relaxed(point.law, dt * i), 1e-6 * start) << i;
    }
  }
  EXPECT_NEAR(point.stress.trace(), 0, 1e-10 * point.constants.bulk * angle);
}

// With steps of one length the answer to a steady rate is that of the convolution integral, to second order in the step.
TEST(Viscoelastic, StressUnderASteadyRateIsTheIntegral)
{
  Real last = 0;
  for (const int steps : {100, 200}) {
    Point<Viscoelastic> point{.law = sample<Viscoelastic>()};
    constexpr Real end = 0.5, rate = 1e-6;
    for (int i = 0; i < steps; ++i)
      point.step(shear_by(rate * end / steps), false, end / steps);
    Real exact = point.constants.share_left * end;
    for (const PronyTerm& term : terms(point.law))
      exact += term.share * term.time * (1 - std::exp(-end / term.time));
    const Real error = std::abs(point.stress(0, 1) / (point.constants.shear * rate * exact) - 1);
    EXPECT_LT(error, 5e-3);
    if (last > 0) {
      EXPECT_NEAR(last / error, 4, 0.3);
    }
    last = error;
  }
}

// One term, a standard linear solid: under constant shear stress the strain approaches 1 / (1 - g), with the time T / (1 - g).
TEST(Viscoelastic, StrainUnderConstantStressCreepsToItsLimit)
{
  const Viscoelastic law = law_example<Viscoelastic>();
  const Real share = law.relaxing_share, time = law.relaxation_time, dt = time / 500;
  Point<Viscoelastic> point{.law = law};
  const Real G = point.constants.shear, stress = 1e-6 * G;
  Real strain = 0;
  for (int i = 0; i < 2000; ++i) {
    // The stress is linear in the strain of the step: two trials find that which keeps it.
    const auto after = [&](Real step) {
      Point<Viscoelastic> trial = point;
      trial.step(shear_by(step), false, dt);
      return trial.stress(0, 1);
    };
    const Real none = after(0), step = (stress - none) / (after(1e-7) - none) * 1e-7;
    point.step(shear_by(step), false, dt);
    strain += step;
    if (i % 400 == 399) {
      const Real passed = dt * (i + 0.5);
      const Real exact = stress / G / (1 - share) * (1 - share * std::exp(-passed * (1 - share) / time));
      EXPECT_NEAR(strain, exact, 1e-3 * exact) << i;
    }
  }
}

TEST(Viscoelastic, SteadyOscillationHasTheComplexModulus)
{
  const Viscoelastic law = sample<Viscoelastic>();
  for (const Real frequency : {5.0, 50.0, 200.0}) {  // rad/s
    Point<Viscoelastic> point{.law = law};
    constexpr int per_cycle = 400, cycles = 60;
    const Real dt = 2 * std::numbers::pi / frequency / per_cycle;
    constexpr Real size = 1e-6;
    std::complex<Real> found = 0;
    Real before = 0, work_before = 0;
    for (int i = 1; i <= per_cycle * cycles; ++i) {
      const Real strain = size * std::sin(frequency * dt * i);
      point.step(shear_by(strain - before), false, dt);
      before = strain;
      if (i == per_cycle * (cycles - 1))
        work_before = point.state.plastic_work;
      if (i > per_cycle * (cycles - 1))  // stress = G' sin + G'' cos
        found +=
            point.stress(0, 1) * std::complex<Real>(std::sin(frequency * dt * i), std::cos(frequency * dt * i)) * (2.0 / per_cycle / size);
    }
    std::complex<Real> exact = 1;
    for (const PronyTerm& term : terms(law))
      exact -= term.share / (1.0 + std::complex<Real>(0, frequency * term.time));
    exact *= point.constants.shear;
    EXPECT_NEAR(found.real(), exact.real(), 2e-3 * exact.real());
    EXPECT_NEAR(found.imag(), exact.imag(), 5e-3 * exact.real());
    // The area of the loop is what is dissipated.
    EXPECT_NEAR(point.state.plastic_work - work_before, std::numbers::pi * exact.imag() * size * size,
                0.02 * std::numbers::pi * exact.imag() * size * size);
  }
}

TEST(Viscoelastic, ParametersThatCannotBeAreNamed)
{
  using testing::problems_of;
  EXPECT_THAT(problems_of(sample<Viscoelastic>(), [](Viscoelastic& law) { law.second->share = 0.7; }),
              ::testing::ElementsAre(::testing::HasSubstr("add up to 1.2")));
}

}  // namespace
}  // namespace talus::viscoelastic_test
