// Bodies that keep a reference configuration: what they do must not depend on when they renew it, where nothing is lost by that.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/solver/contact_kinds.hpp"

namespace talus::testing::reference_test {
namespace {

template <class S>
class ReferenceIn : public ::testing::Test {};
TYPED_TEST_SUITE(ReferenceIn, ContactKinds);

constexpr ReferenceOptions never{.update = ReferenceUpdate::never, .distortion = {}, .volume_change = {}, .shift = {}};
constexpr Real modulus = 1e4, density = 1000;  // Pa, kg/m^3

/// A block of rubber in the middle of an irregular box, which keeps a reference as `options` say.
template <class S>
Model<S::D> block(const ReferenceOptions& options, Scheme scheme, const std::function<Vec<S::D>(const Vec<S::D>&)>& velocity,
                  Real youngs_modulus = modulus)
{
  constexpr int D = S::D;
  auto m = make_model<typename S::Kernel>(unit_box<D>(D == 2 ? 12 : 6, 0.2));
  m.problem.transfer = {.scheme = scheme, .musl = {}, .pic_damping_time = {}, .pic_damping_crossings = {}};
  m.problem.references = {options, never};  // the second is that of no body
  add_body<D>(
      m, "block", rubber(youngs_modulus, 0.3, density), D == 2 ? 6 : 10,
      [](const Vec<D>& x) { return (x - Vec<D>::Constant(0.5)).cwiseAbs().maxCoeff() < 0.25; }, velocity);
  make_ready(m);
  return m;
}

/// Makes a model one in which no body has a reference.
template <int D>
void forget_reference(Model<D>& m)
{
  m.problem.references = {};
  m.state.particles.reference = {}, m.state.particles.G = {};
  make_ready(m);
}

/// Turns about the centre [rad/s] while it grows [1/s].
template <int D>
std::function<Vec<D>(const Vec<D>&)> turning(Real spin, Real growth)
{
  return [=](const Vec<D>& x) {
    const Vec<D> r = x - Vec<D>::Constant(0.5);
    Vec<D> v = growth * r;
    v[0] -= spin * r[1], v[1] += spin * r[0];
    return v;
  };
}

constexpr Real step = 1e-3;  // s, a tenth of what is stable
template <int D>
void run(Model<D>& m, int steps)
{
  for (int i = 0; i < steps; ++i)
    make_step(m, step);
  end_sweeps(m);
}

/// Largest differences of positions [m] and stresses [Pa].
template <int D>
std::pair<Real, Real> difference(const Model<D>& a, const Model<D>& b)
{
  std::vector<std::size_t> row(b.state.particles.id.size());
  for (std::size_t p = 0; p < row.size(); ++p)
    row[static_cast<std::size_t>(b.state.particles.id[p])] = p;
  std::pair<Real, Real> most;
  for (std::size_t p = 0; p < row.size(); ++p) {
    const std::size_t q = row[static_cast<std::size_t>(a.state.particles.id[p])];
    most.first = std::max(most.first, (a.state.particles.x[p] - b.state.particles.x[q]).norm());
    most.second = std::max(most.second, (a.state.particles.stress[p] - b.state.particles.stress[q]).norm());
  }
  return most;
}

TYPED_TEST(ReferenceIn, RenewedInEachStepItIsThePresentConfiguration)
{
  auto renewed = block<TypeParam>({}, Scheme::flip, turning<TypeParam::D>(1, -0.5));
  auto present = block<TypeParam>({}, Scheme::flip, turning<TypeParam::D>(1, -0.5));
  forget_reference(present);
  run(renewed, 60), run(present, 60);
  EXPECT_FALSE(renewed.state.particles.reference.empty());
  EXPECT_TRUE(present.state.particles.reference.empty());
  const auto [moved, stressed] = difference(renewed, present);
  EXPECT_LT(moved, 1e-11);
  EXPECT_LT(stressed, 1e-6);  // of 500 Pa
}

TYPED_TEST(ReferenceIn, NeverRenewedItKeepsTheDeformationOfAllSteps)
{
  constexpr int D = TypeParam::D;
  auto m = block<TypeParam>(never, Scheme::tpic, turning<D>(1, -0.5));
  const std::vector<Vec<D>> start = m.state.particles.x.values();
  const std::vector<std::int64_t> ids = m.state.particles.id;
  run(m, 100);
  Real largest = 0;
  for (std::size_t p = 0; p < ids.size(); ++p) {
    const Mat<D> G = m.state.particles.G[p];
    EXPECT_LT((m.state.particles.F[p].template topLeftCorner<D, D>() - G).norm(), 1e-12);
    const auto before = static_cast<std::size_t>(std::ranges::find(ids, m.state.particles.id[p]) - ids.begin());
    EXPECT_EQ(m.state.particles.reference[p], start[before]);
    largest = std::max(largest, (G - Mat<D>::Identity()).norm());
  }
  EXPECT_GT(largest, 0.05);
}

// A missing factor in L = H G^-1 or V sigma G^-T makes work from nothing.
TYPED_TEST(ReferenceIn, TheStressDoesTheWorkThatStrainsTheParticles)
{
  for (const ReferenceOptions& options : {never, ReferenceOptions{ReferenceUpdate::adaptive, 0.2, {}, {}}}) {
    auto m = block<TypeParam>(options, Scheme::flip, turning<TypeParam::D>(1, -2));
    m.state.energy.kinetic_start = totals(m).kinetic;
    run(m, 150);
    const EnergyLedger energy = m.state.energy.at_velocities();
    Real strain = 0;
    for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
      strain = std::max(strain, (m.state.particles.G[p] - Mat<TypeParam::D>::Identity()).norm());
    EXPECT_GT(strain, options.update == ReferenceUpdate::never ? 0.15 : 0.02);
    EXPECT_GT(energy.internal, 0.1 * energy.kinetic_start);
    EXPECT_LT(std::abs(energy.defect(totals(m).kinetic)), 0.01 * energy.internal);
  }
}

TYPED_TEST(ReferenceIn, FliesThroughCellsWithoutStrain)
{
  constexpr int D = TypeParam::D;
  for (const ReferenceOptions& options : {never, ReferenceOptions{ReferenceUpdate::adaptive, {}, {}, 0.1}}) {
    auto m = block<TypeParam>(options, Scheme::tpic, [](const Vec<D>&) { return Vec<D>(Vec<D>::Constant(1)); });
    run(m, 200);
    Real most = 0;
    for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
      most = std::max(most, m.state.particles.stress[p].norm());
    EXPECT_LT(most, 1e-9 * modulus);
    EXPECT_NEAR(totals(m).momentum[0] / totals(m).mass, 1, 1e-12);
  }
}

/// The sum of m x cross v over particles, about the centre of the box.
template <int D>
Real spin_of(const Model<D>& m)
{
  Real spin = 0;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    const Vec<D> r = m.state.particles.x[p] - Vec<D>::Constant(0.5), v = m.state.particles.v[p];
    spin += m.state.particles.mass[p] * (r[0] * v[1] - r[1] * v[0]);
  }
  return spin;
}

// The affine field of a particle turns with it.  Without that the block keeps 0.946 of its spin in four turns.
TEST(AffineField, TurnsWithTheParticle)
{
  const Real turns_a_second = 1;
  auto m = block<Kind<2, Projected>>({}, Scheme::aflip, turning<2>(2 * std::numbers::pi * turns_a_second, 0), 12 * modulus);
  forget_reference(m);
  const Real before = spin_of(m);
  for (int i = 0; i < 2000; ++i)
    make_step(m, 2 * step);
  end_sweeps(m);
  EXPECT_GT(spin_of(m) / before, 0.99);
  EXPECT_LT(spin_of(m) / before, 1.04);
}

/// How often a block is renewed in 100 steps; whenever it is, all of its particles are.
int renewals(const ReferenceOptions& options, const std::function<Vec<2>(const Vec<2>&)>& velocity)
{
  auto m = block<Kind<2, Projected>>(options, Scheme::tpic, velocity);
  int found = 0;
  for (int i = 0; i < 100; ++i) {
    run(m, 1);
    const auto& p = m.state.particles;
    const std::size_t n = p.id.size();
    std::size_t fresh = 0;
    for (std::size_t k = 0; k < n; ++k)
      fresh += p.reference[k] == p.x[k] ? 1 : 0;
    EXPECT_TRUE(fresh == 0 || fresh == n) << fresh << " of " << n;
    found += fresh == n ? 1 : 0;
  }
  return found;
}

TEST(Reference, IsRenewedByTheCriterionThatIsGiven)
{
  const auto adaptive = [](std::optional<Real> distortion, std::optional<Real> volume_change, std::optional<Real> shift) {
    return ReferenceOptions{ReferenceUpdate::adaptive, distortion, volume_change, shift};
  };
  const auto spin = turning<2>(1, 0), shrink = turning<2>(0, -1);
  const auto shear = [](const Vec<2>& x) { return Vec<2>(2 * (x[1] - 0.5), 0); };
  EXPECT_GT(renewals(adaptive(10, {}, 0.1), spin), 1);
  EXPECT_LT(renewals(adaptive(10, {}, 0.1), spin), 20);
  EXPECT_EQ(renewals(adaptive({}, {}, {}), spin), 0) << "a rotation is no distortion";
  EXPECT_GT(renewals(adaptive({}, {}, {}), shear), 0);
  EXPECT_EQ(renewals(adaptive({}, 0.05, {}), shear), 0) << "shear keeps the volume";
  EXPECT_GT(renewals(adaptive({}, 0.05, {}), shrink), 0);
}

}  // namespace
}  // namespace talus::testing::reference_test
