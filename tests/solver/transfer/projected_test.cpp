// Kernels with a node part in the solver: the way to the nodes is the way back transposed, linear motions are exact at surfaces too.
#include <gtest/gtest.h>

#include <random>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::projected_test {
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
  for (std::size_t p = 0; p < m.particles.id.size(); ++p) {
    Vec<D> v;
    for (int d = 0; d < D; ++d)
      m.particles.x[p][d] += 1e-3 * number(random), v[d] = number(random);
    m.particles.v.set(p, v);
  }
  make_ready(m);
  advance(m, 1e-12);
  set_each(m.particles.stress, [&](std::size_t) { return Sym3(Sym3::NullaryExpr([&] { return number(random); })); });
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
  project_to_particles(m, Kick{});
}

TYPED_TEST(ProjectedIn, ForcesDoTheWorkThatStrainsTheParticles)
{
  constexpr int D = TypeParam::D;
  auto m = ball<TypeParam>();
  scatter(m);
  assemble_nodes(m);
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
  assemble_nodes(m);
  read_random_motion(m);
  m.particles.v.assign(m.particles.v.size(), Vec<TypeParam::D>::Zero());
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
  assemble_nodes(m);
  for (Index n = 0; n < m.mesh.n_nodes(); ++n)
    m.nodes.motion[static_cast<std::size_t>(n)].v = A * m.mesh.node(n) + Vec<D>::Ones();
  project_to_particles(m, Kick{});
  gather(m, 0);
  for (std::size_t p = 0; p < m.particles.L.size(); ++p)
    ASSERT_LT((m.particles.L[p] - A).norm(), 1e-12);
}

/// A film of particles on the floor, a fiftieth of a cell thick, that is pulled along it and has ends: the nodes above it have hardly
/// any mass, and must not run away under its stress.
TEST(Projected, HoldsAFilmOnAWall)
{
  Model<2, Projected<2>> m(unit_box<2>(8, 0.2));
  m.transfer = {.scheme = Scheme::aflip, .musl = true, .pic_damping_time = {}, .pic_damping_crossings = 25};
  add_body<2>(m, "film", rubber(1e5, 0.3, 1000), 12, [](const Vec<2>& x) { return x[1] < 0.1 && x[0] > 0.25 && x[0] < 0.75; });
  const Real share = 0.02;
  for (std::size_t p = 0; p < m.particles.id.size(); ++p) {
    m.particles.v.set(p, {0.1 * std::sin(12 * m.particles.x[p][0]), 0});
    m.particles.x[p][1] *= share;
    m.particles.volume0[p] *= share;
    m.particles.mass.set(p, share * m.particles.mass[p]);
  }
  close_off(m, "y_min", Roller<2>{});
  m.loads.gravity.acceleration = {0, -10};
  make_ready(m);
  const Real kinetic = totals(m).kinetic;
  ASSERT_NO_THROW(run_until(m, 0.05));
  EXPECT_LT(totals(m).kinetic, kinetic);
  for (const auto& x : m.particles.x) {
    EXPECT_GT(x[1], 0);
    EXPECT_LT(x[1], 1.1 * share / 8) << "the height of the film at the start";
  }
}

/// A block slides on a rough floor: its momentum is what gravity and the floor gave, and the floor rubs with its share of what it bears.
template <ValueStencil values>
void slide_on_a_rough_floor(Scheme scheme)
{
  ProjectedOptions options;
  options.values = values;
  Model<2, Projected<2>> m(unit_box<2>(8, 0.2), options);
  m.transfer = {.scheme = scheme, .musl = true, .pic_damping_time = {}, .pic_damping_crossings = 25};
  add_body<2>(m, "block", rubber(1e5, 0.3, 1000), 6, [](const Vec<2>& x) { return x[0] < 0.6 && x[1] < 0.4; });
  m.particles.v.assign(m.particles.v.size(), Vec<2>{2, -0.5});
  const Real friction = 0.4;
  close_off(m, "y_min", Friction<2>{friction});
  m.loads.gravity.acceleration = {1, -10};
  make_ready(m);
  const Totals<2> start = totals(m);
  const auto floor = *m.mesh.facet_set("y_min");
  for (int step = 0; step < 60; ++step) {
    advance(m, 1e-3);
    for (const Facet facet : floor)
      for (const Index n : m.mesh.nodes_of(facet))
        if (m.projected.sum[static_cast<std::size_t>(n)].is_seen()) {
          ASSERT_GT(m.projected.motion[static_cast<std::size_t>(n)].v[1], -1e-12) << "what particles read leads into the floor";
        }
  }
  const Totals<2> end = totals(m);
  const Vec<2> floor_gave = m.walls.walls()[0].impulse,
               gravity_gave = end.mass * (m.clock.time - m.clock.lag) * m.loads.gravity.acceleration;
  EXPECT_LT((end.momentum - start.momentum - floor_gave - gravity_gave).norm(), 1e-10 * start.momentum.norm());
  EXPECT_LT(-floor_gave[0], friction * (1 + 1e-10) * floor_gave[1]);
  EXPECT_GT(-floor_gave[0], 0.75 * friction * floor_gave[1]);
}

TEST(Projected, AFloorGivesMomentumAndRubsWithItsShare)
{
  for (const Scheme scheme : {Scheme::flip, Scheme::aflip, Scheme::tpic}) {
    slide_on_a_rough_floor<ValueStencil::maxent>(scheme);
    slide_on_a_rough_floor<ValueStencil::l2>(scheme);
    slide_on_a_rough_floor<ValueStencil::mls>(scheme);
  }
}

/// A body without stiffness, all of its particles in cells at the boundary of the mesh, which is free: nothing but transfer.
template <ValueStencil values>
Real motion_left(Index cells, int steps)
{
  ProjectedOptions options;
  options.values = values;
  Model<2, Projected<2>> m(unit_box<2>(cells, 0.2), options);
  m.transfer = {.scheme = Scheme::tpic, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  add_body<2>(m, "dust", rubber(1e-9, 0, 1000), 6, [](const Vec<2>&) { return true; });
  std::mt19937 random(3);
  std::uniform_real_distribution<Real> number(-1e-9, 1e-9);
  set_each(m.particles.v, [&](std::size_t) { return Vec<2>{number(random), number(random)}; });
  make_ready(m);
  const Real start = totals(m).kinetic;
  for (int step = 0; step < steps; ++step)
    advance(m, 1e-2);
  return totals(m).kinetic / start;
}

TEST(Projected, TransferToAndFroMakesNoMotion)
{
  for (const Index cells : {1, 2, 8}) {
    EXPECT_LT(motion_left<ValueStencil::maxent>(cells, 200), 1) << cells;
    EXPECT_LT(motion_left<ValueStencil::l2>(cells, 200), 1) << cells;
    EXPECT_LT(motion_left<ValueStencil::mls>(cells, 200), 1) << cells;
  }
}

TEST(Projected, AColumnUnderItsWeightComesToRest)
{
  Model<2, Projected<2>> m(Mesh<2>(jittered(box<2>({0, 0}, {2, 12}, {2, 12}), 0.2, 1)));
  m.transfer = {.scheme = Scheme::aflip, .musl = true, .pic_damping_time = {}, .pic_damping_crossings = 25};
  add_body<2>(m, "column", rubber(1e7, 0.3, 1000), 6, [](const Vec<2>& x) { return x[1] < 10; });
  for (const char* side : {"x_min", "x_max", "y_min"})
    close_off(m, side, Roller<2>{});
  m.loads.gravity.acceleration = {0, -10};
  make_ready(m);
  Stage rest = test_stage(6);  // 17 periods of the column
  rest.damping = 0.8;
  rest.residual = 1e-3;
  ASSERT_NO_THROW(run_stage(m, rest, StepLimits{.cfl = 0.4}, [](const auto&, RunEvent) {}));
  for (std::size_t p = 0; p < m.particles.id.size(); ++p)
    ASSERT_NEAR(m.particles.stress[p][1], -1e4 * (10 - m.particles.x[p][1]), 1e4) << "the weight of a layer of cells";
}

}  // namespace
}  // namespace talus::testing::projected_test
