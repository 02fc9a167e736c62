// Angular momentum on the way to the nodes and back: what particles carry, with the spin of their affine fields.
#include <gtest/gtest.h>

#include <random>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::angular_momentum_test {
namespace {

template <class K_, int D_>
struct With {
  using K = K_;
  static constexpr int D = D_;
};
template <class C>
class AngularMomentum : public ::testing::Test {};
using Kernels = ::testing::Types<With<Linear<2>, 2>, With<Linear<3>, 3>, With<Umls<2>, 2>, With<Umls<3>, 3>>;
TYPED_TEST_SUITE(AngularMomentum, Kernels);

/// D = sum w r (x) r of each particle, by id.
template <class K, int D>
std::vector<Mat<D>> second_moments(const Model<D>& m)
{
  const Mesh<D>& mesh = m.problem.mesh;
  const auto& p = m.state.particles;
  const K kernel(mesh);
  std::vector<Mat<D>> all(p.id.size(), Mat<D>::Zero());
  for (std::size_t i = 0; i < p.id.size(); ++i) {
    typename K::Cell cell;
    kernel.open(mesh, p.cell[i], cell);
    Weights<D, K::max_nodes> weights;
    Pack x[D];
    for (int d = 0; d < D; ++d)
      x[d] = broadcast(p.x[i][d]);
    kernel.evaluate(cell, x, 1, weights);
    NodeWeights<D, K::max_nodes> plain;
    weights.spell_out(0, plain);
    for (std::size_t a = 0; a < cell.nodes.size(); ++a) {
      const Vec<D> r = mesh.node(cell.nodes[a]) - Vec<D>(p.x[i]);
      all[static_cast<std::size_t>(p.id[i])] += plain.w[a] * r * r.transpose();
    }
  }
  return all;
}

template <int D>
std::vector<Vec<D>> places(const Model<D>& m)
{
  std::vector<Vec<D>> all(m.state.particles.id.size());
  for (std::size_t i = 0; i < all.size(); ++i)
    all[static_cast<std::size_t>(m.state.particles.id[i])] = m.state.particles.x[i];
  return all;
}

/// The skew part of sum m (v (x) x + A D), and of sum m v (x) x alone: angular momentum about the origin [kg m^2/s].
template <int D>
struct Turning {
  Mat<D> with_spin = Mat<D>::Zero(), without = Mat<D>::Zero();
};
template <int D>
Turning<D> turning(const Model<D>& m, const std::vector<Vec<D>>& x, const std::vector<Mat<D>>& moments)
{
  const auto& p = m.state.particles;
  Turning<D> all;
  for (std::size_t i = 0; i < p.id.size(); ++i) {
    const Mat<D> A = p.C.empty() ? Mat<D>(p.L[i]) : Mat<D>(p.C[i]);
    const Mat<D> plain = p.mass[i] * Vec<D>(p.v[i]) * x[static_cast<std::size_t>(p.id[i])].transpose();
    const Mat<D> full = plain + p.mass[i] * A * moments[static_cast<std::size_t>(p.id[i])];
    all.without += plain - plain.transpose();
    all.with_spin += full - full.transpose();
  }
  return all;
}

/// How much a step without forces changes angular momentum, over sum m |v| |x|: of particles with any velocities and affine fields in the
/// middle of a mesh, at the positions at which they read the nodes.
template <class C>
Turning<C::D> change_in_a_step(Scheme scheme, Real jitter)
{
  constexpr int D = C::D;
  auto m = make_model<typename C::K>(unit_box<D>(D == 2 ? 10 : 6, jitter));
  m.problem.transfer = {.scheme = scheme, .musl = false, .pic_damping_time = {}, .pic_damping_crossings = {}};
  add_body<D>(m, "ball", rubber(1e4, 0.3, 1000), D == 2 ? 3 : 4, [](const Vec<D>& x) { return (x - Vec<D>::Constant(0.5)).norm() < 0.25; });
  make_ready(m);
  for (auto& field : m.work.fields)  // no nodes of small mass, which hand on momentum to others
    field.nodes.least_share = field.nodes.least_share_of_gross = 0;
  std::mt19937 random(3);
  std::uniform_real_distribution<Real> number(-1, 1);
  auto& p = m.state.particles;
  Real scale = 0;
  for (std::size_t i = 0; i < p.id.size(); ++i) {
    const Mat<D> A = 10 * Mat<D>::NullaryExpr([&] { return number(random); });
    p.v.set(i, Vec<D>::NullaryExpr([&] { return number(random); }));
    p.L.set(i, A);
    if (!p.C.empty())
      p.C.set(i, A);
    scale += p.mass[i] * Vec<D>(p.v[i]).norm() * Vec<D>(p.x[i]).norm();
  }
  const std::vector<Mat<D>> moments = second_moments<typename C::K, D>(m);
  const std::vector<Vec<D>> x = places(m);
  const Turning<D> before = turning(m, x, moments);
  advance(m, 1e-5);
  Turning<D> after = turning(m, x, moments);
  after.with_spin = (after.with_spin - before.with_spin) / scale;
  after.without = (after.without - before.without) / scale;
  return after;
}

TYPED_TEST(AngularMomentum, OfApicIsKeptToRoundingOnceSpinsAreCounted)
{
  for (const Real jitter : {0.0, 0.2}) {
    const auto change = change_in_a_step<TypeParam>(Scheme::apic, jitter);
    EXPECT_LT(change.with_spin.norm(), 1e-14) << jitter;
    EXPECT_GT(change.without.norm(), 1e-5) << jitter << ": spins and velocities must exchange some";
  }
}

/// Of linear shape functions the field of a cell is linear: B = L D, and `tpic` is `apic`.
TYPED_TEST(AngularMomentum, OfTpicIsKeptWhereFieldsAreLinear)
{
  const Real change = change_in_a_step<TypeParam>(Scheme::tpic, 0.2).with_spin.norm();
  if (std::is_same_v<typename TypeParam::K, Linear<TypeParam::D>>) {
    EXPECT_LT(change, 1e-14);
  } else {
    EXPECT_GT(change, 1e-6) << "a gradient leaves out what is not linear";
  }
}

}  // namespace
}  // namespace talus::testing::angular_momentum_test
