// Kernels with a node part in the solver: the way to the nodes is the way back transposed, linear motions are exact at surfaces too.
#include <gtest/gtest.h>

#include <random>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing {
namespace {

template <int D_, class K_, ValueStencil values = ValueStencil::maxent>
struct Setting {
  static constexpr int D = D_;
  using K = K_;
  static Options<K> options()
  {
    if constexpr (std::is_same_v<Options<K>, ProjectedOptions>)
      return {.values = values};
    else
      return {};
  }
};
template <class S>
class ProjectedIn : public ::testing::Test {};
using Settings = ::testing::Types<Setting<2, Projected<2>>, Setting<2, Projected<2>, ValueStencil::mls>, Setting<2, UmlsProjected<2>>,
                                  Setting<3, Projected<3>>, Setting<3, Projected<3>, ValueStencil::l2>, Setting<3, UmlsProjected<3>>>;
TYPED_TEST_SUITE(ProjectedIn, Settings);

/// A ball that cuts cells, with random stress and velocity in its particles; every particle's cell is known.
template <class S>
Model<S::D, typename S::K> ball()
{
  constexpr int D = S::D;
  Model<D, typename S::K> m(unit_box<D>(D == 2 ? 10 : 6, 0.2), S::options());
  m.transfer = {.scheme = Scheme::flip, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  add_body<D>(m, "ball", rubber(1e4, 0.3, 1000), D == 2 ? 6 : 10, [](const Vec<D>& x) { return (x - Vec<D>::Constant(0.5)).norm() < 0.4; });
  std::mt19937 random(1);
  std::uniform_real_distribution<Real> number(-1, 1);
  for (std::size_t p = 0; p < m.particles.id.size(); ++p)
    for (int d = 0; d < D; ++d)
      m.particles.x[p][d] += 1e-3 * number(random), m.particles.v[p][d] = number(random);
  make_ready(m, false);
  advance(m, 1e-12);
  for (auto& stress : m.particles.stress)
    for (Index k = 0; k < 6; ++k)
      stress[k] = number(random);
  return m;
}

/// Any velocities at all, and what the particles read of them; nothing moves.
template <int D, Kernel<D> K>
void read_random_motion(Model<D, K>& m)
{
  std::mt19937 random(2);
  std::uniform_real_distribution<Real> number(-1, 1);
  for (auto& node : m.nodes.motion)
    for (int d = 0; d < D; ++d)
      node.change[d] = node.v[d] = number(random);
  show_to_particles(m, 0);
}

TYPED_TEST(ProjectedIn, ForcesDoTheWorkThatStrainsTheParticles)
{
  constexpr int D = TypeParam::D;
  auto m = ball<TypeParam>();
  scatter(m);
  sum_on_nodes(m);
  read_random_motion(m);
  gather(m, 0);
  Real power = 0, stress_power = 0, size = 0;
  for (std::size_t n = 0; n < m.nodes.sum.size(); ++n)
    power += m.nodes.sum[n].force.dot(m.nodes.motion[n].v);
  for (std::size_t p = 0; p < m.particles.id.size(); ++p) {
    const Mat<D> sigma = unpack(m.particles.stress[p]).template topLeftCorner<D, D>();
    stress_power += m.particles.volume[p] * sigma.cwiseProduct(m.particles.L[p]).sum();
    size += m.particles.volume[p] * sigma.norm() * m.particles.L[p].norm();
  }
  EXPECT_NEAR(power, -stress_power, 1e-13 * size);
  EXPECT_GT(size, 0.1);
}

TYPED_TEST(ProjectedIn, MomentumIsScatteredByTheTransposeOfTheGather)
{
  auto m = ball<TypeParam>();
  const auto v = m.particles.v;
  scatter(m);
  sum_on_nodes(m);
  read_random_motion(m);
  for (auto& velocity : m.particles.v)
    velocity.setZero();
  gather(m, 0);  // flip: the increment, which is the velocity here
  Real nodes = 0, particles = 0, size = 0;
  for (std::size_t n = 0; n < m.nodes.sum.size(); ++n)
    nodes += m.nodes.sum[n].momentum.dot(m.nodes.motion[n].v);
  for (std::size_t p = 0; p < m.particles.id.size(); ++p) {
    particles += m.particles.mass[p] * v[p].dot(m.particles.v[p]);
    size += m.particles.mass[p] * v[p].norm() * m.particles.v[p].norm();
  }
  EXPECT_NEAR(nodes, particles, 1e-13 * size);
}

TYPED_TEST(ProjectedIn, LinearMotionsAreStrainedExactlyUpToTheSurface)
{
  constexpr int D = TypeParam::D;
  auto m = ball<TypeParam>();
  const Mat<D> A = Mat<D>::Random();
  scatter(m);
  sum_on_nodes(m);
  for (Index n = 0; n < m.mesh.n_nodes(); ++n)
    m.nodes.motion[static_cast<std::size_t>(n)].v = A * m.mesh.node(n) + Vec<D>::Ones();
  show_to_particles(m, 0);
  gather(m, 0);
  for (const auto& L : m.particles.L)
    ASSERT_LT((L - A).norm(), 1e-12);
}

/// A film of particles on the floor, thinner than a cell, under its own weight: the nodes above it must not run away.
template <class K>
void hold_a_film_on_a_wall()
{
  Model<2, K> m(unit_box<2>(8, 0.2));
  m.transfer = {.scheme = Scheme::aflip, .musl = true, .pic_damping_time = {}, .pic_damping_crossings = 25};
  add_body<2>(m, "film", rubber(1e5, 0.3, 1000), 12, [](const Vec<2>& x) { return x[1] < 0.1; });
  for (std::size_t p = 0; p < m.particles.id.size(); ++p)
    m.particles.x[p][1] *= 0.1;
  for (auto& volume : m.particles.volume0)
    volume *= 0.1;
  for (auto& mass : m.particles.mass)
    mass *= 0.1;
  Wall<2> floor;
  floor.name = "y_min";
  floor.kind = WallKind::roller;
  m.walls.add(floor, m.mesh, *m.mesh.facet_set("y_min"));
  m.loads.gravity.acceleration = {0, -10};
  make_ready(m, false);
  run_until(m, 0.2);
  EXPECT_FALSE(m.health.worst());
  for (std::size_t p = 0; p < m.particles.id.size(); ++p) {
    EXPECT_GT(m.particles.x[p][1], 0);
    EXPECT_LT(m.particles.v[p].norm(), 0.1) << "a tenth of what a fall from the height of a cell gives";
  }
}

TEST(Projected, HoldsAFilmOnAWall)
{
  hold_a_film_on_a_wall<Projected<2>>();
  hold_a_film_on_a_wall<UmlsProjected<2>>();
}

}  // namespace
}  // namespace talus::testing
