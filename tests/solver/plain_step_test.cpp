// The loops of a step, four particles at a time through factors, rows and blocks, beside the formulas they stand for: one particle after
// the other, one node after the other, with the weights of the contract tests.
#include <gtest/gtest.h>

#include <random>

#include "tests/kernels/probe.hpp"
#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::plain_step_test {
namespace {

using test::Probe;

template <int D_, class K_>
struct Of {
  static constexpr int D = D_;
  using K = K_;
};

template <class C>
class PlainFormulas : public ::testing::Test {};
using EveryKernel =
    ::testing::Types<Of<2, Linear<2>>, Of<3, Linear<3>>, Of<2, Umls<2>>, Of<3, Umls<3>>, Of<2, Projected<2>>, Of<3, Projected<3>>>;
TYPED_TEST_SUITE(PlainFormulas, EveryKernel);

struct Dice {
  std::mt19937 random{7};
  std::uniform_real_distribution<Real> number{-1, 1};
  template <class Value>
  Value any()
  {
    return Value::NullaryExpr([&] { return number(random); });
  }
};

/// A ball of particles anywhere in their cells, with any velocity, affine field and stress.
template <class C>
Model<C::D> any_ball(Scheme scheme)
{
  constexpr int D = C::D;
  auto m = make_model<typename C::K>(unit_box<D>(D == 2 ? 8 : 5, 0.2));
  m.problem.transfer = {.scheme = scheme, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  add_body<D>(m, "ball", rubber(1e4, 0.3, 1000), D == 2 ? 6 : 10, [](const Vec<D>& x) { return (x - Vec<D>::Constant(0.5)).norm() < 0.4; });
  Dice dice;
  for (std::size_t p = 0; p < m.state.particles.x.size(); ++p)
    m.state.particles.x.set(p, m.state.particles.x[p] + 1e-3 * dice.any<Vec<D>>());
  make_ready(m);
  advance(m, 1e-12);  // sorts
  set_each(m.state.particles.v, [&](std::size_t) { return dice.any<Vec<D>>(); });
  set_each(m.state.particles.L, [&](std::size_t) { return dice.any<Mat<D>>(); });
  set_each(m.state.particles.stress, [&](std::size_t) { return dice.any<Sym3>(); });
  return m;
}

/// Largest difference over largest entry, of two lists of vectors or tensors.
template <class Value>
Real difference(const std::vector<Value>& a, const std::vector<Value>& b)
{
  Real most = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, (a[i] - b[i]).norm());
    size = std::max(size, b[i].norm());
  }
  return most / size;
}

/// f(p, i, v, w_v, G_v) for every particle p and node v = probe.number(i) that it sees; first(p, sum w_v x_v) for every particle.
template <class K, int D, class First, class F>
void for_each_weight(Model<D>& m, First&& first, F&& f)
{
  Probe<K, D> probe(transfer_of<K>(m).rows().kernel, m.problem.mesh);
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    probe.enter(m.state.particles.cell[p]);
    probe.evaluate(m.state.particles.x[p]);
    Vec<D> place = Vec<D>::Zero();
    for (int i = 0; i < probe.size(); ++i)
      place += probe.value(i) * probe.node(i);
    first(p, place);
    for (int i = 0; i < probe.size(); ++i)
      f(p, static_cast<std::size_t>(probe.number(i)), probe.value(i), probe.gradient(i));
  }
}

constexpr Real rounding_of_sums = 1e-12;

TYPED_TEST(PlainFormulas, GiveTheMassMomentumAndForceOfNodes)
{
  constexpr int D = TypeParam::D;
  auto m = any_ball<TypeParam>(Scheme::aflip);
  m.state.clock.dt = 0.1;  // L is that of the motion that has brought the particles where they are
  sum_on_nodes(m);
  using Mass = Eigen::Matrix<Real, 1, 1>;
  const std::size_t n = m.work.fields[0].nodes.sum.size();
  std::vector<Mass> mass(n, Mass::Zero()), summed_mass(n);
  std::vector<Vec<D>> momentum(n, Vec<D>::Zero()), force = momentum, summed_momentum(n), summed_force(n);
  Vec<D> read_at;
  for_each_weight<typename TypeParam::K>(
      m, [&](std::size_t, const Vec<D>& place) { read_at = place; },
      [&](std::size_t p, std::size_t v, Real w, const Vec<D>& G) {
        const Real m_p = m.state.particles.mass[p];
        const Mat<D> sigma = unpack(m.state.particles.stress[p]).template topLeftCorner<D, D>();
        mass[v][0] += w * m_p;
        const Mat<D> C = m.state.particles.L[p], carried = C * (Mat<D>::Identity() + m.state.clock.dt * C).inverse(),
                     affine =
                         std::is_same_v<typename TypeParam::K, Linear<D>> ? C : Mat<D>(carried * std::min(1.0, C.norm() / carried.norm()));
        momentum[v] += w * m_p * (m.state.particles.v[p] + affine * (m.problem.mesh.node(static_cast<Index>(v)) - read_at));
        force[v] -= m.state.particles.volume[p] * sigma * G;
      });
  for (std::size_t v = 0; v < n; ++v) {
    summed_mass[v][0] = m.work.fields[0].nodes.sum[v].mass;
    summed_momentum[v] = m.work.fields[0].nodes.sum[v].momentum;
    summed_force[v] = m.work.fields[0].nodes.sum[v].force;
  }
  EXPECT_LT(difference(summed_mass, mass), rounding_of_sums);
  EXPECT_LT(difference(summed_momentum, momentum), rounding_of_sums);
  EXPECT_LT(difference(summed_force, force), rounding_of_sums);
}

TYPED_TEST(PlainFormulas, GiveTheVelocityGradientAndMoveOfParticles)
{
  constexpr int D = TypeParam::D;
  for (const Scheme scheme : {Scheme::tpic, Scheme::flip}) {
    auto m = any_ball<TypeParam>(scheme);
    sum_on_nodes(m);
    Dice dice;
    for (auto& node : m.work.fields[0].nodes.motion)
      node = {.v = dice.any<Vec<D>>(), .change = dice.any<Vec<D>>()};
    const std::size_t n = m.state.particles.id.size();
    const Real dt = 0.25;
    std::vector<Vec<D>> v(n, Vec<D>::Zero()), x = m.state.particles.x.values(), read_v(n), read_x(n);
    std::vector<Mat<D>> L(n, Mat<D>::Zero()), read_L(n);
    for (std::size_t p = 0; p < n; ++p)
      if (scheme == Scheme::flip)
        v[p] = m.state.particles.v[p];
    for_each_weight<typename TypeParam::K>(
        m, [](std::size_t, const Vec<D>&) {},
        [&](std::size_t p, std::size_t node, Real w, const Vec<D>& G) {
          const NodeMotion<D>& motion = m.work.fields[0].nodes.motion[node];
          v[p] += w * (scheme == Scheme::flip ? motion.change : motion.v);
          x[p] += dt * w * motion.v;
          L[p] += motion.v * G.transpose();
        });
    read_nodes(m, dt);
    for (std::size_t p = 0; p < n; ++p)
      read_v[p] = m.state.particles.v[p], read_x[p] = m.state.particles.x[p], read_L[p] = m.state.particles.L[p];
    EXPECT_LT(difference(read_v, v), rounding_of_sums);
    EXPECT_LT(difference(read_L, L), rounding_of_sums);
    EXPECT_LT(difference(read_x, x), rounding_of_sums);
  }
}

}  // namespace
}  // namespace talus::testing::plain_step_test
