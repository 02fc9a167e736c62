// Node operators, and a small kernel with a node part: the seam between cell part and node part holds what it promises.
#include <gtest/gtest.h>

#include "kernels/node_operators.hpp"
#include "tests/kernels/defects.hpp"

namespace talus::test {
namespace {

/// Hats at the particle, the lumped L2 pair at the nodes: the smallest kernel with a node part.
template <int D>
class TestProjected : public Linear<D> {
 public:
  static constexpr std::string_view name = "test_projected";
  explicit TestProjected(const Mesh<D>& mesh) : Linear<D>(mesh), node_part_(lumped_l2(mesh)) {}
  const NodeOperators<D>& node_part() const noexcept { return node_part_; }

 private:
  NodeOperators<D> node_part_;
};
static_assert(Kernel<TestProjected<2>, 2> && Kernel<TestProjected<3>, 3>);
static_assert(HasNodePart<TestProjected<2>, 2> && HasNodePart<TestProjected<3>, 3>);
static_assert(!HasNodePart<TestProjected<2>, 3> && !HasNodePart<Linear<2>, 2> && !HasNodePart<Umls<3>, 3>);

template <class T>
class NodeOperatorsIn : public ::testing::Test {};
template <int N>
struct Dimension {
  static constexpr int D = N;
};
using Dimensions = ::testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(NodeOperatorsIn, Dimensions);

// Rows are sums of some ten to forty products of doubles.
constexpr Real round_off = 1e-12;

TYPED_TEST(NodeOperatorsIn, RowsOfValuesSumToOneAndAreNotNegative)
{
  constexpr int D = TypeParam::D;
  for (const auto& [name, mesh] : meshes<D>()) {
    const auto operators = lumped_l2(mesh);
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      Real sum = 0;
      for (const Real s : operators.S_row(n)) {
        ASSERT_GT(s, 0) << name;
        sum += s;
      }
      ASSERT_NEAR(sum, 1, round_off) << name << ", node " << n;
    }
  }
}

TYPED_TEST(NodeOperatorsIn, RowsOfGradientsSumToZeroAndAreExactForLinearFields)
{
  constexpr int D = TypeParam::D;
  for (const auto& [name, mesh] : meshes<D>()) {
    const auto operators = lumped_l2(mesh);
    const Mat<D> slope = Mat<D>::Random();
    std::vector<Vec<D>> field;
    for (const Vec<D>& x : mesh.nodes())
      field.push_back(slope * x + Vec<D>::Ones());
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      Vec<D> sum = Vec<D>::Zero();
      Real size = 0;
      for (const Vec<D>& d : operators.D_row(n)) {
        sum += d;
        size += d.norm();
      }
      ASSERT_LE(sum.norm(), round_off * size) << name << ", node " << n;
      ASSERT_LE((operators.gradient(n, field) - slope).norm(), round_off * size) << name << ", node " << n;
    }
  }
}

TYPED_TEST(NodeOperatorsIn, ColumnsAreTheRowsTransposedToTheBit)
{
  constexpr int D = TypeParam::D;
  const Mesh<D>& mesh = jittered_mesh<D>();
  const auto operators = lumped_l2(mesh);
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    for (std::size_t i = 0; i < operators.ring(n).size(); ++i) {
      const Index v = operators.ring(n)[i];
      const auto back = operators.ring(v);
      const auto j = static_cast<std::size_t>(std::lower_bound(back.begin(), back.end(), n) - back.begin());
      ASSERT_EQ(operators.S_row(n)[i], operators.S_column(v)[j]);
      ASSERT_EQ(operators.D_row(n)[i], operators.D_column(v)[j]);
    }
}

TYPED_TEST(NodeOperatorsIn, ScatterIsTheTransposeOfGather)
{
  constexpr int D = TypeParam::D;
  const Mesh<D>& mesh = jittered_mesh<D>();
  const auto operators = lumped_l2(mesh);
  const auto size = static_cast<std::size_t>(mesh.n_nodes());
  std::vector<Real> a(size), b(size);
  std::vector<Vec<D>> velocity(size);
  std::vector<Mat<D>> stress(size);
  for (std::size_t i = 0; i < size; ++i) {
    a[i] = Vec<1>::Random()[0];
    b[i] = Vec<1>::Random()[0];
    velocity[i].setRandom();
    stress[i].setRandom();
  }
  Real gathered = 0, scattered = 0, power = 0, work = 0;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    const auto i = static_cast<std::size_t>(n);
    gathered += b[i] * operators.template values<Real>(n, a);
    scattered += a[i] * operators.template value_sums<Real>(n, b);
    power += stress[i].cwiseProduct(operators.gradient(n, velocity)).sum();  // T : L
    work += velocity[i].dot(operators.gradient_sums(n, stress));             // v . sum T D
  }
  const Real terms = static_cast<Real>(mesh.ring_of_node().item.size());
  EXPECT_NEAR(gathered, scattered, 1e-15 * terms);
  EXPECT_NEAR(power, work, 1e-15 * terms / mesh.altitude(0));
}

TYPED_TEST(NodeOperatorsIn, UniformStressPullsAtNoInteriorNode)
{
  constexpr int D = TypeParam::D;
  for (const auto& [name, mesh] : meshes<D>()) {
    const auto operators = lumped_l2(mesh);
    const auto volumes = hat_volumes(mesh);
    Real pull_at_walls = 0;
    for (Index v = 0; v < mesh.n_nodes(); ++v) {
      Vec<D> pull = Vec<D>::Zero();
      Real size = 0;
      for (std::size_t i = 0; i < operators.ring(v).size(); ++i) {
        const Vec<D> term = volumes[static_cast<std::size_t>(operators.ring(v)[i])] * operators.D_column(v)[i];
        pull += term;
        size += term.norm();
      }
      if (mesh.on_boundary(v)) {
        pull_at_walls = std::max(pull_at_walls, pull.norm() / size);
      } else {
        ASSERT_LE(pull.norm(), round_off * size) << name << ", node " << v;
      }
    }
    EXPECT_GT(pull_at_walls, 0.1) << name;
  }
}

TYPED_TEST(NodeOperatorsIn, ProjectedWeightsHaveTheGradientsOfLinearFieldsAndOneForOne)
{
  constexpr int D = TypeParam::D;
  const Mesh<D>& mesh = jittered_mesh<D>();
  const TestProjected<D> kernel(mesh);
  const auto& operators = kernel.node_part();
  for_each_trial(kernel, mesh, [&](const auto& probe, Index, const Vec<D>& x) {
    Real sum = 0, size = 0;
    Mat<D> slope = Mat<D>::Zero();
    for (int a = 0; a <= D; ++a) {
      const Index n = probe.number(a);
      for (std::size_t i = 0; i < operators.ring(n).size(); ++i) {
        sum += probe.weights.w[a] * operators.S_row(n)[i];
        const Vec<D> r = mesh.node(operators.ring(n)[i]) - x;
        slope += probe.weights.w[a] * r * operators.D_row(n)[i].transpose();
        size += r.norm() * operators.D_row(n)[i].norm();
      }
    }
    ASSERT_NEAR(sum, 1, round_off);
    ASSERT_LE((slope - Mat<D>::Identity()).norm(), round_off * size);
  });
}

}  // namespace
}  // namespace talus::test
