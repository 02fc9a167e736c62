// What is special about umls: it is the moving-least-squares estimate, its radius rule, its last resort, its limits, its weaknesses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <stdexcept>

#include "tests/kernels/defects.hpp"

namespace talus::test::umls_test {
namespace {

Real spline(Real q) { return q <= 0.5 ? 0.75 - q * q : q <= 1.5 ? 0.5 * (1.5 - q) * (1.5 - q) : 0; }

/// Values and gradients from the (D+1) x (D+1) moment matrix M = sum W p p^T, p = (1, x_v - x), over all nodes of the mesh.
template <int D>
ByNode<D> direct(const Umls<D>& kernel, const Mesh<D>& mesh, Index c, const Vec<D>& x)
{
  const auto coordinates = mesh.barycentric(c, x);
  std::map<Index, Real> eta;
  Real radius = 0;
  for (std::size_t a = 0; a <= D; ++a) {
    const Index n = mesh.cell(c)[a];
    radius += coordinates[a] * kernel.radius(n);
    for (const Index v : mesh.ring_of_node()[n])
      eta[v] += coordinates[a];
  }
  using Square = Eigen::Matrix<Real, D + 1, D + 1>;
  using Column = Eigen::Matrix<Real, D + 1, 1>;
  Square M = Square::Zero();
  std::map<Index, Column> weighted;
  for (const auto& [v, share] : eta) {
    Column p;
    p << 1, (mesh.node(v) - x) / radius;
    weighted[v] = share * spline((mesh.node(v) - x).norm() / radius) * p;
    M += weighted[v] * p.transpose();
  }
  ByNode<D> all;
  const Square inverse = M.inverse();
  for (const auto& [v, column] : weighted) {
    const Column row = inverse * column;
    all.value[v] = row[0];
    all.gradient[v] = row.template tail<D>() / radius;
  }
  return all;
}

template <class T>
class UmlsIn : public ::testing::Test {};
template <int N>
struct Dimension {
  static constexpr int D = N;
};
using Dimensions = ::testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(UmlsIn, Dimensions);

TYPED_TEST(UmlsIn, MatchesTheFullMomentMatrix)
{
  constexpr int D = TypeParam::D;
  const Mesh<D>& mesh = jittered_mesh<D>();
  const Umls<D> kernel(mesh);
  for_each_trial(kernel, mesh, [&](const auto& probe, Index c, const Vec<D>& x) {
    const auto expected = direct(kernel, mesh, c, x);
    const auto actual = by_node(probe);
    ASSERT_EQ(actual.value.size(), expected.value.size());
    // Values are of size one, gradients of 1/h; both systems are well conditioned on this mesh.
    for (const auto& [v, w] : expected.value)
      ASSERT_NEAR(actual.value.at(v), w, 1e-12);
    for (const auto& [v, g] : expected.gradient)
      ASSERT_LE((actual.gradient.at(v) - g).norm() * mesh.node_size(v), 1e-12);
  });
}

TYPED_TEST(UmlsIn, SeesTheOneRingOfTheVerticesOfACell)
{
  constexpr int D = TypeParam::D;
  const Mesh<D> mesh(unit_box<D>(D == 2 ? 10 : 6));
  const Umls<D> kernel(mesh);
  Real mean = 0, interior = 0;
  std::size_t largest = 0;
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    const auto& vertices = mesh.cell(c);
    largest = std::max(largest, kernel.stencil(mesh, c).size());
    if (std::any_of(vertices.begin(), vertices.end(), [&](Index v) { return mesh.on_boundary(v); }))
      continue;
    mean += static_cast<Real>(kernel.stencil(mesh, c).size());
    ++interior;
  }
  mean /= interior;
  // Counted on the lattice: the union of three hexagons around a triangle; of four rings of fifteen around a tetrahedron of Kuhn's.
  EXPECT_EQ(mean, D == 2 ? 12 : 32);
  EXPECT_EQ(largest, D == 2 ? 12 : 32);
}

TYPED_TEST(UmlsIn, TakesTheMeanEdgeForItsRadiusOnDecentMeshes)
{
  constexpr int D = TypeParam::D;
  for (std::size_t m = 0; m < 2; ++m) {
    const Mesh<D>& mesh = meshes<D>()[m].mesh;
    const Umls<D> kernel(mesh);
    for (Index v = 0; v < mesh.n_nodes(); ++v)
      ASSERT_EQ(kernel.radius(v), mesh.node_size(v));
  }
}

/// A jittered box pressed flat.
template <int D>
Mesh<D> pressed(Real height)
{
  auto data = jittered<D>(unit_box<D>(D == 2 ? 10 : 5), 0.1, 4);
  for (auto& x : data.nodes)
    x[D - 1] *= height;
  return Mesh<D>(std::move(data));
}

TYPED_TEST(UmlsIn, RaisesTheRadiusWhereASampleIsPoorAndStaysContinuous)
{
  constexpr int D = TypeParam::D;
  const Mesh<D> mesh = pressed<D>(0.1);
  const Umls<D> kernel(mesh);
  Index raised = 0;
  for (Index v = 0; v < mesh.n_nodes(); ++v) {
    const Real factor = kernel.radius(v) / mesh.node_size(v);
    ASSERT_THAT(factor, ::testing::AnyOf(::testing::DoubleEq(1), ::testing::DoubleEq(1.25), ::testing::DoubleEq(1.5)));
    raised += factor > 1.1;
  }
  EXPECT_GT(raised, 0);
  EXPECT_LT(raised, mesh.n_nodes());
  const Jumps jump = jumps(kernel, mesh);
  EXPECT_LE(jump.value, 1e-10);
}

TYPED_TEST(UmlsIn, FallsBackOnHatsWhereNoSecondMomentIsUsableAndLinearFieldsStayExact)
{
  constexpr int D = TypeParam::D;
  const Mesh<D> mesh = pressed<D>(1e-4);
  const Umls<D> kernel(mesh);
  const Linear<D> shape(mesh);
  Probe<Linear<D>, D> linear(shape, mesh);
  int fallen = 0;
  for_each_trial(kernel, mesh, [&](const auto& probe, Index c, const Vec<D>& x) {
    if (kernel.roundness(probe.cell, x) > Umls<D>::unusable_roundness)
      return;
    ++fallen;
    linear.enter(c);
    linear.evaluate(x);
    for (int a = 0; a <= D; ++a)
      ASSERT_NEAR(probe.weights.w[a], linear.weights.w[a], 1e-12);
    for (int i = D + 1; i < probe.cell.padded_size; ++i)
      ASSERT_EQ(probe.weights.w[i], 0);
    for (int a = 0; a <= D; ++a)
      ASSERT_EQ(probe.gradient(a), linear.gradient(a));
  });
  EXPECT_GT(fallen, 0);
}

TEST(Umls, RefusesAMeshWithTooManyNeighboursAndSaysWhereAndHowMany)
{
  MeshData<2> fan;
  fan.nodes.push_back(Vec<2>(3, 4));
  constexpr Index spokes = 50;
  for (Index i = 0; i < spokes; ++i) {
    const Real angle = 2 * M_PI * i / spokes;
    fan.nodes.push_back(Vec<2>(3 + std::cos(angle), 4 + std::sin(angle)));
    fan.cells.push_back({0, i + 1, (i + 1) % spokes + 1});
  }
  const Mesh<2> mesh(std::move(fan));
  try {
    const Umls<2> kernel(mesh);
    FAIL() << "accepted " << spokes + 1 << " nodes around one";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(),
                ::testing::MatchesRegex(R"(kernel umls: cell [0-9]+ at \([23]\.[0-9]+, [34]\.[0-9]+\) sees 51 nodes .* room for 48)"));
  }
}

TEST(Umls, GradientIsAnEstimateAndNotTheSlopeOfItsValues)
{
  const Mesh<2>& mesh = jittered_mesh<2>();
  EXPECT_GT(slope_defect(Umls<2>(mesh), mesh), 0.05);
}

TEST(Umls, FailsThePatchTestOnIrregularMeshesAndPassesItOnALattice)
{
  constexpr Real margin = 0.2;  // beyond the reach of the boundary's stencils on these meshes of twelve squares a side
  const auto defect = [](const Mesh<2>& mesh) { return patch_defect(Umls<2>(mesh), mesh, margin); };
  EXPECT_LT(defect(meshes<2>()[0].mesh).largest, 1e-12);
  EXPECT_GT(defect(jittered_mesh<2>()).mean, 0.1);
}

TEST(Umls, HasNegativeValuesInBoundaryCells)
{
  const Mesh<2>& mesh = jittered_mesh<2>();
  const Umls<2> kernel(mesh);
  Real inside = 0, beside = 0;
  for_each_trial(kernel, mesh, [&](const auto& probe, Index c, const Vec<2>&) {
    const auto& vertices = mesh.cell(c);
    const bool wall = std::any_of(vertices.begin(), vertices.end(), [&](Index v) { return mesh.on_boundary(v); });
    Real& least = wall ? beside : inside;
    least = std::min(least, *std::min_element(probe.weights.w, probe.weights.w + probe.cell.size));
  });
  EXPECT_LT(beside, -1e-3);
  EXPECT_GT(beside, -0.1);
  EXPECT_GE(inside, beside);
}

TEST(Umls, WallsLeaveAPercentOrTwoOfWeightToNodesOffTheWall)
{
  const Mesh<2>& mesh = jittered_mesh<2>();
  const Umls<2> kernel(mesh);
  Probe<Umls<2>, 2> probe(kernel, mesh);
  Real mean = 0;
  for (const Facet facet : mesh.boundary_facets()) {
    probe.enter(facet.cell);
    const auto [v, w] = mesh.nodes_of(facet);
    probe.evaluate(0.5 * (mesh.node(v) + mesh.node(w)));
    for (int i = 0; i < probe.cell.size; ++i)
      if (!mesh.on_boundary(probe.number(i)))
        mean += std::abs(probe.weights.w[i]);
  }
  mean /= static_cast<Real>(mesh.boundary_facets().size());
  EXPECT_GT(mean, 0.002);
  EXPECT_LT(mean, 0.03);
}

}  // namespace
}  // namespace talus::test::umls_test
