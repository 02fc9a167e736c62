// The weight of a pond on ground whose surface cuts cells.
#include <gtest/gtest.h>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::pond_test {
namespace {

constexpr Real unit_weight = 1e4, density = 2000;

/// Ground over the whole of a unit box, below 0.53 + slope (x - 0.5), under a pond.
template <class K, int D>
Model<D> ground(Index cells, Real jitter, std::uint64_t seed, Real slope, Real level)
{
  auto m = make_model<K, D>(unit_box<D>(cells, jitter, seed), Options<K>{});
  m.problem.transfer = {.scheme = Scheme::flip, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  const auto n =
      static_cast<Index>(D == 2 ? 3.4 * static_cast<Real>(cells) : 2.9 * static_cast<Real>(cells));  // not in tune with the cells
  const Real space = 1 / static_cast<Real>(n);
  const NeoHookean law = rubber(1e6, 0.3, density);
  auto& p = m.state.particles;
  for (Index column = 0; column < (D == 2 ? n : n * n); ++column) {
    Vec<D> x;
    x[0] = (static_cast<Real>(column % n) + 0.5) * space;
    if constexpr (D == 3)
      x[1] = (static_cast<Real>(column / n) + 0.5) * space;
    const Real height = 0.53 + slope * (x[0] - 0.5);
    const auto layers = static_cast<Index>(std::round(height / space));
    const Real thickness = height / static_cast<Real>(layers);  // columns end at the surface
    for (Index k = 0; k < layers; ++k) {
      x[D - 1] = (static_cast<Real>(k) + 0.5) * thickness;
      p.id.push_back(p.size()), p.cell.push_back(m.problem.locator(m.problem.mesh, x, 0).value()), p.x.push_back(x);
      p.v.push_back(Vec<D>::Zero()), p.L.push_back(Mat<D>::Zero()), p.F.push_back(Mat3::Identity()), p.stress.push_back(Sym3::Zero());
      const Real volume = std::pow(space, D - 1) * thickness;
      p.volume0.push_back(volume), p.mass.push_back(density * volume);
    }
  }
  m.state.bodies.push_back({"ground", 0, p.size(), {}});
  m.state.materials.push_back(make_material(law, 0, p.size(), "ground"));
  SurfaceLoad<D> pond;
  pond.body = 0, pond.pressure = unit_weight, pond.water_level = Table{{{0, level}, {10, 0}}}, pond.ends_at_walls = true;
  m.problem.loads.on_surfaces.push_back(pond);
  make_ready(m);
  return m;
}

/// The force of the pond over that of the water above the ground, less 1, and across it over the same.
struct Errors {
  Real along{}, across{};
  Real left{};  ///< largest force on a node inside that its uplift does not explain, over pressure times the area of a side of a cell
};
template <class K, int D>
Errors errors_of(Index cells, Real jitter, std::uint64_t seed, Real slope, Real level, Real time = 0)
{
  auto m = ground<K, D>(cells, jitter, seed, slope, level);
  const Real now = level * (1 - time / 10);
  m.state.clock.time = time;
  set_each(m.state.particles.stress, [&](std::size_t p) {  // as in water at rest
    return Sym3(add_diagonal(Sym3(Sym3::Zero()), -unit_weight * (now - m.state.particles.x[p][D - 1])));
  });
  sum_on_nodes(m);
  const Vec<D> force = m.work.sums.on_mesh.value().linear;
  const Real weight = unit_weight * (now - 0.53), side = 1 / static_cast<Real>(cells);
  Errors errors{-force[D - 1] / weight - 1, (force[0] - slope * weight) / weight, 0};
  const Nodes<D>& nodes = m.work.fields.front().nodes;
  for (Index n = 0; n < m.problem.mesh.n_nodes(); ++n)
    if (const auto i = static_cast<std::size_t>(n); !m.problem.mesh.on_boundary(n)) {
      const Vec<D> uplift = unit_weight * nodes.sum[i].mass / density * Vec<D>::Unit(D - 1);
      errors.left = std::max(errors.left, (nodes.sum[i].force - uplift).norm() / (weight * std::pow(side, D - 1)));
    }
  return errors;
}

TEST(Pond, PressesWithTheWeightOfTheWaterAbove)
{
  for (const Real slope : {0.0, 0.3})
    for (const std::uint64_t seed : {1, 2, 3}) {
      const Errors errors = errors_of<Projected<2>, 2>(16, 0.2, seed, slope, 3);
      EXPECT_NEAR(errors.along, 0, 0.03) << seed;
      EXPECT_NEAR(errors.across, 0, 0.03) << seed;
    }
  const Errors solid = errors_of<Projected<3>, 3>(8, 0.2, 1, 0.3, 3);
  EXPECT_NEAR(solid.along, 0, 0.04);
  EXPECT_NEAR(solid.across, 0, 0.04);
  EXPECT_NEAR((errors_of<Linear<2>, 2>(16, 0.2, 1, 0.3, 3).along), 0, 0.03);
  EXPECT_NEAR((errors_of<Umls<2>, 2>(16, 0.2, 1, 0.3, 3).along), 0, 0.06);
}

/// However deep it is: a force that the stress of the water in the ground does not balance would throw the particles at the surface about.
TEST(Pond, BalancesThePressureOfWaterAtRest)
{
  for (const Real level : {3.0, 100.0}) {
    EXPECT_LT((errors_of<Projected<2>, 2>(16, 0.2, 1, 0.3, level).left), 0.1 / (level - 0.53)) << level;
    EXPECT_LT((errors_of<Projected<3>, 3>(8, 0.2, 1, 0.3, level).left), 0.1 / (level - 0.53)) << level;
  }
}

TEST(Pond, SinksWithItsTable)
{
  EXPECT_NEAR((errors_of<Projected<2>, 2>(16, 0.2, 1, 0.3, 3, 5).along), 0, 0.03);  // 1.5 m then
  auto m = ground<Projected<2>, 2>(16, 0.2, 1, 0, 3);
  m.state.clock.time = 10;
  sum_on_nodes(m);
  EXPECT_EQ(m.work.sums.on_mesh.value().size, 0) << "below the mesh";
}

/// What it gives to the ground is in the balances of momentum and energy.
TEST(Pond, IsInTheBalances)
{
  auto m = ground<Projected<2>, 2>(12, 0.2, 1, 0.3, 3);
  close_off<2>(m, "y_min", Fixed<2>{});
  close_off<2>(m, "x_min", Roller<2>{});
  close_off<2>(m, "x_max", Roller<2>{});
  bind_boundary_conditions(m);
  run_until(m, 0.02);
  const EnergyLedger energy = m.state.energy.at_velocities();
  EXPECT_GT(energy.loads, 0);
  EXPECT_LT(std::abs(energy.defect(totals(m).kinetic)), 0.02 * energy.loads);
}

}  // namespace
}  // namespace talus::testing::pond_test
