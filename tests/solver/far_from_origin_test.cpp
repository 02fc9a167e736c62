// Slow motion far from the origin is not lost in the rounding of coordinates.
#include <gtest/gtest.h>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::far_from_origin_test {
namespace {

/// A block in the middle of a box of 10 m that begins at (far, far).
Model<2> far_block(Real far)
{
  auto grid = box<2>(Vec<2>::Constant(far), Vec<2>::Constant(far + 10), std::array<Index, 2>{10, 10});
  auto m = make_model<Projected<2>>(Mesh<2>(std::move(grid)));
  m.problem.transfer = {.scheme = Scheme::aflip, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  add_body<2>(m, "block", rubber(1e7, 0.3, 1000), 4,
              [&](const Vec<2>& x) { return (x.array() > far + 3).all() && (x.array() < far + 7).all(); });
  make_ready(m);
  return m;
}

TEST(FarFromTheOrigin, SlowParticlesMoveAsFarAsNearIt)
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

}  // namespace
}  // namespace talus::testing::far_from_origin_test
