// The exact slopes of umls' values: they are those, they integrate to zero inside, and hats take their place where hats are taken.
#include <gtest/gtest.h>

#include "tests/kernels/defects.hpp"

namespace talus::test::umls_slopes_test {
namespace {

template <class T>
class UmlsSlopesIn : public ::testing::Test {};
template <int N>
struct Dimension {
  static constexpr int D = N;
};
using Dimensions = ::testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(UmlsSlopesIn, Dimensions);

/// The slopes of the values of one particle.
template <int D>
struct Slopes {
  alignas(64) Real of[D][Umls<D>::max_nodes]{};
  Vec<D> operator[](int i) const
  {
    Vec<D> slope;
    for (int d = 0; d < D; ++d)
      slope[d] = of[d][i];
    return slope;
  }
};
template <int D>
Slopes<D> slopes_at(const Umls<D>& kernel, const typename Umls<D>::Cell& cell, const Vec<D>& x)
{
  Pack at[D];
  for (int d = 0; d < D; ++d)
    at[d] = broadcast(x[d]);
  Weights<D, Umls<D>::max_nodes> weights;
  kernel.evaluate(cell, at, 1, weights);
  Slopes<D> slopes;
  kernel.slopes_of_values(cell, at, 0, weights, slopes.of);
  return slopes;
}

/// f(c, x) at points of every cell that are not on its faces, where eta has a kink.
template <int D, class F>
void for_each_point_inside(const Mesh<D>& mesh, F&& f)
{
  const auto points = seeding_points<D>(D == 2 ? 6 : 4).value();
  for (Index c = 0; c < mesh.n_cells(); ++c)
    for (const auto& b : points)
      f(c, place(mesh, c, b));
}

TYPED_TEST(UmlsSlopesIn, AreThoseOfCentralDifferencesOnEveryMesh)
{
  constexpr int D = TypeParam::D;
  for (const auto& [name, mesh] : meshes<D>()) {
    const Umls<D> kernel(mesh);
    Probe<Umls<D>, D> before(kernel, mesh), after(kernel, mesh);
    for_each_point_inside(mesh, [&, &mesh = mesh, &at = name](Index c, const Vec<D>& x) {
      before.enter(c);
      after.enter(c);
      const auto slopes = slopes_at(kernel, before.cell, x);
      const Real h = mesh.altitude(c), step = 1e-5 * h;
      for (int d = 0; d < D; ++d) {
        before.evaluate(x - step * Vec<D>::Unit(d));
        after.evaluate(x + step * Vec<D>::Unit(d));
        // As for the slopes that kernels claim; where the second slope of the spline jumps the difference is off by the step.
        for (int i = 0; i < before.size(); ++i)
          EXPECT_NEAR(h * slopes[i][d], h * (after.value(i) - before.value(i)) / (2 * step), 1e-5)
              << at << ", cell " << c << ", node " << i;
      }
    });
  }
}

TYPED_TEST(UmlsSlopesIn, SumToZeroAndAreExactForLinearFields)
{
  constexpr int D = TypeParam::D;
  for (const auto& [name, mesh] : meshes<D>()) {
    const Umls<D> kernel(mesh);
    Probe<Umls<D>, D> probe(kernel, mesh);
    for_each_point_inside(mesh, [&, &mesh = mesh, &at = name](Index c, const Vec<D>& x) {
      probe.enter(c);
      const auto slopes = slopes_at(kernel, probe.cell, x);
      Vec<D> total = Vec<D>::Zero();
      Mat<D> off = -Mat<D>::Identity();
      Real size = 0, moments = 1;
      for (int i = 0; i < probe.size(); ++i) {
        const Vec<D> r = probe.node(i) - x;
        total += slopes[i];
        off += r * slopes[i].transpose();
        size += slopes[i].norm();
        moments += r.norm() * slopes[i].norm();
      }
      EXPECT_LE(total.norm(), 1e-12 * size) << at << ", cell " << c;
      EXPECT_LE(off.norm(), 1e-12 * moments) << at << ", cell " << c;
    });
  }
}

/// Largest |int grad w_v dx| h_v / int w_v dx over nodes farther than `margin` from the box's faces, beyond which w_v vanishes on them.
template <int D>
Real defect(const Mesh<D>& mesh, int points, Real margin)
{
  const Umls<D> kernel(mesh);
  const auto places = seeding_points<D>(points).value();
  std::vector<Vec<D>> pull(static_cast<std::size_t>(mesh.n_nodes()), Vec<D>::Zero());
  std::vector<Real> share(pull.size());
  Probe<Umls<D>, D> probe(kernel, mesh);
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    probe.enter(c);
    for (const auto& b : places) {
      const Vec<D> x = place(mesh, c, b);
      probe.evaluate(x);
      const auto slopes = slopes_at(kernel, probe.cell, x);
      for (int i = 0; i < probe.size(); ++i) {
        pull[static_cast<std::size_t>(probe.number(i))] += mesh.volume(c) / points * slopes[i];
        share[static_cast<std::size_t>(probe.number(i))] += mesh.volume(c) / points * probe.value(i);
      }
    }
  }
  Real worst = 0;
  for (Index v = 0; v < mesh.n_nodes(); ++v)
    if ((mesh.node(v) - mesh.low()).minCoeff() > margin && (mesh.high() - mesh.node(v)).minCoeff() > margin)
      worst = std::max(worst, pull[static_cast<std::size_t>(v)].norm() * mesh.node_size(v) / share[static_cast<std::size_t>(v)]);
  return worst;
}

TEST(UmlsSlopes, IntegrateToZeroAtInteriorNodesAsFarAsPointsIntegrate)
{
  const Mesh<2>& mesh = jittered_mesh<2>();
  constexpr Real margin = 0.2;  // beyond the reach of a node on this mesh of twelve squares a side
  const Real estimate = patch_defect(Umls<2>(mesh), mesh, margin).largest;
  const Real coarse = defect(mesh, 24, margin), fine = defect(mesh, 96, margin);
  EXPECT_LT(coarse, 0.05 * estimate);
  EXPECT_LT(fine, 0.5 * coarse) << "points of half the spacing integrate a function with kinks better at least in proportion";
}

TYPED_TEST(UmlsSlopesIn, AreThoseOfHatsWhereNoSecondMomentIsUsable)
{
  constexpr int D = TypeParam::D;
  auto data = jittered<D>(unit_box<D>(D == 2 ? 10 : 5), 0.1, 4);
  for (auto& x : data.nodes)
    x[D - 1] *= 1e-4;  // so flat that hats are taken nearly everywhere
  const Mesh<D> mesh(std::move(data));
  const Umls<D> kernel(mesh);
  Probe<Umls<D>, D> probe(kernel, mesh);
  int fallen = 0;
  for_each_point_inside(mesh, [&](Index c, const Vec<D>& x) {
    probe.enter(c);
    if (kernel.roundness(probe.cell, x) > Umls<D>::unusable_roundness)
      return;
    ++fallen;
    const auto slopes = slopes_at(kernel, probe.cell, x);
    for (int a = 0; a <= D; ++a)
      EXPECT_EQ(slopes[a], mesh.gradients(c)[static_cast<std::size_t>(a)]);
    for (int i = D + 1; i < probe.size(); ++i)
      EXPECT_EQ(slopes[i], Vec<D>::Zero());
  });
  EXPECT_GT(fallen, 0);
}

}  // namespace
}  // namespace talus::test::umls_slopes_test
