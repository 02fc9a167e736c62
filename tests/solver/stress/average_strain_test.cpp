// Plastic strain averaged over a softening length: against the solutions of m - a^2 lap m = p, and what must be kept.
#include <gtest/gtest.h>

#include <numbers>

#include "materials/law_examples.hpp"
#include "tests/solver/blocks_of_particles.hpp"

namespace talus::average_strain_test {
namespace {

using std::numbers::pi;
using testing::add_body;
using testing::unit_box;

constexpr Real length = 0.1;  // of the average [m]

MohrCoulomb clay()
{
  auto law = law_example<MohrCoulomb>();
  law.residual_cohesion = 1e3;
  law.softening_strain = 1;
  law.softening_length = 0.75 * length;
  return law;
}

/// A unit box of clay whose particles have a plastic strain.
template <int D>
class Clay {
 public:
  explicit Clay(Index cells, Real jitter = 0.2) : m_(make_model<Linear<D>>(unit_box<D>(cells, jitter))), h_(1 / static_cast<Real>(cells))
  {
    add_body<D>(m_, "clay", clay(), D + 1, [](const Vec<D>&) { return true; });
    make_ready(m_);
  }
  Model<D>& model() { return m_; }
  StrainAveraging averaging() const { return m_.state.materials[0].law().strain_averaging().value(); }
  Real* history(std::size_t p) { return m_.state.materials[0].history.row(static_cast<Index>(p)); }
  Real mean(std::size_t p) { return history(p)[averaging().mean]; }
  const Particles<D>& particles() const { return m_.state.particles; }
  void set_strain(auto&& strain)
  {
    for (std::size_t p = 0; p < particles().id.size(); ++p)
      history(p)[averaging().strain] = strain(particles().x[p]);
  }
  /// Averages for `times` delays of 2 a / c, in steps of a tenth of what sound takes through a cell.
  void average(Real times)
  {
    const ConstitutiveLaw& law = m_.state.materials[0].law();
    const Real speed = law.wave_speed(Mat3::Identity()), dt = 0.1 * h_ / speed;
    begin_sweeps(m_);
    ASSERT_EQ(m_.work.softening.size(), 1U);
    for (Real t = 0; t < times * 2 * length / speed; t += dt)
      m_.work.softening[0].advance(m_.problem.mesh, law, *m_.work.strips, dt);
    end_sweeps(m_);
  }
  /// Sum of m_p times f(p), over the mass.
  Real integral(auto&& f)
  {
    Real sum = 0, mass = 0;
    for (std::size_t p = 0; p < particles().id.size(); ++p)
      sum += particles().mass[p] * f(p), mass += particles().mass[p];
    return sum / mass;
  }

 private:
  Model<D> m_;
  Real h_;
};

/// p = 1 + cos(pi x) has the mean 1 + cos(pi x) / (1 + a^2 pi^2), without flux through the surface.
template <int D>
Real error_of_mode(Index cells)
{
  Clay<D> clay(cells);
  clay.set_strain([](const Vec<D>& x) { return 1 + std::cos(pi * x[0]); });
  clay.average(12);
  const Real amplitude = 2 * clay.integral([&](std::size_t p) { return clay.mean(p) * std::cos(pi * clay.particles().x[p][0]); });
  EXPECT_NEAR(clay.integral([&](std::size_t p) { return clay.mean(p); }), 1, 1e-3);
  return std::abs(amplitude * (1 + std::pow(length * pi, 2)) - 1);
}
TEST(AverageStrain, IsThatOfTheGradientEquationIn2D)
{
  const Real coarse = error_of_mode<2>(8), fine = error_of_mode<2>(16);
  EXPECT_LT(fine, 3e-3);
  EXPECT_LT(fine, coarse);
}
TEST(AverageStrain, IsThatOfTheGradientEquationIn3D) { EXPECT_LT(error_of_mode<3>(8), 1e-2); }

TEST(AverageStrain, KeepsWhatIsUniformAndTheTotal)
{
  Clay<2> clay(8);
  clay.set_strain([](const Vec<2>&) { return 0.3; });
  clay.average(12);
  for (std::size_t p = 0; p < clay.particles().id.size(); ++p)
    EXPECT_NEAR(clay.mean(p), 0.3, 1e-7);  // exp(-24) times 24 is left of the start
  clay.set_strain([](const Vec<2>& x) { return std::abs(x[1] - 0.4) < 0.06 ? 1.0 : 0; });
  const Real total = clay.integral([&](std::size_t p) { return clay.history(p)[clay.averaging().strain]; });
  clay.average(12);
  EXPECT_NEAR(clay.integral([&](std::size_t p) { return clay.mean(p); }), total, 1e-7);
}

TEST(AverageStrain, CountsAStrainUpToWhatTheMiddleOfABandHas)
{
  Clay<2> clay(4);
  clay.set_strain([](const Vec<2>&) { return 10.0; });
  clay.average(12);
  EXPECT_NEAR(clay.mean(0), 1 + std::numbers::sqrt2, 1e-6);
}

TEST(AverageStrain, IsStableInAnyStep)
{
  Clay<2> clay(8, 0.3);
  clay.set_strain([](const Vec<2>& x) { return std::abs(x[1] - 0.4) < 0.06 ? 1.0 : 0; });
  Model<2>& m = clay.model();
  const ConstitutiveLaw& law = m.state.materials[0].law();
  const Real dt = 20 * length / law.wave_speed(Mat3::Identity());
  begin_sweeps(m);
  for (int n = 0; n < 200; ++n)
    m.work.softening[0].advance(m.problem.mesh, law, *m.work.strips, dt);
  end_sweeps(m);
  for (std::size_t p = 0; p < clay.particles().id.size(); ++p)
    EXPECT_LT(std::abs(clay.mean(p)), 1);
}

TEST(AverageStrain, TakesBodiesOfOneMaterialAsOne)
{
  const auto means = [](bool as_one) {
    auto m = make_model<Linear<2>>(unit_box<2>(8, 0));
    for (const bool lower : {true, false})
      add_body<2>(m, lower ? "lower" : "upper", clay(), 3, [lower](const Vec<2>& x) { return (x[1] < 0.5) == lower; });
    for (Material& material : m.state.materials)
      material.kind = as_one ? 0 : none;
    make_ready(m);
    const auto averaging = m.state.materials[0].law().strain_averaging().value();
    for (Index p = 0; p < m.state.materials[0].size(); ++p)
      m.state.materials[0].history.row(p)[averaging.strain] = 1;
    begin_sweeps(m);
    EXPECT_EQ(m.work.softening.size(), as_one ? 1U : 2U);
    for (int n = 0; n < 400; ++n)
      for (AveragedStrain<2>& one : m.work.softening)
        one.advance(m.problem.mesh, m.state.materials[0].law(), *m.work.strips, 1e-3);
    end_sweeps(m);
    Real sum = 0;
    for (Index p = 0; p < m.state.materials[1].size(); ++p)
      sum += m.state.materials[1].history.row(p)[averaging.mean];
    return sum;
  };
  EXPECT_EQ(means(false), 0);
  EXPECT_GT(means(true), 1);
}

}  // namespace
}  // namespace talus::average_strain_test
