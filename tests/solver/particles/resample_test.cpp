// Particles that are split and merged: what stays, what is counted, and what does not depend on threads or on where particles are stored.
#include "solver/particles/resample.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <set>

#include "core/parallel/threads.hpp"
#include "solver/step/resample_step.hpp"
#include "tests/solver/contact_kinds.hpp"

namespace talus::testing::resample_test {
namespace {

constexpr Real modulus = 1e4, density = 1000;  // Pa, kg/m^3

template <class S>
class ResampleIn : public ::testing::Test {};
TYPED_TEST_SUITE(ResampleIn, ContactKinds);

/// A block of rubber in the middle of an irregular box, sheared, turned and stretched.
template <class S>
Model<S::D> block(const ResampleOptions& options, Real rate = 0)
{
  constexpr int D = S::D;
  auto m = make_model<typename S::Kernel>(unit_box<D>(D == 2 ? 10 : 5, 0.2));
  m.problem.transfer = {.scheme = Scheme::aflip, .musl = {}, .pic_damping_time = {}, .pic_damping_crossings = {}};
  m.problem.resampling = {options};
  add_body<D>(
      m, "block", rubber(modulus, 0.3, density), 4,
      [](const Vec<D>& x) { return (x - Vec<D>::Constant(0.5)).cwiseAbs().maxCoeff() < 0.25; },
      [rate](const Vec<D>& x) {
        Vec<D> v = Vec<D>::Zero();
        v[0] = rate * (x[0] - 0.5) + 2 * rate * (x[1] - 0.5), v[1] = -rate * (x[1] - 0.5);
        return v;
      });
  make_ready(m);
  return m;
}

/// Sums over all particles that splitting and merging must not change.
template <int D>
struct Kept {
  Real mass = 0, volume0 = 0, volume = 0;
  Vec<D> momentum = Vec<D>::Zero(), centre = Vec<D>::Zero();
  Mat<D> affine = Mat<D>::Zero();
  Sym3 stress = Sym3::Zero();
};
template <int D>
Kept<D> kept_of(const Particles<D>& p)
{
  Kept<D> all;
  for (std::size_t row = 0; row < p.id.size(); ++row) {
    const Real m = p.mass[row];
    all.mass += m, all.volume0 += p.volume0[row], all.volume += p.volume[row];
    all.momentum += m * p.v[row], all.centre += m * p.x[row], all.affine += m * p.C[row], all.stress += p.volume[row] * p.stress[row];
  }
  return all;
}
template <int D>
void expect_same(const Kept<D>& a, const Kept<D>& b)
{
  constexpr Real round_off = 1e-13;
  EXPECT_NEAR(a.mass, b.mass, round_off * a.mass);
  EXPECT_NEAR(a.volume0, b.volume0, round_off * a.volume0);
  EXPECT_NEAR(a.volume, b.volume, round_off * a.volume);
  EXPECT_LT((a.momentum - b.momentum).norm(), round_off * a.mass);
  EXPECT_LT((a.centre - b.centre).norm(), round_off * a.mass);
  EXPECT_LT((a.affine - b.affine).norm(), round_off * a.mass);
  EXPECT_LT((a.stress - b.stress).norm(), round_off * modulus);
}

/// Gives each particle a velocity, an affine field, a deformation and a stress that vary in space.
template <int D>
void set_fields(Particles<D>& p, Real stretch)
{
  for (std::size_t row = 0; row < p.id.size(); ++row) {
    const Vec<D> x = p.x[row];
    Mat<D> C = Mat<D>::Zero(), F = Mat<D>::Identity();
    C(0, 1) = 0.2 + x[0], C(1, 0) = -0.3, C(0, 0) = x[1];
    F(0, 0) = stretch, F(0, 1) = 0.1, F(1, 1) = 1 / stretch;
    Mat3 F3 = Mat3::Identity();
    F3.template topLeftCorner<D, D>() = F;
    p.v.set(row, C * x), p.C.set(row, C), p.L.set(row, C), p.F.set(row, F3);
    p.volume.set(row, F3.determinant() * p.volume0[row]);
    p.domain.set(row, F * p.domain[row]);
    p.stress.set(row, modulus * x[0] * Sym3::Ones());
  }
}

TYPED_TEST(ResampleIn, WhatIsLongerThanACellIsSplitAlongIt)
{
  constexpr int D = TypeParam::D;
  auto m = block<TypeParam>({.longest = 1, .most = 1000, .every = 1});
  set_fields<D>(m.state.particles, 4);
  const Particles<D> before = m.state.particles;
  const Totals<D> then = totals(m);
  resample_particles(m);
  const Particles<D>& after = m.state.particles;
  const auto splits = static_cast<std::size_t>(m.state.resampling.splits);
  ASSERT_GT(splits, before.id.size() / 2);
  EXPECT_EQ(after.id.size(), before.id.size() + splits);
  EXPECT_EQ(m.state.resampling.merges, 0);
  EXPECT_EQ(m.state.bodies[0].size(), after.size());
  EXPECT_EQ(m.state.materials[0].history.size(), after.size());
  expect_same(kept_of(before), kept_of(after));
  const Totals<D> now = totals(m);
  EXPECT_NEAR(m.state.energy.resampled, then.kinetic - now.kinetic, 1e-12 * then.kinetic);
  EXPECT_LT((m.state.momentum.changes.angular - (now.angular - then.angular)).norm(), 1e-12 * then.angular.norm());

  std::set<std::int64_t> ids(after.id.begin(), after.id.end());
  EXPECT_EQ(ids.size(), after.id.size());
  std::size_t halves = 0;
  for (std::size_t row = 0; row < after.id.size(); ++row) {
    const KnownIds known{before.size(), m.state.resampling.splits};
    EXPECT_TRUE(known.has(after.id[row]));
    EXPECT_NEAR(std::abs(Mat<D>(after.domain[row]).determinant()), after.volume[row], 1e-12 * after.volume[row]);
    halves += after.id[row] >= first_resampled_id ? 1 : 0;
  }
  EXPECT_EQ(halves, splits);
}

TYPED_TEST(ResampleIn, HalvesLieWhereTheMotionHasTakenTheirPlacesOfTheStart)
{
  constexpr int D = TypeParam::D;
  auto m = block<TypeParam>({.longest = 1, .most = 1000, .every = 1});
  Particles<D>& p = m.state.particles;
  set_fields<D>(p, 4);
  const Mat<D> F = p.F[0].template topLeftCorner<D, D>();
  for (std::size_t row = 0; row < p.id.size(); ++row)
    p.x0.push_back(F.inverse() * p.x[row]);
  resample_particles(m);
  ASSERT_GT(m.state.resampling.splits, 0);
  for (std::size_t row = 0; row < p.id.size(); ++row)
    EXPECT_LT((F * p.x0[row] - p.x[row]).norm(), 1e-12);
}

TYPED_TEST(ResampleIn, CrowdedCellsMergeTheirNearestParticles)
{
  constexpr int D = TypeParam::D;
  auto m = block<TypeParam>({.longest = 100, .most = 3, .every = 1});
  set_fields<D>(m.state.particles, 1.1);
  const Particles<D> before = m.state.particles;
  const Totals<D> then = totals(m);
  resample_particles(m);
  const Particles<D>& after = m.state.particles;
  ASSERT_GT(m.state.resampling.merges, 0);
  EXPECT_EQ(m.state.resampling.splits, 0);
  EXPECT_EQ(after.size(), before.size() - m.state.resampling.merges);
  expect_same(kept_of(before), kept_of(after));
  EXPECT_GT(m.state.energy.resampled, 0);
  EXPECT_NEAR(m.state.energy.resampled, then.kinetic - totals(m).kinetic, 1e-12 * then.kinetic);
  std::map<Index, int> in_cell;
  for (std::size_t row = 0; row < after.id.size(); ++row) {
    ++in_cell[after.cell[row]];
    EXPECT_NEAR(Mat3(after.F[row]).determinant(), after.volume[row] / after.volume0[row], 1e-12);
  }
  for (const auto& [cell, n] : in_cell)
    EXPECT_LE(n, 3) << "cell " << cell;
}

/// Layers that shear has drawn out in opposite directions have a mean deformation that is turned inside out.
TYPED_TEST(ResampleIn, ParticlesOfOppositeShearsMergeWithoutTurningInsideOut)
{
  constexpr int D = TypeParam::D;
  auto m = block<TypeParam>({.longest = 100, .most = 2, .every = 1});
  Particles<D>& p = m.state.particles;
  for (std::size_t row = 0; row < p.id.size(); ++row) {
    Mat3 F = Mat3::Identity();
    const Real shear = row % 2 == 0 ? 6 : -6, angle = row % 2 == 0 ? 0.3 : -0.3;
    F(0, 1) = shear;
    Mat3 turn = Mat3::Identity();
    turn.template topLeftCorner<2, 2>() << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    p.F.set(row, turn * F * turn.transpose());
  }
  EXPECT_LT(Mat3((p.F[0] + p.F[1]) / 2).determinant(), 0) << "of the mean";
  resample_particles(m);
  ASSERT_GT(m.state.resampling.merges, 0);
  for (std::size_t row = 0; row < p.id.size(); ++row)
    EXPECT_NEAR(Mat3(p.F[row]).determinant(), p.volume[row] / p.volume0[row], 1e-12);
}

TYPED_TEST(ResampleIn, CellsThatAreFullAndMatterThatFliesApartAreNotSplit)
{
  constexpr int D = TypeParam::D;
  auto full = block<TypeParam>({.longest = 1, .most = 5, .every = 1});
  set_fields<D>(full.state.particles, 4);
  resample_particles(full);
  std::map<Index, int> in_cell;
  for (const Index cell : full.state.particles.cell)
    ++in_cell[cell];
  EXPECT_GT(full.state.resampling.splits, 0);
  EXPECT_EQ(full.state.resampling.merges, 0);
  for (const auto& [cell, n] : in_cell)
    EXPECT_LE(n, 5) << "cell " << cell;

  auto spray = block<TypeParam>({.longest = 1, .most = 1000, .every = 1});
  Particles<D>& p = spray.state.particles;
  for (std::size_t row = 0; row < p.id.size(); ++row)
    p.volume.set(row, 9 * p.volume0[row]), p.domain.set(row, 4 * p.domain[row]);
  resample_particles(spray);
  EXPECT_EQ(spray.state.resampling.splits, 0);
}

TYPED_TEST(ResampleIn, TheBalancesOfABodyThatIsTornApartClose)
{
  constexpr int D = TypeParam::D;
  auto m = block<TypeParam>({.longest = 0.6, .most = 6, .every = 3}, 3);
  const Totals<D> start = totals(m);
  m.state.energy.kinetic_start = start.kinetic;
  const Index before = m.state.particles.size();
  for (int i = 0; i < 60; ++i) {
    make_step(m, 1e-3);
    ASSERT_FALSE(m.work.errors.worst().has_value());
    resample_particles(m);
  }
  end_sweeps(m);
  EXPECT_GT(m.state.resampling.splits, before / 10);
  EXPECT_GT(m.state.resampling.merges, before / 20);
  const Totals<D> end = totals(m);
  EXPECT_NEAR(end.mass, start.mass, 1e-13 * start.mass);
  EXPECT_LT((end.momentum - start.momentum).norm(), 1e-12 * start.mass);
  const EnergyLedger energy = m.state.energy.at_velocities();
  EXPECT_NE(energy.resampled, 0);
  EXPECT_LT(std::abs(energy.defect(end.kinetic)), 2e-2 * energy.largest_term(end.kinetic));
}

/// Position, velocity and stress of each particle by its id.
template <int D>
std::map<std::int64_t, std::array<Real, 2 * D + 6>> particles_by_id(const Model<D>& m)
{
  std::map<std::int64_t, std::array<Real, 2 * D + 6>> all;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    auto& one = all[m.state.particles.id[p]];
    const Vec<D> x = m.state.particles.x[p], v = m.state.particles.v[p];
    const Sym3 stress = m.state.particles.stress[p];
    std::ranges::copy(x, one.begin()), std::ranges::copy(v, one.begin() + D), std::ranges::copy(stress, one.begin() + 2 * D);
  }
  return all;
}

TYPED_TEST(ResampleIn, IsBitwiseIdenticalFromColumnsAndOnAnyNumberOfThreads)
{
  const int before = threads();
  std::vector<std::map<std::int64_t, std::array<Real, 2 * TypeParam::D + 6>>> runs;
  for (const int n : {1, 2, 3}) {
    set_threads(n);
    auto m = block<TypeParam>({.longest = 0.6, .most = 6, .every = 3}, 3);
    for (int i = 0; i < 30; ++i) {
      make_step(m, 1e-3);
      resample_particles(m);
      if (n == 3)
        end_sweeps(m);
    }
    end_sweeps(m);
    EXPECT_GT(m.state.resampling.splits, 0);
    runs.push_back(particles_by_id(m));
  }
  set_threads(before);
  EXPECT_EQ(runs[0], runs[1]);
  EXPECT_EQ(runs[0], runs[2]);
}

TEST(Resample, KeepsParticlesNearASideThatIsLoaded)
{
  using S = Kind<2, Projected>;
  auto m = block<S>({.longest = 1, .most = 3, .every = 1});
  set_fields<2>(m.state.particles, 4);
  SurfaceLoad<2> load;
  load.body = 0, load.reach = 0.1;
  load.near = TrackedIds(m.state.particles.id);
  m.problem.loads.on_surfaces.push_back(load);
  resample_particles(m);
  EXPECT_EQ(m.state.resampling.splits + m.state.resampling.merges, 0);
  m.problem.loads.on_surfaces.clear();
  resample_particles(m);
  EXPECT_GT(m.state.resampling.merges, 0);
}

TEST(Resample, KeepsParticlesThatCarryLoadsAndHalvesInsideTheMesh)
{
  using S = Kind<2, Projected>;
  auto m = block<S>({.longest = 0.5, .most = 1000, .every = 1});
  set_fields<2>(m.state.particles, 8);
  const std::int64_t carrier = m.state.particles.id[60];
  const Mat<2> of_carrier = m.state.particles.domain[60];
  m.work.carriers = TrackedIds({carrier});
  Particles<2>& p = m.state.particles;
  Mat<2> long_across = Mat<2>::Zero();
  long_across(0, 0) = 40, long_across(1, 1) = 1e-3;
  for (std::size_t row = 0; row < 40; ++row) {  // beside a wall: halves, and quarters of the way to them, lie outside
    const Vec<2> beside(1e-3, 0.1 + 0.02 * static_cast<Real>(row));
    p.x.set(row, beside), p.domain.set(row, long_across);
    p.cell[row] = m.problem.locator(m.problem.mesh, beside, none).value();
  }
  update_rows(m);
  resample_particles(m);
  for (std::size_t row = 0; row < p.id.size(); ++row) {
    EXPECT_TRUE(m.problem.locator(m.problem.mesh, p.x[row], none).has_value());
    if (p.id[row] < 40 || p.id[row] == carrier) {
      EXPECT_EQ(Mat<2>(p.domain[row]), p.id[row] == carrier ? of_carrier : long_across);
    }
  }
  EXPECT_GT(of_carrier.norm(), 0.1) << "it would be split";
  EXPECT_GT(m.state.resampling.splits, 0);
}

}  // namespace
}  // namespace talus::testing::resample_test
