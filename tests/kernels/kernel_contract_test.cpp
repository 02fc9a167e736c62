// Every kernel against what it says of itself, and against what it does not say: typed over the list of kernels and dimensions.
#include <gtest/gtest.h>

#include <set>

#include "tests/kernels/defects.hpp"

namespace talus::test::kernel_contract_test {
namespace {

template <class Kernel_, int Dimension>
struct On {
  using K = Kernel_;
  static constexpr int D = Dimension;
};
template <class Plane, class Space>
struct Both;
template <class... Plane, class... Space>
struct Both<TypeList<Plane...>, TypeList<Space...>> {
  using type = ::testing::Types<On<Plane, 2>..., On<Space, 3>...>;
};
struct Names {
  template <class T>
  static std::string GetName(int)
  {
    return std::string(T::K::name) + std::to_string(T::D);
  }
};

template <class T>
class KernelContract : public ::testing::Test {};
using EveryKernel = Both<Kernels<2>, Kernels<3>>::type;
TYPED_TEST_SUITE(KernelContract, EveryKernel, Names);

// Sixteen digits, less the six that a second-moment matrix may lose before a kernel must take something else (kernels/umls.hpp).
constexpr Real round_off = 1e-10;
// What is not claimed must be false by much more than round-off.
constexpr Real visible = 1e-3;

/// `defect(mesh)` is round-off on every mesh if claimed, and visible on at least one if not.
template <int D, class Defect>
void prove(bool claimed, Real tolerance, Defect&& defect)
{
  Real worst = 0;
  for (const auto& [name, mesh] : meshes<D>()) {
    const Real here = defect(mesh);
    worst = std::max(worst, here);
    if (claimed) {
      EXPECT_LE(here, tolerance) << "claimed, but false on the mesh: " << name;
    }
  }
  if (!claimed) {
    EXPECT_GE(worst, visible) << "not claimed, but true on every mesh: the kernel is better than it says";
  }
}

TYPED_TEST(KernelContract, HasANameASummaryAndRoomInWholePacks)
{
  using K = typename TypeParam::K;
  static_assert(Kernel<K, TypeParam::D>);
  EXPECT_FALSE(std::string_view(K::name).empty());
  EXPECT_FALSE(std::string_view(K::summary).empty());
  EXPECT_EQ(K::max_nodes % pack_size, 0);
}

TYPED_TEST(KernelContract, StencilHoldsTheCellOnceAndCellRepeatsIt)
{
  constexpr int D = TypeParam::D;
  using K = typename TypeParam::K;
  for (const auto& [name, mesh] : meshes<D>()) {
    const K kernel(mesh);
    Probe<K, D> probe(kernel, mesh);
    for (Index c = 0; c < mesh.n_cells(); ++c) {
      const auto stencil = kernel.stencil(mesh, c);
      const std::set<Index> nodes(stencil.begin(), stencil.end());
      ASSERT_EQ(nodes.size(), stencil.size()) << name << ", cell " << c;
      for (const Index v : mesh.cell(c))
        ASSERT_TRUE(nodes.contains(v)) << name << ", cell " << c << ", node " << v;
      probe.enter(c);
      ASSERT_EQ(probe.cell.cell, c);
      ASSERT_EQ(probe.cell.size, static_cast<int>(stencil.size()));
      ASSERT_EQ(probe.cell.padded_size, padded(probe.cell.size));
      ASSERT_LE(probe.cell.padded_size, K::max_nodes);
      for (int i = 0; i < probe.cell.padded_size; ++i) {
        const bool real = i < probe.cell.size;
        if (real) {
          ASSERT_EQ(probe.cell.nodes[static_cast<std::size_t>(i)], stencil[static_cast<std::size_t>(i)]);
        }
        const Vec<D> about_origin = mesh.node(stencil[real ? static_cast<std::size_t>(i) : 0]) - probe.cell.origin;
        for (int d = 0; d < D; ++d)
          ASSERT_EQ(probe.cell.x[d][i], about_origin[d]);
      }
    }
  }
}

TYPED_TEST(KernelContract, SeveralParticlesAtATimeWeighTheSameAsOneByOne)
{
  using K = typename TypeParam::K;
  constexpr int D = TypeParam::D;
  const Mesh<D>& mesh = jittered_mesh<D>();
  const K kernel(mesh);
  Probe<K, D> one(kernel, mesh);
  const auto points = seeding_points<D>(4).value();
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    one.enter(c);
    for (int count = 1; count <= pack_size; ++count) {
      const auto point = [&](int lane) {
        return place(mesh, c, points[static_cast<std::size_t>(std::min(lane, count - 1)) % points.size()]);
      };
      Pack x[D];
      for (int d = 0; d < D; ++d)
        x[d] = Pack{point(0)[d], point(1)[d], point(2)[d], point(3)[d]};
      Weights<D, K::max_nodes> together;
      kernel.evaluate(one.cell, x, count, together);
      for (int lane = 0; lane < count; ++lane) {
        one.evaluate(point(lane));
        NodeWeights<D, K::max_nodes> weights;
        together.spell_out(lane, weights);
        for (int i = 0; i < one.cell.padded_size; ++i) {
          ASSERT_NEAR(weights.w[i], one.weights.w[i], round_off) << "cell " << c << ", lane " << lane << " of " << count;
          for (int d = 0; d < D; ++d)
            ASSERT_NEAR(weights.dw[d][i], one.weights.dw[d][i], round_off / mesh.altitude(c))
                << "cell " << c << ", lane " << lane << " of " << count;
        }
      }
    }
  }
}

TYPED_TEST(KernelContract, WeightsSumToOneAndGradientsToZeroOnNodesEdgesFacesAndInside)
{
  constexpr int D = TypeParam::D;
  using K = typename TypeParam::K;
  for (const auto& [name, mesh] : meshes<D>()) {
    const K kernel(mesh);
    for_each_trial(kernel, mesh, [&, &at = name](const auto& probe, Index c, const Vec<D>& x) {
      Real sum = 0, size = 0, gradient_size = 0;
      Vec<D> gradient = Vec<D>::Zero();
      for (int i = 0; i < probe.size(); ++i) {
        ASSERT_TRUE(std::isfinite(probe.value(i)) && probe.gradient(i).allFinite()) << at << ", cell " << c << ", x = " << x.transpose();
        sum += probe.value(i);
        size += std::abs(probe.value(i));
        gradient += probe.gradient(i);
        gradient_size += probe.gradient(i).norm();
      }
      ASSERT_NEAR(sum, 1, round_off * size) << at << ", cell " << c << ", x = " << x.transpose();
      ASSERT_LE(gradient.norm(), round_off * gradient_size) << at << ", cell " << c << ", x = " << x.transpose();
    });
  }
}

TYPED_TEST(KernelContract, PaddingCarriesNoWeight)
{
  constexpr int D = TypeParam::D;
  using K = typename TypeParam::K;
  const Mesh<D>& mesh = jittered_mesh<D>();
  const K kernel(mesh);
  int padded_entries = 0;
  for_each_trial(kernel, mesh, [&](const auto& probe, Index, const Vec<D>&) {
    for (int i = probe.cell.size; i < probe.cell.padded_size; ++i, ++padded_entries) {
      ASSERT_EQ(probe.weights.w[i], 0);
      for (int d = 0; d < D; ++d)
        ASSERT_EQ(probe.weights.dw[d][i], 0);
    }
  });
  if (K::max_nodes > D + 1) {
    EXPECT_GT(padded_entries, 0) << "the mesh has no stencil with padding, so nothing was tried";
  }
}

TYPED_TEST(KernelContract, WeightsAreBarycentricCoordinatesOfTheVerticesIfTheKernelSaysSo)
{
  using K = typename TypeParam::K;
  constexpr int D = TypeParam::D;
  std::array<Real, D + 1> inside;
  for (std::size_t a = 0; a <= D; ++a)
    inside[a] = (1.0 + static_cast<Real>(a)) / ((D + 1) * (D + 2) / 2);
  prove<D>(WeighsVertices<K, D>, round_off, [&](const Mesh<D>& mesh) {
    const K kernel(mesh);
    Real worst = 0;
    for (Index c = 0; c < mesh.n_cells(); ++c) {
      if (!std::ranges::equal(kernel.stencil(mesh, c), mesh.cell(c)))
        return Real{1};
      typename K::Cell cell;
      kernel.open(mesh, c, cell);
      const Vec<D> at = place<D>(mesh, c, inside);
      Pack x[D];
      for (int d = 0; d < D; ++d)
        x[d] = broadcast(at[d]);
      Weights<D, K::max_nodes> weights;
      kernel.evaluate(cell, x, 1, weights);
      NodeWeights<D, K::max_nodes> plain;
      weights.spell_out(0, plain);
      for (std::size_t a = 0; a <= D; ++a)
        worst = std::max(worst, std::abs(plain.w[a] - inside[a]));
    }
    return worst;
  });
}

TYPED_TEST(KernelContract, ValuesAreNonNegativeIfClaimed)
{
  using K = typename TypeParam::K;
  constexpr int D = TypeParam::D;
  prove<D>(K(jittered_mesh<D>()).claims().non_negative, round_off, [](const Mesh<D>& mesh) { return negativity(K(mesh), mesh); });
}

TYPED_TEST(KernelContract, ValuesReproduceLinearFieldsIfClaimed)
{
  using K = typename TypeParam::K;
  constexpr int D = TypeParam::D;
  prove<D>(K(jittered_mesh<D>()).claims().linear_values, round_off, [](const Mesh<D>& mesh) { return linear_value_defect(K(mesh), mesh); });
}

TYPED_TEST(KernelContract, GradientsOfLinearFieldsAreExactIfClaimed)
{
  using K = typename TypeParam::K;
  constexpr int D = TypeParam::D;
  prove<D>(K(jittered_mesh<D>()).claims().linear_gradients, round_off,
           [](const Mesh<D>& mesh) { return linear_gradient_defect(K(mesh), mesh); });
}

TYPED_TEST(KernelContract, ValuesAreContinuousAcrossFacesIfClaimed)
{
  using K = typename TypeParam::K;
  constexpr int D = TypeParam::D;
  prove<D>(K(jittered_mesh<D>()).claims().continuous_values, round_off, [](const Mesh<D>& mesh) { return jumps(K(mesh), mesh).value; });
}

TYPED_TEST(KernelContract, GradientIsContinuousAcrossFacesIfClaimed)
{
  using K = typename TypeParam::K;
  constexpr int D = TypeParam::D;
  prove<D>(K(jittered_mesh<D>()).claims().continuous_gradient, round_off,
           [](const Mesh<D>& mesh) { return jumps(K(mesh), mesh).gradient; });
}

TYPED_TEST(KernelContract, GradientIsTheSlopeOfTheValuesIfClaimed)
{
  using K = typename TypeParam::K;
  constexpr int D = TypeParam::D;
  // A step of 1e-5 altitudes is 1e-8 in the flattest cells, of coordinates near one that carry sixteen digits.
  prove<D>(K(jittered_mesh<D>()).claims().gradient_of_values, 1e-7, [](const Mesh<D>& mesh) { return slope_defect(K(mesh), mesh); });
}

TYPED_TEST(KernelContract, GradientsIntegrateToZeroAtInteriorNodesIfClaimed)
{
  using K = typename TypeParam::K;
  constexpr int D = TypeParam::D;
  prove<D>(K(jittered_mesh<D>()).claims().patch_test, round_off,
           [](const Mesh<D>& mesh) { return patch_defect(K(mesh), mesh, 0).largest; });
}

TYPED_TEST(KernelContract, WallsAreClosedIfClaimed)
{
  using K = typename TypeParam::K;
  constexpr int D = TypeParam::D;
  prove<D>(K(jittered_mesh<D>()).claims().closed_walls, round_off, [](const Mesh<D>& mesh) { return wall_leak(K(mesh), mesh); });
}

}  // namespace
}  // namespace talus::test::kernel_contract_test
