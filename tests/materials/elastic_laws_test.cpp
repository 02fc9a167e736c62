// Closed forms of the elastic laws, each with its own physics.
#include <gtest/gtest.h>

#include "tests/materials/samples.hpp"

namespace talus::elastic_laws_test {
namespace {

using testing::Dice;
using testing::Point;
using testing::rotation_about;
using testing::sample;

template <class L>
Mat3 stress_at(const Mat3& F)
{
  Point<L> point{.law = sample<L>()};
  point.step(F);
  return point.stress;
}

const auto [lambda, mu] = lame(1e7, 0.3);
constexpr Real E = 1e7;
constexpr Real exact = 1e-13;  // relative to Young's modulus: rounding of differences from one

TEST(LinearElastic, UniaxialStrainInManyStepsIsModulusTimesLogarithm)
{
  for (const int steps : {1, 10, 1000}) {
    Point<LinearElastic> point{.law = sample<LinearElastic>()};
    for (int n = 0; n < steps; ++n)
      point.step(Vec3(std::pow(1.5, 1.0 / steps), 1, 1).asDiagonal());
    EXPECT_NEAR(point.stress(0, 0), (lambda + 2 * mu) * std::log(1.5), exact * E * 10);
    EXPECT_NEAR(point.stress(1, 1), lambda * std::log(1.5), exact * E * 10);
  }
}

TEST(LinearElastic, RotationOfQuarterTurnInOneStepTurnsTheStressExactly)
{
  Point<LinearElastic> point{.law = sample<LinearElastic>()};
  point.stress = Vec3(-1e5, -2e5, -3e5).asDiagonal();
  point.step(rotation_about(Vec3::UnitZ(), std::acos(0.0)));
  EXPECT_LE((point.stress - Mat3(Vec3(-2e5, -1e5, -3e5).asDiagonal())).norm(), exact * E);
}

TEST(LinearElastic, LargeSimpleShearOscillatesLikeTheJaumannRate)
{
  // mu sin(gamma), a known defect of every law that turns its stress with the spin: hence "small strains" in its summary.
  Point<LinearElastic> point{.law = sample<LinearElastic>()};
  constexpr int steps = 10000;
  for (int n = 0; n < steps; ++n) {
    Mat3 H = Mat3::Zero();
    H(0, 1) = 10.0 / steps;
    point.strain(H);
  }
  EXPECT_NEAR(point.stress(0, 1), mu * std::sin(10.0), 1e-3 * mu);  // first order in the step
}

TEST(NeoHookean, UniaxialStretchMatchesClosedForm)
{
  const Mat3 stress = stress_at<NeoHookean>(Vec3(1.4, 1, 1).asDiagonal());
  EXPECT_NEAR(stress(0, 0), (mu * (1.4 * 1.4 - 1) + lambda * std::log(1.4)) / 1.4, exact * E);
  EXPECT_NEAR(stress(1, 1), lambda * std::log(1.4) / 1.4, exact * E);
}

TEST(NeoHookean, SimpleShearMatchesClosedForm)
{
  Mat3 F = Mat3::Identity();
  F(0, 1) = 2;
  const Mat3 stress = stress_at<NeoHookean>(F);
  EXPECT_NEAR(stress(0, 1), 2 * mu, exact * E);
  EXPECT_NEAR(stress(0, 0), 4 * mu, exact * E);
  EXPECT_NEAR(stress(1, 1), 0, exact * E);
}

TEST(Corotated, StretchesMatchClosedForm)
{
  const Vec3 s(1.3, 0.9, 1.1);
  const Real J = s.prod();
  Dice dice(1);
  const Mat3 Q = dice.rotation();
  const Mat3 stress = stress_at<Corotated>(Q * Mat3(s.asDiagonal()));
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR((Q.transpose() * stress * Q)(i, i), (2 * mu * (s[i] - 1) * s[i] + lambda * J * (J - 1)) / J, 10 * exact * E);
}

TEST(Corotated, StressIsTheDerivativeOfItsEnergy)
{
  const auto energy = [](const Mat3& F) {
    const Real J = F.determinant();
    return mu * (F - polar_rotation(F)).squaredNorm() + lambda / 2 * (J - 1) * (J - 1);
  };
  Dice dice(2);
  const Mat3 F = Mat3::Identity() + dice.matrix(0.3), D = dice.matrix(1);
  constexpr Real h = 1e-5;
  const Mat3 P = F.determinant() * stress_at<Corotated>(F) * F.inverse().transpose();
  EXPECT_NEAR((energy(F + h * D) - energy(F - h * D)) / (2 * h), P.cwiseProduct(D).sum(), 1e-8 * E);  // h^2 and rounding / h
}

TEST(Hencky, UniaxialStretchMatchesClosedForm)
{
  const Mat3 stress = stress_at<Hencky>(Vec3(0.5, 1, 1).asDiagonal());
  EXPECT_NEAR(stress(0, 0), (lambda + 2 * mu) * std::log(0.5) / 0.5, 10 * exact * E);
  EXPECT_NEAR(stress(2, 2), lambda * std::log(0.5) / 0.5, 10 * exact * E);
}

TEST(Hencky, SimpleShearGrowsWithoutOscillation)
{
  // tau_12 = mu 4 asinh(gamma/2)/sqrt(4 + gamma^2): eigenvalues of b are exp(+-2 asinh(gamma/2)).
  for (const Real gamma : {0.01, 1.0, 10.0}) {
    Mat3 F = Mat3::Identity();
    F(0, 1) = gamma;
    EXPECT_NEAR(stress_at<Hencky>(F)(0, 1), 4 * mu * std::asinh(gamma / 2) / std::sqrt(4 + gamma * gamma), exact * E * 100);
  }
}

TEST(LinearFirstPiola, UniaxialStrainIsLinearInTheStretch)
{
  for (const Real stretch : {0.2, 0.8, 1.7})
    EXPECT_NEAR(stress_at<LinearFirstPiola>(Vec3(stretch, 1, 1).asDiagonal())(0, 0), (lambda + 2 * mu) * (stretch - 1), exact * E);
}

TEST(LinearFirstPiola, MakesStressOutOfARotation)
{
  EXPECT_GT(stress_at<LinearFirstPiola>(rotation_about(Vec3::UnitZ(), 0.5)).norm(), 0.1 * E);
}

/// The Kirchhoff stress of a change of size alone is 3 K ln(stretch) in all directions; it is taken off the stiffness along a wave.
TEST(Hencky, WaveSpeedInCompressionIsStiffnessLessKirchhoffStress)
{
  const Hencky law = sample<Hencky>();
  for (const Real stretch : {0.7, 0.9, 1.0}) {
    const Real stress = (3 * lambda + 2 * mu) * std::log(stretch),
               speed = law.wave_speed(Mat3(stretch * Mat3::Identity()), law.constants());
    EXPECT_NEAR(speed * speed * law.density, std::max(lambda + 2 * mu - stress, mu - 2 * stress), exact * E * 100);
  }
}

TEST(ElasticLaws, AgreeForSmallStrains)
{
  Dice dice(3);
  const Mat3 H = dice.symmetric(1e-6);
  const Mat3 hooke = lambda * H.trace() * Mat3::Identity() + 2 * mu * H;
  for_each_type(TypeList<LinearElastic, NeoHookean, Corotated, Hencky, LinearFirstPiola, DruckerPrager>{}, [&]<class L>() {
    EXPECT_LE((stress_at<L>(Mat3::Identity() + H) - hooke).norm(), 1e-5 * hooke.norm()) << L::name;  // strain times about 5
  });
}

}  // namespace
}  // namespace talus::elastic_laws_test
