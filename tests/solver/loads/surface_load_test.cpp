// Loads on surfaces that cut cells: the virtual stress, the forces of nodes that follow from it, their sums and their work.
#include "solver/loads/surface_load.hpp"

#include <gtest/gtest.h>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::surface_load_test {
namespace {

constexpr Real rounding = 1e-12;

template <int D>
Mat<D> some_deformation()
{
  Mat<D> F = Mat<D>::Identity();
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j)
      F(i, j) += 0.1 * (i + 2) - 0.15 * j * i;
  return F;
}

/// A load on the upper side of the last axis with one particle near it.
template <int D>
SurfaceLoad<D> on_top(const Vec<D>& traction, Real pressure)
{
  SurfaceLoad<D> load;
  load.body = 0, load.traction = traction, load.pressure = pressure, load.reach = 1, load.deep = 2;
  load.near = TrackedIds({7});
  load.side = {{0.25, Vec<D>::Unit(D - 1), Vec<D>::Unit(D - 1)}};
  return load;
}

/// S n da = t dA on the side and nothing on a side that is at right angles to it, with n da = J F^-T N dA, whatever the deformation.
template <int D>
void gives_the_traction_on_its_side_alone()
{
  const Mat<D> F = some_deformation<D>();
  const Real J = F.determinant(), volume0 = 0.5, volume = J * volume0;
  const Vec<D> N = Vec<D>::Unit(D - 1), aside = Vec<D>::Unit(0), t = Vec<D>::LinSpaced(1, 3);
  const Mat<D> nanson = J * F.inverse().transpose();
  const auto stress = [&](const SurfaceLoad<D>& load) { return Mat<D>(virtual_stress<D>(load, 7, F, volume0, volume).tension / volume); };
  const SurfaceLoad<D> fixed = on_top<D>(t, 0), following = on_top<D>(Vec<D>::Zero(), 5);
  EXPECT_LT((stress(fixed) * nanson * N - t).norm(), rounding);
  EXPECT_LT((stress(fixed) * nanson * aside).norm(), rounding);
  EXPECT_LT((stress(following) * nanson * N + 5 * nanson * N).norm(), rounding);
  EXPECT_LT((stress(following) * nanson * aside).norm(), rounding);
  EXPECT_EQ(virtual_stress<D>(fixed, 7, F, volume0, volume).depth, 0.25);
  EXPECT_EQ(virtual_stress<D>(fixed, 8, F, volume0, volume).depth, 2) << "of a particle that is not near";
  EXPECT_TRUE(virtual_stress<D>(fixed, 8, F, volume0, volume).tension.isZero(0));
  SurfaceLoad<D> closed = following;
  closed.is_closed = true;
  EXPECT_LT((stress(closed) + 5 * Mat<D>::Identity()).norm(), rounding) << "all around";
}
TEST(SurfaceLoad, GivesTheTractionOnItsSideAlone)
{
  gives_the_traction_on_its_side_alone<2>();
  gives_the_traction_on_its_side_alone<3>();
}

TEST(SurfaceLoad, IsCutOffBetweenTwoFifthsOfItsReachAndItsEnd)
{
  SurfaceLoad<2> load;
  EXPECT_EQ(load.cut_off(100), 1) << "without a reach, nowhere";
  load.reach = 10;
  EXPECT_EQ(load.cut_off(4), 1);
  EXPECT_DOUBLE_EQ(load.cut_off(7), 0.5);
  EXPECT_EQ(load.cut_off(10), 0);
}

TEST(SurfaceLoad, GrowsWithTheDepthOfWaterTheTableAndTheRamp)
{
  SurfaceLoad<2> load;
  load.table.points = {{0, 0}, {10, 10}};
  EXPECT_EQ(load.factor({3, 4}, 2, 0.5), 1) << "2 by the table";
  load.water_level = Table{{{0, 7}}};
  EXPECT_EQ(load.factor({3, 4}, 2, 0.5), 3);
  EXPECT_EQ(load.factor({3, 8}, 2, 0.5), 0) << "above the water";
}

/// A body between low and high in a unit box of jittered cells, cut by its surface: particles that lie in it, of the volume that they stand for.
template <class K, int D>
Model<D> block(Real low, Real high, AtSurfaces surfaces = AtSurfaces::plain)
{
  Options<K> options{};
  if constexpr (requires { options.surfaces; })
    options.surfaces = surfaces;
  auto m = make_model<K, D>(unit_box<D>(D == 2 ? 12 : 8, 0.2), options);
  m.problem.transfer = {.scheme = Scheme::flip, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  const Real space = D == 2 ? 1.0 / 41 : 1.0 / 26;  // not in tune with the cells
  const auto n = static_cast<Index>(std::round((high - low) / space));
  auto& p = m.state.particles;
  const NeoHookean law = rubber(1e4, 0.3, 1000);
  for (Index k = 0; k < (D == 2 ? n * n : n * n * n); ++k) {
    const Index of_axis[3] = {k % n, k / n % n, k / n / n};
    Vec<D> x;
    for (int d = 0; d < D; ++d)
      x[d] = low + (of_axis[d] + 0.5) * space;
    p.id.push_back(p.size()), p.cell.push_back(m.problem.locator(m.problem.mesh, x, 0).value()), p.x.push_back(x);
    p.v.push_back(Vec<D>::Zero()), p.L.push_back(Mat<D>::Zero()), p.F.push_back(Mat3::Identity()), p.stress.push_back(Sym3::Zero());
    p.volume0.push_back(std::pow(space, D)), p.mass.push_back(1000 * std::pow(space, D));
  }
  m.state.bodies.push_back({"block", 0, p.size(), {}});
  m.state.materials.push_back(make_material(law, 0, p.size(), "block"));
  return m;
}

template <int D>
Real side_of_block(const Model<D>& m)
{
  Real volume = 0;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    volume += m.state.particles.volume0[p];
  return std::pow(volume, Real{1} / D);
}

template <class K, int D>
void balances_the_stress_that_it_is(AtSurfaces surfaces = AtSurfaces::plain)
{
  auto m = block<K, D>(0.23, 0.71, surfaces);
  SurfaceLoad<D> load;
  load.body = 0, load.pressure = 3;
  m.problem.loads.on_surfaces.push_back(load);
  make_ready(m);
  set_each(m.state.particles.stress, [](std::size_t) { return Sym3(add_diagonal(Sym3(Sym3::Zero()), Real{-3})); });
  sum_on_nodes(m);
  Real net = 0, size = 0;
  for (std::size_t n = 0; n < m.work.fields.front().nodes.sum.size(); ++n)
    net += m.work.fields.front().nodes.sum[n].force.norm(), size += m.work.fields.front().nodes.surface_loads[n].norm();
  EXPECT_GT(size, 3 * 2 * D * std::pow(side_of_block(m), D - 1) * 0.6) << "the load is there, but at corners, where it cancels in part";
  EXPECT_LT(net, 1e-12 * size);
  EXPECT_LT(m.work.sums.on_mesh.value().linear.norm(), 1e-12 * size) << "a uniform pressure pushes nowhere";
  EXPECT_LT(m.work.sums.on_mesh.value().angular.norm(), 1e-12 * size);
}
/// Whatever the cells: to rounding.
TEST(SurfaceLoad, BalancesTheStressThatItIs)
{
  balances_the_stress_that_it_is<Projected<2>, 2>();
  balances_the_stress_that_it_is<Projected<2>, 2>(AtSurfaces::extended);
  balances_the_stress_that_it_is<Projected<3>, 3>();
  balances_the_stress_that_it_is<Linear<2>, 2>();
  balances_the_stress_that_it_is<Umls<2>, 2>();
}

template <class K, int D>
ForceAndMoment<D> force_of_water(Real level)
{
  auto m = block<K, D>(0.23, 0.71);
  SurfaceLoad<D> load;
  load.body = 0, load.pressure = 10, load.water_level = Table{{{0, level}}};
  m.problem.loads.on_surfaces.push_back(load);
  make_ready(m);
  sum_on_nodes(m);
  ForceAndMoment<D> force = m.work.sums.on_mesh.value();
  force.linear /= 10 * std::pow(side_of_block(m), D);
  return force;
}
/// Archimedes: to rounding where all is under water, and half of it where half is, to the quadrature.
TEST(SurfaceLoad, WaterLiftsABodyByTheWeightOfWhatItDisplaces)
{
  EXPECT_LT((force_of_water<Projected<2>, 2>(2).linear - Vec<2>::Unit(1)).norm(), rounding);
  EXPECT_LT((force_of_water<Projected<3>, 3>(2).linear - Vec<3>::Unit(2)).norm(), rounding);
  EXPECT_LT((force_of_water<Linear<3>, 3>(2).linear - Vec<3>::Unit(2)).norm(), rounding);
  EXPECT_NEAR((force_of_water<Projected<2>, 2>(0.47).linear[1]), 0.5, 0.02);
  EXPECT_EQ((force_of_water<Projected<2>, 2>(0).linear.norm()), 0);
}

/// The load on the upper side of the block, with all its particles near it.
template <int D>
SurfaceLoad<D> load_of_block(const Model<D>& m, const Vec<D>& traction, Real pressure, Real high)
{
  SurfaceLoad<D> load;
  load.body = 0, load.traction = traction, load.pressure = pressure, load.reach = 0.36, load.deep = 1;
  std::vector<std::int64_t> ids;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    ids.push_back(m.state.particles.id[p]);
    load.side.push_back({high - m.state.particles.x[p][D - 1], Vec<D>::Unit(D - 1), Vec<D>::Unit(D - 1)});
  }
  load.near = TrackedIds(ids);
  return load;
}

template <class K, int D>
void side_carries_area_times_traction(const Vec<D>& t)
{
  constexpr Real low = 0.23, high = low + (D == 2 ? 20.0 / 41 : 12.0 / 26);
  for (const bool pressed : {false, true}) {
    auto m = block<K, D>(low, high);
    m.problem.loads.on_surfaces.push_back(load_of_block<D>(m, pressed ? Vec<D>(Vec<D>::Zero()) : t, pressed ? 2 : 0, high));
    make_ready(m);
    sum_on_nodes(m);
    const Real area = std::pow(high - low, D - 1), middle = (low + high) / 2;
    const ForceAndMoment<D> found = m.work.sums.on_mesh.value();
    const Vec<D> force = area * (pressed ? Vec<D>(-2 * Vec<D>::Unit(D - 1)) : t);
    Vec<D> place = Vec<D>::Constant(middle);
    constexpr Real quadrature = D == 2 ? 0.01 : 0.04;  // over 4 cells and 3, with less than four layers of particles each
    place[D - 1] = high;
    EXPECT_LT((found.linear - force).norm(), quadrature * force.norm()) << found.linear.transpose() << " is not " << force.transpose();
    EXPECT_LT((found.angular - moment<D>(place, force)).norm(), 2 * quadrature * force.norm() * high) << "it acts on the side";
  }
}
TEST(SurfaceLoad, CarriesAreaTimesTractionAtTheSide)
{
  side_carries_area_times_traction<Projected<2>, 2>({3, 1});
  side_carries_area_times_traction<Projected<3>, 3>({3, 1, -2});
  side_carries_area_times_traction<Linear<2>, 2>({3, 1});
}

/// What a load gives a free body is in the balances of momentum and energy.
TEST(SurfaceLoad, IsInTheBalances)
{
  for (const AtSurfaces surfaces : {AtSurfaces::plain, AtSurfaces::extended}) {
    constexpr Real low = 0.23, high = low + 20.0 / 41;
    auto m = block<Projected<2>, 2>(low, high, surfaces);
    m.problem.loads.on_surfaces.push_back(load_of_block<2>(m, {30, 10}, 0, high));
    make_ready(m);
    const Totals<2> before = totals(m);
    run_until(m, 0.1);
    const Totals<2> after = totals(m);
    const Vec<2> gained = after.momentum - before.momentum;
    EXPECT_LT((m.state.momentum.loads.linear - gained).norm(), 1e-12 * gained.norm());
    EXPECT_LT((gained - (m.state.clock.time - m.state.clock.lag) * (high - low) * Vec<2>(30, 10)).norm(), 0.02 * gained.norm());
    const EnergyLedger energy = m.state.energy.at_velocities();
    EXPECT_GT(energy.loads, 0);
    EXPECT_LT(std::abs(energy.defect(after.kinetic)), 0.01 * energy.loads);
  }
}

}  // namespace
}  // namespace talus::testing::surface_load_test
