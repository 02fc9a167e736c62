// Forces of umls from the exact slopes of its values: each particle's share, their sum, and the work in linear motions.
#include <gtest/gtest.h>

#include <random>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing::exact_force_test {
namespace {

template <class T>
class ExactForceIn : public ::testing::Test {};
template <int N>
struct Dimension {
  static constexpr int D = N;
};
using Dimensions = ::testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(ExactForceIn, Dimensions);

/// A block of particles with random stress, its forces summed on the nodes.
template <int D>
Model<D> stressed_block(UmlsGradient gradient)
{
  auto m = make_model<Umls<D>>(unit_box<D>(D == 2 ? 8 : 5, 0.2), UmlsOptions{gradient});
  m.problem.transfer = {.scheme = Scheme::flip, .musl = true, .pic_damping_time = {}, .pic_damping_crossings = {}};
  const auto inside = [](const Vec<D>& x) { return (x - Vec<D>::Constant(0.5)).norm() < 0.35; };
  add_body<D>(m, "block", rubber(1e4, 0.3, 1000), D == 2 ? 6 : 4, inside);
  make_ready(m);
  advance(m, 1e-12);
  std::mt19937 random(3);
  std::uniform_real_distribution<Real> number(-1, 1);
  set_each(m.state.particles.stress, [&](std::size_t) { return Sym3(Sym3::NullaryExpr([&] { return number(random); })); });
  sum_on_nodes(m);
  return m;
}

template <int D>
Mat<D> tension(const Model<D>& m, std::size_t p)
{
  return m.state.particles.volume[p] * unpack(m.state.particles.stress[p]).template topLeftCorner<D, D>();
}

/// sum_p |V sigma| times the slope of a weight, 1/h: the scale of forces.
template <int D>
Real scale(const Model<D>& m)
{
  Real sum = 0;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p)
    sum += tension(m, p).norm() / m.problem.mesh.altitude(m.state.particles.cell[p]);
  return sum;
}

TYPED_TEST(ExactForceIn, IsMinusTheStressOfParticlesOnTheSlopesOfTheValues)
{
  constexpr int D = TypeParam::D;
  auto m = stressed_block<D>(UmlsGradient::exact_force);
  const Umls<D>& kernel = transfer_of<Umls<D>>(m).rows().kernel;
  std::vector<Vec<D>> expected(m.work.fields[0].nodes.sum.size(), Vec<D>::Zero());
  typename Umls<D>::Cell cell;
  Weights<D, Umls<D>::max_nodes> weights;
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    Pack x[D];
    for (int d = 0; d < D; ++d)
      x[d] = broadcast(m.state.particles.x[p][d]);
    alignas(64) Real slopes[D][Umls<D>::max_nodes];
    kernel.open(m.problem.mesh, m.state.particles.cell[p], cell);
    kernel.evaluate(cell, x, 1, weights);
    kernel.slopes_of_values(cell, x, 0, weights, slopes);
    for (std::size_t i = 0; i < cell.nodes.size(); ++i)
      for (int d = 0; d < D; ++d)
        expected[static_cast<std::size_t>(cell.nodes[i])] -= tension(m, p).col(d) * slopes[d][i];
  }
  Real largest = 0;
  for (std::size_t n = 0; n < expected.size(); ++n) {
    EXPECT_LE((m.work.fields[0].nodes.sum[n].force - expected[n]).norm(), 1e-14 * scale(m)) << "node " << n;
    largest = std::max(largest, expected[n].norm());
  }
  EXPECT_GT(largest, 1e-4 * scale(m));
}

TYPED_TEST(ExactForceIn, SumsToZeroAndDoesTheWorkOfLinearMotionsOnly)
{
  constexpr int D = TypeParam::D;
  const Mat<D> A = Mat<D>::Random();
  std::mt19937 random(4);
  std::uniform_real_distribution<Real> number(-1, 1);
  for (const UmlsGradient gradient : {UmlsGradient::estimate, UmlsGradient::exact_force}) {
    auto m = stressed_block<D>(gradient);
    Vec<D> total = Vec<D>::Zero();
    Real linear = 0, power = 0, stress_power = 0;
    for (Index n = 0; n < m.problem.mesh.n_nodes(); ++n) {
      const Vec<D>& f = m.work.fields[0].nodes.sum[static_cast<std::size_t>(n)].force;
      NodeMotion<D>& node = m.work.fields[0].nodes.motion[static_cast<std::size_t>(n)];
      total += f;
      linear += f.dot(A * m.problem.mesh.node(n));
      for (int d = 0; d < D; ++d)
        node.change[d] = node.v[d] = number(random);
      power += f.dot(node.v);
    }
    read_nodes(m, 0);
    for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
      linear += tension(m, p).cwiseProduct(A).sum();
      stress_power += tension(m, p).cwiseProduct(m.state.particles.L[p]).sum();
    }
    EXPECT_LE(total.norm(), 1e-14 * scale(m));
    EXPECT_LE(std::abs(linear), 1e-13 * scale(m));
    const Real unpaired = std::abs(power + stress_power) / std::abs(stress_power);
    if (gradient == UmlsGradient::estimate)
      EXPECT_LE(unpaired, 1e-12);
    else
      EXPECT_GE(unpaired, 1e-3) << "the strain is still that of the estimate";
  }
}

/// Neither momentum nor the run may suffer from the unpaired work.
TYPED_TEST(ExactForceIn, KeepsTheMomentumOfAFreeBlock)
{
  constexpr int D = TypeParam::D;
  auto m = stressed_block<D>(UmlsGradient::exact_force);
  m.state.particles.stress.assign(m.state.particles.stress.size(), Sym3::Zero());
  Mat<D> A = Mat<D>::Zero();
  A(0, 1) = -0.6;
  A(0, 0) = 0.3;
  set_velocity<D>(m, A, Vec<D>::Constant(-0.1));
  const auto before = totals(m);
  run_until(m, 0.2);
  EXPECT_FALSE(m.work.errors.worst());
  EXPECT_LT((totals(m).momentum - before.momentum).norm(), 1e-12 * 0.2 * before.mass);
  EXPECT_LT(totals(m).kinetic, before.kinetic) << "some of it has gone into strain";
}

}  // namespace
}  // namespace talus::testing::exact_force_test
