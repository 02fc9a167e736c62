#include "materials/parts/logarithm.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <array>

#include "tests/materials/samples.hpp"

namespace talus::logarithm_test {
namespace {

using testing::Dice;

TEST(Logarithm, SeriesAgreesWithPrincipalAxes)
{
  Dice dice(1);
  for (const Real size : {1e-12, 1e-8, 1e-4, 1e-2, 0.03, 0.07}) {  // 0.07 reaches beyond the radius of the series
    for (int n = 0; n < 1000; ++n) {
      const Sym3 a = add_diagonal(pack(dice.symmetric(size)), dice.real(-0.3, 0.3) * size);
      EXPECT_LE((log1p(a) - detail::log1p_by_axes(a)).norm(), 1e-13 * a.norm());
      EXPECT_LE((expm1(a) - detail::expm1_by_axes(a)).norm(), 1e-13 * a.norm());
    }
  }
}

TEST(Logarithm, SeriesAgreesWithPrincipalAxesUnderLargeVolumeChange)
{
  Dice dice(2);
  for (int n = 0; n < 1000; ++n) {
    const Real mean = dice.real(-0.9, 20);
    const Sym3 a = add_diagonal((1 + mean) * pack(dev(dice.symmetric(0.02))), mean);
    EXPECT_LE((log1p(a) - detail::log1p_by_axes(a)).norm(), 1e-13 * (1 + log1p(a).norm()));
  }
}

TEST(Logarithm, IsContinuousWhereTheSeriesEnds)
{
  Dice dice(3);
  for (int n = 0; n < 1000; ++n) {
    const Sym3 shear = pack(dev(dice.symmetric(1)));
    const Sym3 edge = shear * (series_radius / std::sqrt(squared_norm(shear)));
    const Sym3 inside = (1 - 1e-14) * edge, outside = (1 + 1e-14) * edge;
    EXPECT_LE((log1p(outside) - log1p(inside)).norm(), 1e-13 * edge.norm());
    EXPECT_LE((expm1(outside) - expm1(inside)).norm(), 1e-13 * edge.norm());
  }
}

TEST(Logarithm, ExponentialUndoesIt)
{
  Dice dice(4);
  for (const Real size : {1e-10, 1e-3, 0.05, 0.3, 1.0}) {
    const Sym3 strain = pack(dice.symmetric(size));
    EXPECT_LE((log1p(expm1(strain)) - strain).norm(), 1e-14 * strain.norm() * std::exp(2 * strain.norm()));
  }
}

TEST(Logarithm, InLanesIsThatOfEveryTensorAlone)
{
  Dice dice(5);
  for (int n = 0; n < 2000; ++n) {
    std::array<Sym3, pack_size> each;
    Sym3Of<SimdReal> all;
    for (int lane = 0; lane < pack_size; ++lane) {
      auto& a = each[static_cast<std::size_t>(lane)];
      a = add_diagonal(pack(dice.symmetric(std::pow(10, dice.real(-12, n % 3 - 2.0)))), dice.real(-0.5, 3) * (n % 2));
      for (int k = 0; k < 6; ++k)
        all[k].set(lane, a[k]);
    }
    const Sym3Of<SimdReal> logarithms = log1p(all), exponentials = expm1(all);
    for (int lane = 0; lane < pack_size; ++lane) {
      const Sym3& a = each[static_cast<std::size_t>(lane)];
      const Sym3 log_of = log1p(a), exp_of = expm1(a);
      for (int k = 0; k < 6; ++k) {
        if (log_of.allFinite())
          EXPECT_NEAR(logarithms[k][lane], log_of[k], 1e-14 * log_of.norm());
        else
          EXPECT_TRUE(std::isnan(logarithms[k][lane]));
        EXPECT_NEAR(exponentials[k][lane], exp_of[k], 1e-14 * exp_of.norm());
      }
    }
  }
}

TEST(Logarithm, KeepsDigitsOfTinyStrains)
{
  const Sym3 strain = 1e-12 * (Sym3() << 1, -2, 3, 0.5, -0.25, 0.125).finished();
  EXPECT_LE((log1p(strain) - strain).norm(), 1e-11 * strain.norm());  // the quadratic term
}

TEST(Logarithm, HasNoAnswerOutsideThePositiveDefinite)
{
  EXPECT_FALSE(log1p((Sym3() << -2, 0, 0, 0, 0, 0).finished()).allFinite());
  EXPECT_FALSE(log1p((Sym3() << -3, -3, -3, 0, 0, 0).finished()).allFinite());
}

TEST(PushForward, IsThatOfTheLeftTensorWithoutLosingDigits)
{
  Dice dice(5);
  const Mat3 H = dice.matrix(0.4), b = dice.symmetric(0.2), I = Mat3::Identity();
  EXPECT_LE((unpack(push_forward(H, pack(b))) - ((I + H) * (I + b) * (I + H).transpose() - I)).norm(), 1e-15 * 10);
  const Mat3 tiny = 1e-14 * H;
  EXPECT_LE((unpack(push_forward(tiny, Sym3::Zero())) - 2 * sym(tiny)).norm(), 1e-13 * tiny.norm());
}

TEST(PolarRotation, AgreesWithTheSingularValueDecomposition)
{
  Dice dice(6);
  for (const Real size : {0.0, 1e-9, 0.1, 0.9, 3.0}) {
    for (int n = 0; n < 200; ++n) {
      Mat3 F = dice.rotation() * (Mat3::Identity() + dice.matrix(size));
      if (F.determinant() < 0)
        F = -F;
      const Eigen::JacobiSVD<Eigen::Matrix3d> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
      const Real condition = svd.singularValues()[0] / svd.singularValues()[2];
      EXPECT_LE((polar_rotation(F) - Mat3(svd.matrixU() * svd.matrixV().transpose())).norm(), 1e-14 * condition);
    }
  }
}

TEST(LargestEigenvalueBound, IsNeverBelowTheEigenvalues)
{
  Dice dice(7);
  for (int n = 0; n < 1000; ++n) {
    const Mat3 a = dice.symmetric(1);
    EXPECT_GE(largest_eigenvalue_bound(a) * (1 + 1e-14), Eigen::SelfAdjointEigenSolver<Mat3>(a).eigenvalues().maxCoeff());
  }
}

}  // namespace
}  // namespace talus::logarithm_test
