// What is averaged or conducted over the patches of cells around nodes, and artificial viscosity.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

#include "solver/particles/removal.hpp"
#include "solver/stress/conduct_heat.hpp"
#include "tests/solver/blocks_of_particles.hpp"

namespace talus::update_stress_test {
namespace {

using testing::add_body;
using testing::rubber;
using testing::set_each;
using testing::unit_box;

template <int D, class K = Linear<D>, class L>
Model<D> block(const L& law, Index cells, Real jitter = 0.2)
{
  auto m = make_model<K>(unit_box<D>(cells, jitter));
  add_body<D>(m, "block", law, D + 1, [](const Vec<D>&) { return true; });
  m.problem.transfer.musl = false;
  return m;
}

/// A kernel whose particles keep their velocity gradients: here they are given, and follow from no node.
using Keeping = Umls<2>;

/// Stress of all particles of the only body.
void update_all(Model<2>& m, Real dt) { testing::update_all_stress<Keeping>(m, dt); }

/// The averaged volume ratio of each particle by its id, after a move with these velocity gradients.
template <int D>
std::map<std::int64_t, Real> averages(Model<D>& m, Real dt)
{
  testing::for_each_strip(*m.work.strips, [&](const StripColumns<D>& all, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i)
      all.averaged.set(i, (Mat<D>::Identity() + dt * all.L.of(i)).determinant() * all.volume.of(i));
  });
  for (AveragedBodies<D>& one : m.work.averaged) {
    for (Index block = 0; block < m.work.strips->blocks(); ++block)
      one.sum_block(m.problem.mesh, *m.work.strips, block);
    one.sums.assemble();
    for (Index block = 0; block < m.work.strips->blocks(); ++block)
      one.average_block(m.problem.mesh, *m.work.strips, block);
  }
  std::map<std::int64_t, Real> of;
  testing::for_each_strip(*m.work.strips, [&](const StripColumns<D>& all, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i)
      of[all.id[i]] = all.averaged.of(i);
  });
  return of;
}

JohnsonCook metal(std::optional<Real> conductivity)
{
  JohnsonCook law;
  law.density = 8000;
  law.youngs_modulus = 1e11;
  law.poisson_ratio = 0.3;
  law.yield_stress = 1e8;
  law.hardening_exponent = law.thermal_exponent = 1;
  law.room_temperature = 300;
  law.melting_temperature = 1500;
  law.specific_heat = 400;
  law.conductivity = conductivity;
  return law;
}

template <int D>
void averages_volumes()
{
  auto m = block<D>(rubber(1e5, 0.3, 1000), 4);
  m.state.materials[0].averages_volume = true;
  make_ready(m);
  constexpr Real dt = 1e-3;

  const Mat<D> uniform = -5 * Mat<D>::Identity();
  m.state.particles.L.assign(m.state.particles.L.size(), uniform);
  begin_sweeps(m);
  const Real ratio = (Mat<D>::Identity() + dt * uniform).determinant();
  for (const auto& [id, J] : averages(m, dt))
    EXPECT_NEAR(J, ratio, 1e-14);
  end_sweeps(m);

  std::mt19937 bits(1);
  std::uniform_real_distribution<Real> any_rate(-20, 20);
  Real volume = 0, saved = 0, spread = 0, spread_averaged = 0;
  set_each(m.state.particles.L, [&](std::size_t) { return Mat<D>(any_rate(bits) * Mat<D>::Identity()); });
  begin_sweeps(m);
  const auto averaged = averages(m, dt);
  testing::for_each_strip(*m.work.strips, [&](const StripColumns<D>& all, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      const Real own = (Mat<D>::Identity() + dt * all.L.of(i)).determinant(), mean = averaged.at(all.id[i]);
      volume += own * all.volume0.of(i);
      saved += mean * all.volume0.of(i);
      spread += std::pow(own - 1, 2);
      spread_averaged += std::pow(mean - 1, 2);
    }
  });
  EXPECT_NEAR(saved, volume, 1e-13);         // the volume of the body is no matter of averaging
  EXPECT_LT(spread_averaged, 0.1 * spread);  // a star has more than ten particles
}
TEST(AverageVolume, KeepsUniformRatiosAndTheTotalAndSmoothsTheRestIn2D) { averages_volumes<2>(); }
TEST(AverageVolume, KeepsUniformRatiosAndTheTotalAndSmoothsTheRestIn3D) { averages_volumes<3>(); }

/// The block drawn as one body, or as three that meet in a rough line and in an island.
template <int D>
Model<D> drawn_as(int bodies, const auto& law)
{
  auto m = make_model<Linear<D>>(unit_box<D>(6, 0.2));
  const auto part = [bodies](const Vec<D>& x) {
    return bodies == 1 ? 0 : (x - Vec<D>::Constant(0.3)).norm() < 0.2 ? 2 : x[0] < 0.5 ? 1 : 0;
  };
  for (int b = 0; b < bodies; ++b)
    add_body<D>(m, "part", law, D + 1, [&, b](const Vec<D>& x) { return part(x) == b; });
  m.problem.transfer.musl = false;
  return m;
}

/// Index of each particle among all in the order of their cells, particles of a cell in that of their places: it does not depend on bodies.
template <int D>
std::vector<std::size_t> by_place(const Particles<D>& particles)
{
  std::vector<std::size_t> order(particles.id.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(particles.cell[a], particles.id[a]) < std::pair(particles.cell[b], particles.id[b]);
  });
  return order;
}

template <int D>
void averages_as_one()
{
  const auto ratios = [](int bodies) {
    auto m = drawn_as<D>(bodies, rubber(1e5, 0.3, 1000));
    for (Material& material : m.state.materials)
      material.averages_volume = true, material.group = 7;
    make_ready(m);
    std::mt19937 bits(3);
    std::uniform_real_distribution<Real> any_rate(-20, 20);
    const std::vector<std::size_t> places = by_place(m.state.particles);
    for (const std::size_t p : places)
      m.state.particles.L.set(p, any_rate(bits) * Mat<D>::Identity());
    std::vector<std::int64_t> ids;
    for (const std::size_t p : places)
      ids.push_back(m.state.particles.id[p]);
    begin_sweeps(m);
    const auto averaged = averages(m, 1e-3);
    std::vector<Real> in_order;
    for (const std::int64_t id : ids)
      in_order.push_back(averaged.at(id));
    return in_order;
  };
  EXPECT_EQ(ratios(1), ratios(3)) << "bitwise";
}
TEST(AverageVolume, OfASoilDrawnAsSeveralBodiesIsThatOfOneIn2D) { averages_as_one<2>(); }
TEST(AverageVolume, OfASoilDrawnAsSeveralBodiesIsThatOfOneIn3D) { averages_as_one<3>(); }

/// Pressure of all particles after some steps of a block that falls onto its base.
std::vector<Real> pressure_after_steps(int bodies, std::initializer_list<Index> groups)
{
  auto m = drawn_as<2>(bodies, rubber(1e5, 0.49, 1000));
  for (std::size_t b = 0; b < m.state.materials.size(); ++b)
    m.state.materials[b].averages_volume = true, m.state.materials[b].group = std::data(groups)[b];
  testing::close_off(m, "y_min", Fixed<2>{});
  m.problem.loads.gravity.acceleration = {0, -9.81};
  make_ready(m);
  testing::run_until(m, 0.02);
  std::vector<Real> pressure;
  for (const std::size_t p : by_place(m.state.particles))
    pressure.push_back(m.state.particles.stress[p][0] + m.state.particles.stress[p][1] + m.state.particles.stress[p][2]);
  return pressure;
}

TEST(AverageVolume, StepsTakeBodiesOfOneNumberAsOneAndOthersApart)
{
  const auto one = pressure_after_steps(1, {none}), together = pressure_after_steps(3, {4, 4, 4}),
             apart = pressure_after_steps(3, {4, 5, none});
  Real largest = 0, by_drawing = 0, by_averaging = 0;
  for (std::size_t p = 0; p < one.size(); ++p) {
    largest = std::max(largest, std::abs(one[p]));
    by_drawing = std::max(by_drawing, std::abs(together[p] - one[p]));
    by_averaging = std::max(by_averaging, std::abs(apart[p] - one[p]));
  }
  EXPECT_LE(by_drawing, 1e-9 * largest);  // momentum is summed body by body: round-off
  EXPECT_GE(by_averaging, 1e-3 * largest);
}

TEST(AverageVolume, LawsOfTotalAndOfIncrementalStrainAreToldTheSame)
{
  const auto stress_of = [](const auto& law) {
    auto m = block<2, Keeping>(law, 3);
    m.state.materials[0].averages_volume = true;
    make_ready(m);
    std::mt19937 bits(2);
    std::uniform_real_distribution<Real> any_rate(-10, 10);
    for (int step = 0; step < 5; ++step) {
      set_each(m.state.particles.L, [&](std::size_t) { return Mat<2>(Mat<2>::NullaryExpr([&] { return any_rate(bits); })); });
      begin_sweeps(m);
      averages(m, 1e-3);
      update_all(m, 1e-3);
    }
    return m.state.particles.stress;
  };
  Hencky total;
  VonMises incremental;
  total.density = incremental.density = 1000;
  total.youngs_modulus = incremental.youngs_modulus = 1e6;
  total.poisson_ratio = incremental.poisson_ratio = 0.4;
  incremental.yield_stress = 1e12;
  const auto by_total = stress_of(total), by_increments = stress_of(incremental);
  for (std::size_t p = 0; p < by_total.size(); ++p)
    EXPECT_LE((by_total[p] - by_increments[p]).norm(), 1e-12 * 1e6);  // rounding of five steps
}

TEST(UpdateStress, CountsEveryParticleOnceWhateverTheirNumber)
{
  // A model of these particles of a block, stretched.
  const auto updated = [](std::span<const Index> kept) {
    auto m = block<2, Keeping>(rubber(1e6, 0.3, 1000), 2);
    Particles<2>& particles = m.state.particles;
    for (std::size_t p = 0; p < particles.L.size(); ++p) {
      particles.L.set(p, (1.0 + static_cast<Real>(p)) * Mat<2>{{3, 1}, {0, -1}});
      if (std::find(kept.begin(), kept.end(), static_cast<Index>(p)) == kept.end())
        particles.cell[p] = none;
    }
    drop_lost(m.state.bodies, m.state.materials, particles);
    make_ready(m);
    update_all(m, 1e-3);
    return m;
  };
  const auto sums_of = [](const Model<2>& m) {
    StressSums all;
    for (const StressSums& sums : m.work.stress_sums)
      all.take_extremes(sums), all.work += sums.work;
    return all;
  };
  const std::vector<Index> rows{7, 2, 3, 11, 5, 0};
  for (std::size_t n = 1; n <= rows.size(); ++n) {
    const auto together = updated(std::span(rows).first(n));
    const StressSums sums = sums_of(together);
    StressSums one_by_one;
    for (std::size_t i = 0; i < n; ++i) {
      const auto alone = updated(std::span(rows).subspan(i, 1));
      const StressSums one = sums_of(alone);
      one_by_one.take_extremes(one);
      one_by_one.work += one.work;
      const auto& ids = together.state.particles.id;
      const auto p = static_cast<std::size_t>(std::find(ids.begin(), ids.end(), rows[i]) - ids.begin());
      ASSERT_LT(p, ids.size());
      EXPECT_EQ(together.state.particles.F[p], alone.state.particles.F[0]);
      EXPECT_EQ(together.state.particles.stress[p], alone.state.particles.stress[0]);
    }
    EXPECT_GT(sums.work, 0);
    EXPECT_NEAR(sums.work, one_by_one.work, 1e-14 * one_by_one.work) << n;
    EXPECT_EQ(sums.crossing, one_by_one.crossing) << n;
  }
}

TEST(BulkViscosity, ActsInCompressionOnlyAndStaysOutOfTheLaw)
{
  LinearElastic law;
  law.density = 1000;
  law.youngs_modulus = 1e6;
  law.poisson_ratio = 0;
  auto plain = block<2, Keeping>(law, 2, 0), viscous = block<2, Keeping>(law, 2, 0);
  const BulkViscosity viscosity{.linear = 0.3, .quadratic = 2};
  viscous.state.materials[0].viscosity = viscosity;
  make_ready(plain);
  make_ready(viscous);
  constexpr Real dt = 1e-4, rate = 3;
  for (const Real sign : {-1.0, -1.0, 1.0, 0.0}) {
    for (auto* m : {&plain, &viscous}) {
      m->state.particles.L.assign(m->state.particles.L.size(), Mat<2>{{sign * rate, 0}, {0, 0}});
      update_all(*m, dt);
    }
    const Real h = viscous.problem.mesh.altitude(viscous.state.particles.cell[0]);
    const Real density = viscous.state.particles.mass[0] / viscous.state.particles.volume[0];
    const Real c = viscous.state.materials[0].wave_speed(0, viscous.state.particles.F[0]);
    const Real q = sign < 0 ? density * h * rate * (viscosity.quadratic * h * rate + viscosity.linear * c) : 0;
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(plain.state.particles.stress[0][k] - viscous.state.particles.stress[0][k], q, 1e-12 * 1e6);
  }
}

TEST(BulkViscosity, ShortensTheStep)
{
  auto m = block<2>(rubber(1e6, 0, 1000), 2, 0);
  make_ready(m);
  m.state.particles.L.assign(m.state.particles.L.size(), -Mat<2>::Identity());
  const Real without = shortest_crossing(m.problem.mesh, m.state.materials, m.state.particles);
  m.state.materials[0].viscosity = BulkViscosity{.linear = 1, .quadratic = 0};
  const Real with = shortest_crossing(m.problem.mesh, m.state.materials, m.state.particles);
  EXPECT_NEAR(without / with, 1 + std::sqrt(2), 1e-12);  // Q = c:  Q + sqrt(Q^2 + c^2)
}

/// Mean of T cos(pi x) over the block, twice: the amplitude of the first mode.
template <int D>
Real first_mode(const Model<D>& m, auto&& temperature)
{
  Real sum = 0;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    sum += 2 * m.state.particles.volume0[p] * temperature(p) * std::cos(std::numbers::pi * m.state.particles.x[p][0]);
  return sum;
}

TEST(ConductHeat, DecaysAsTheHeatEquationSaysAndKeepsTheHeat)
{
  const JohnsonCook law = metal(200);
  auto m = block<2>(law, 20);
  make_ready(m);
  Material& rod = m.state.materials[0];
  const auto temperature = [&](std::size_t p) -> Real& { return rod.history.row(static_cast<Index>(p))[rod.law().heat()->temperature]; };
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    temperature(p) = 400 + 50 * std::cos(std::numbers::pi * m.state.particles.x[p][0]);
  const auto heat = [&] {
    Real sum = 0;
    for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
      sum += m.state.particles.mass[p] * temperature(p);
    return sum;
  };
  const Real before = heat(), mode_before = first_mode(m, temperature);
  const Real diffusivity = 200.0 / (8000 * 400), duration = 0.5 / (diffusivity * std::pow(std::numbers::pi, 2));
  constexpr int steps = 300;
  begin_sweeps(m);
  for (int step = 0; step < steps; ++step)
    conduct_heat(m.problem.mesh, rod.law(), *m.work.strips, 0, duration / steps, *m.work.heat);
  end_sweeps(m);
  EXPECT_NEAR(heat() / before, 1, 1e-13);
  EXPECT_NEAR(first_mode(m, temperature) / mode_before, std::exp(-0.5), 0.005 * std::exp(-0.5));  // twenty cells a half wave: h^2 terms
}

TEST(ConductHeat, NeedsAConductivity)
{
  EXPECT_TRUE(constitutive_law(metal(200))->heat());
  EXPECT_FALSE(constitutive_law(metal(std::nullopt))->heat());
  auto m = block<2>(metal(std::nullopt), 2);
  make_ready(m);
  EXPECT_FALSE(m.work.heat.has_value());
}

TEST(Geostatic, TractionsAloneMustBeBalancedBeforeTheStageEnds)
{
  auto m = block<2>(rubber(1e6, 0, 1000), 4, 0);
  testing::close_off(m, "x_min", Roller<2>{});
  auto load = carried_by_particles<2>(m.problem.mesh, *m.problem.mesh.facet_set("x_max"), m.state.particles);
  load.traction = {-100, 0};
  m.problem.loads.on_particles.push_back(std::move(load));
  make_ready(m);
  Stage stage = testing::test_stage(10);
  stage.damping = 0.5;
  stage.residual = 1e-3;
  const StageResult result = run_stage(m, stage, StepLimits{}, [](const auto&, RunEvent) {});
  EXPECT_LT(result.end, 10);
  Real inside = 0, outside = 0;  // virial: sum V stress_xx = sum f_x x, the roller being at x = 0
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    inside += m.state.particles.stress[p][0] * m.state.particles.volume[p];
    outside += m.state.particles.applied[p][0] * m.state.particles.x[p][0];
  }
  EXPECT_NEAR(inside, outside, 0.01 * 100);
  EXPECT_LT(outside, -80);
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    EXPECT_EQ(m.state.particles.v[p].norm() + m.state.particles.L[p].norm(), 0)
        << "the next stage starts from rest, in its affine part too";
}

}  // namespace
}  // namespace talus::update_stress_test
