// Node operators, and the value stencil of the projected kernel.
#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "kernels/projected.hpp"
#include "tests/kernels/defects.hpp"

namespace talus::test::node_operators_test {
namespace {

template <int D>
NodeOperators<D> operators_of(const Mesh<D>& mesh)
{
  return NodeOperators<D>(mesh, maxent_values(mesh, 0.5).S, averaged_gradients(mesh));
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

TYPED_TEST(NodeOperatorsIn, RowsOfGradientsSumToZeroAndAreExactForLinearFields)
{
  constexpr int D = TypeParam::D;
  for (const auto& [name, mesh] : meshes<D>()) {
    const auto operators = operators_of(mesh);
    const Mat<D> slope = Mat<D>::Random();
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      Vec<D> sum = Vec<D>::Zero();
      Mat<D> found = Mat<D>::Zero();
      Real size = 0;
      operators.for_each_in_row(n, [&](Index v, Real, const Vec<D>& gradient) {
        sum += gradient;
        found += (slope * mesh.node(v) + Vec<D>::Ones()) * gradient.transpose();
        size += gradient.norm();
      });
      ASSERT_LE(sum.norm(), round_off * size) << name << ", node " << n;
      ASSERT_LE((found - slope).norm(), round_off * size) << name << ", node " << n;
    }
  }
}

TYPED_TEST(NodeOperatorsIn, ColumnsAreTheRowsTransposedToTheBit)
{
  constexpr int D = TypeParam::D;
  const Mesh<D>& mesh = jittered_mesh<D>();
  const auto operators = operators_of(mesh);
  std::map<std::pair<Index, Index>, std::pair<Real, Vec<D>>> by_row;
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    operators.for_each_in_row(n, [&](Index v, Real S, const Vec<D>& gradient) { by_row[{n, v}] = {S, gradient}; });
  std::size_t in_columns = 0;
  for (Index v = 0; v < mesh.n_nodes(); ++v)
    operators.for_each_in_column(v, [&](Index n, Real S, const Vec<D>& gradient) {
      EXPECT_EQ(by_row.at({n, v}), std::pair(S, gradient)) << n << ", " << v;
      ++in_columns;
    });
  EXPECT_EQ(in_columns, by_row.size());
}

TYPED_TEST(NodeOperatorsIn, AreTheSameToTheBitForAnyNumberOfThreads)
{
  constexpr int D = TypeParam::D;
  const Mesh<D>& mesh = jittered_mesh<D>();
  const int before = threads();
  const auto numbers_of = [&](int n_threads) {
    set_threads(n_threads);
    const auto operators = operators_of(mesh);
    std::vector<Real> numbers;
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      const auto add = [&](Index v, Real S, const Vec<D>& gradient) {
        numbers.insert(numbers.end(), {static_cast<Real>(v), S});
        numbers.insert(numbers.end(), gradient.begin(), gradient.end());
      };
      operators.for_each_in_row(n, add);
      operators.for_each_in_column(n, add);
      numbers.insert(numbers.end(), operators.centre(n).begin(), operators.centre(n).end());
    }
    return numbers;
  };
  const auto of_one = numbers_of(1);
  for (const int n_threads : {2, 3, 7})
    EXPECT_EQ(numbers_of(n_threads), of_one) << n_threads << " threads";
  set_threads(before);
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
      operators.for_each_in_column(v, [&](Index n, Real, const Vec<D>& gradient) {
        const Vec<D> term = volumes[static_cast<std::size_t>(n)] * gradient;
        pull += term;
        size += term.norm();
      });
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

TYPED_TEST(NodeOperatorsIn, MaxentIsNotNegativeSumsToOneAndIsExactForLinearFieldsUpToFlatWalls)
{
  constexpr int D = TypeParam::D;
  for (const auto& [name, mesh] : meshes<D>()) {
    const auto S = maxent_values(mesh, 0.5).S;
    for (Index n = 0; n < mesh.n_nodes(); ++n) {
      const auto begin = S.begin() + mesh.ring_of_node().begin[static_cast<std::size_t>(n)];
      const auto end = begin + static_cast<std::ptrdiff_t>(mesh.ring_of_node()[n].size());
      ASSERT_GE(*std::min_element(begin, end), 0) << name << ", node " << n;
      ASSERT_NEAR(std::accumulate(begin, end, 0.0), 1, round_off) << name << ", node " << n;
      ASSERT_LE(first_moment(mesh, S, n).norm(), round_off) << name << ", node " << n;
    }
  }
}

TYPED_TEST(NodeOperatorsIn, MaxentReachesAllNeighboursInsideAndNoneOffTheWallOnIt)
{
  constexpr int D = TypeParam::D;
  const Mesh<D>& mesh = jittered_mesh<D>();
  const auto S = maxent_values(mesh, 0.5).S;
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    for (const Index v : mesh.ring_of_node()[n]) {
      bool beside = true;  // v lies on every wall of the box that n lies on
      for (int d = 0; d < D; ++d)
        beside = beside && (std::abs(mesh.node(n)[d] - 0.5) < 0.5 - 1e-9 || std::abs(mesh.node(v)[d] - mesh.node(n)[d]) < 1e-9);
      ASSERT_EQ(S[entry_of(mesh.ring_of_node(), n, v)] > 0, beside) << "nodes " << n << " and " << v;
    }
}

TYPED_TEST(NodeOperatorsIn, SmallerWeightsOfNeighboursDrawTheMassToTheNode)
{
  constexpr int D = TypeParam::D;
  const Mesh<D>& mesh = jittered_mesh<D>();
  const auto narrow = maxent_values(mesh, 0.1).S, wide = maxent_values(mesh, 1).S;
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    const std::size_t own = entry_of(mesh.ring_of_node(), n, n);
    const bool corner = (mesh.node(n).array() - 0.5).abs().minCoeff() > 0.5 - 1e-9;  // alone on all its walls
    ASSERT_GT(narrow[own], corner ? 0.99 : 1.5 * wide[own]) << "node " << n;
  }
}

}  // namespace
}  // namespace talus::test::node_operators_test
