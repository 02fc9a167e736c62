// Node operators, and the value stencils of the projected kernel.
#include <gtest/gtest.h>

#include <numeric>

#include "kernels/projected.hpp"
#include "tests/kernels/defects.hpp"

namespace talus::test {
namespace {

template <int D>
NodeOperators<D> operators_of(const Mesh<D>& mesh)
{
  return NodeOperators<D>(mesh, l2_values(mesh), averaged_gradients(mesh));
}

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
    const auto operators = operators_of(mesh);
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
    const auto operators = operators_of(mesh);
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
  const auto operators = operators_of(mesh);
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
  const auto operators = operators_of(mesh);
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
    const auto operators = operators_of(mesh);
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

/// sum_v S_nv (x_v - x_n) / h_n
template <int D>
Vec<D> first_moment(const Mesh<D>& mesh, const std::vector<Real>& S, Index n)
{
  Vec<D> moment = Vec<D>::Zero();
  const auto ring = mesh.ring_of_node()[n];
  for (std::size_t k = 0; k < ring.size(); ++k)
    moment += S[static_cast<std::size_t>(mesh.ring_of_node().begin[static_cast<std::size_t>(n)]) + k] * (mesh.node(ring[k]) - mesh.node(n));
  return moment / mesh.node_size(n);
}

TYPED_TEST(NodeOperatorsIn, MaxentIsPositiveSumsToOneAndIsExactForLinearFieldsInsideAndAlongWalls)
{
  constexpr int D = TypeParam::D;
  for (const auto& [name, mesh] : meshes<D>()) {
    const auto S = maxent_values(mesh, 0.5, 0.25);
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      const auto begin = S.begin() + mesh.ring_of_node().begin[static_cast<std::size_t>(n)];
      const auto end = begin + static_cast<std::ptrdiff_t>(mesh.ring_of_node()[n].size());
      ASSERT_GT(*std::min_element(begin, end), 0) << name << ", node " << n;
      ASSERT_NEAR(std::accumulate(begin, end, 0.0), 1, round_off) << name << ", node " << n;
      Vec<D> moment = first_moment(mesh, S, n);
      for (int d = 0; d < D; ++d)  // the box: its walls are normal to the axes
        if (mesh.node(n)[d] < 1e-9 || mesh.node(n)[d] > 1 - 1e-9)
          moment[d] = 0;
      ASSERT_LE(moment.norm(), round_off) << name << ", node " << n;
    }
  }
}

TYPED_TEST(NodeOperatorsIn, MovingLeastSquaresAreExactForLinearFieldsAtEveryNode)
{
  constexpr int D = TypeParam::D;
  for (const auto& [name, mesh] : meshes<D>()) {
    const auto S = mls_values(mesh, 0.25);
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      ASSERT_LE(first_moment(mesh, S, n).norm(), 1e-10) << name << ", node " << n;  // of an inverse of second moments of flat rings
  }
}

TYPED_TEST(NodeOperatorsIn, SmallerWeightsOfNeighboursDrawTheMassToTheNode)
{
  constexpr int D = TypeParam::D;
  const Mesh<D>& mesh = jittered_mesh<D>();
  const auto narrow = maxent_values(mesh, 0.1, 0.25), wide = maxent_values(mesh, 1, 0.25);
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    const std::size_t own = entry_of(mesh.ring_of_node(), n, n);
    ASSERT_GT(narrow[own], 1.5 * wide[own]) << "node " << n;
  }
}

}  // namespace
}  // namespace talus::test
