// What single precision must not lose: slow motion far from the origin, and strain that grows by less than a rounding of 1 a step.
#include <gtest/gtest.h>

#include "solver/stable_step.hpp"
#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::precision_test {
namespace {

/// A block in the middle of a box of 10 m that lies a thousand kilometres from the origin.
Model<2> far_block(Real far)
{
  auto grid = box<2>(Vec<2>::Constant(far), Vec<2>::Constant(far + 10), std::array<Index, 2>{10, 10});
  auto m = make_model<Projected<2>>(Mesh<2>(std::move(grid)));
  m.problem.transfer = {.scheme = Scheme::aflip, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  add_body<2>(m, "block", rubber(1e7, 0.3, 1000), 4,
              [&](const Vec<2>& x) { return (x.array() > far + 3).all() && (x.array() < far + 7).all(); });
  m.state.particles.keep_in(Precision::single);
  make_ready(m);
  return m;
}

TEST(SinglePrecision, CarriesSlowParticlesFarFromTheOrigin)
{
  constexpr Real far = 1e6, speed = 1e-4;  // m, m/s: 1e-7 m a step
  auto m = far_block(far);
  set_velocity<2>(m, Mat<2>::Zero(), {speed, 0});
  const auto start = m.state.particles.x;
  const Real dt = 0.4 * shortest_crossing(m.problem.mesh, m.state.materials, m.state.particles);
  for (int step = 0; step < 200; ++step)
    advance(m, dt);
  ASSERT_FALSE(m.work.errors.worst());
  const Real way = 200 * dt * speed;
  ASSERT_LT(way, 1e-3) << "a millimetre at most";
  for (std::size_t p = 0; p < start.size(); ++p)
    ASSERT_NEAR(m.state.particles.x[p][0] - start[p][0], way, 1e-3 * way + 200 * far * 1e-16);
}

TEST(SinglePrecision, AddsUpStrainsBelowItsRounding)
{
  auto m = far_block(0);
  constexpr Real rate = 1e-5;  // 1/s: 5e-9 a step
  const Real dt = 5e-4;
  constexpr int steps = 400;
  advance(m, dt);  // sorts; nothing moves
  m.state.particles.L.assign(m.state.particles.L.size(), Mat<2>{{rate, 0}, {0, 0}});
  for (int step = 0; step < steps; ++step)
    for (Index block = 0; block < m.work.order.blocks; ++block)
      update_stress(m.state.materials[0], stress_block(m, m.work.order.rows(0, block), dt));
  const Real strain = steps * dt * rate, modulus = 1e7 * (1 - 0.3) / ((1 + 0.3) * (1 - 2 * 0.3));
  ASSERT_LT(strain, 1e-5);
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    ASSERT_NEAR(m.state.particles.F[p](0, 0) - 1, strain, 1e-4 * strain);
    ASSERT_NEAR(m.state.particles.stress[p][0], modulus * strain, 1e-4 * modulus * strain);
  }
}

}  // namespace
}  // namespace talus::testing::precision_test
