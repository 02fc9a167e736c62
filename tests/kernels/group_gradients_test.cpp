// Gradients of the bodies of one material at a node between materials.
#include "kernels/group_gradients.hpp"

#include <gtest/gtest.h>

#include <random>

#include "kernels/node_operators.hpp"
#include "tests/kernels/probe.hpp"

namespace talus::test::group_gradients_test {
namespace {

template <class T>
class GroupGradientsIn : public ::testing::Test {};
template <int N>
struct Dimension {
  static constexpr int D = N;
};
using Dimensions = ::testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(GroupGradientsIn, Dimensions);

constexpr Real round_off = 1e-12;
constexpr std::size_t groups = 2;

/// A node inside the mesh with all of its cells.
template <int D>
Index inner_node(const Mesh<D>& mesh)
{
  Index n = 0;
  while (mesh.on_boundary(n))
    ++n;
  return n;
}

/// What two groups fill around a node, at random; some cells hold one of them or none.
template <int D>
std::vector<Real> random_filling(const Mesh<D>& mesh, Index node, std::uint64_t seed)
{
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<Real> number(0, 1);
  std::vector<Real> w;
  for (const Index c : mesh.cells_of_node()[node]) {
    const Real all = mesh.volume(c) / (D + 1), share = number(random), kind = number(random);
    w.push_back(kind < 0.2 ? 0 : kind < 0.5 ? all : all * share);
    w.push_back(kind < 0.2 ? 0 : kind < 0.5 ? 0 : all * (1 - share));
  }
  w[0] = w[groups + 1] = mesh.volume(mesh.cells_of_node()[node][0]);  // both are there
  w[1] = w[groups] = 0;
  return w;
}

TYPED_TEST(GroupGradientsIn, AreExactForLinearFieldsAndSumToZero)
{
  constexpr int D = TypeParam::D;
  const Mesh<D>& mesh = jittered_mesh<D>();
  const Mat<D> slope = Mat<D>::Random();
  const Index n = inner_node(mesh);
  const auto ring = mesh.ring_of_node()[n];
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<Real> shares = random_filling(mesh, n, seed);
    std::vector<Vec<D>> rows(groups * ring.size());
    fit_shares(mesh, n, groups, std::span(shares));
    group_gradients<D>(mesh, n, groups, shares, rows);
    for (std::size_t b = 0; b < groups; ++b) {
      Vec<D> sum = Vec<D>::Zero();
      Mat<D> found = Mat<D>::Zero();
      Real size = 0;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec<D>& gradient = rows[b * ring.size() + i];
        sum += gradient, size += gradient.norm();
        found += slope * mesh.node(ring[i]) * gradient.transpose();
      }
      ASSERT_LE(sum.norm(), round_off * size) << "seed " << seed;
      ASSERT_LE((found - slope).norm(), round_off * size) << "seed " << seed;
    }
  }
}

/// Difference between the part of the filled volume that the shares give to the first group and the part of its particles.
template <int D>
Real misfit(const Mesh<D>& mesh, Index n, const std::vector<Real>& w, const std::vector<Real>& shares)
{
  Real filled = 0, volume = 0, particles = 0, all = 0;
  for (std::size_t c = 0; c < mesh.cells_of_node()[n].size(); ++c)
    if (const Real of_cell = w[2 * c] + w[2 * c + 1]; of_cell > 0) {
      const Real size = mesh.volume(mesh.cells_of_node()[n][c]);
      filled += size, volume += shares[2 * c] * size;
      all += of_cell, particles += w[2 * c];
    }
  return std::abs(volume / filled - particles / all);
}

TYPED_TEST(GroupGradientsIn, SharesOfACellAddUpToOneAndThoseOfAGroupToWhatItFills)
{
  constexpr int D = TypeParam::D;
  const Mesh<D>& mesh = jittered_mesh<D>();
  const Index n = inner_node(mesh);
  const auto star = mesh.cells_of_node()[n];
  Real before = 0, after = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    // Cells hold both groups and are not full, one holds none; where a cell holds one group alone its share is given, and no fit is exact.
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<Real> number(0.1, 1);
    std::vector<Real> w;
    for (const Index c : star)
      for (std::size_t b = 0; b < groups; ++b)
        w.push_back(c == star[2] ? 0 : mesh.volume(c) * number(random));
    std::vector<Real> shares = w, of_cells = w;
    fit_shares(mesh, n, groups, std::span(shares));
    for (std::size_t c = 0; c < star.size(); ++c) {
      const Real of_cell = w[2 * c] + w[2 * c + 1];
      ASSERT_NEAR(shares[2 * c] + shares[2 * c + 1], of_cell > 0 ? 1 : 2, round_off);
      for (std::size_t b = 0; b < groups && of_cell > 0; ++b) {
        ASSERT_EQ(shares[2 * c + b] > 0, w[2 * c + b] > 0);
        of_cells[2 * c + b] /= of_cell;
      }
    }
    before += misfit(mesh, n, w, of_cells), after += misfit(mesh, n, w, shares);
  }
  EXPECT_GT(before, 0.01);
  EXPECT_LT(after, 0.1 * before);
}

TYPED_TEST(GroupGradientsIn, OfASingleGroupIsTheAveragedGradient)
{
  constexpr int D = TypeParam::D;
  const Mesh<D>& mesh = jittered_mesh<D>();
  const std::vector<Vec<D>> averaged = averaged_gradients(mesh);
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    std::vector<Real> shares;
    for (const Index c : mesh.cells_of_node()[n])
      shares.push_back(0.3 * mesh.volume(c));
    std::vector<Vec<D>> rows(mesh.ring_of_node()[n].size());
    fit_shares(mesh, n, 1, std::span(shares));
    group_gradients<D>(mesh, n, 1, shares, rows);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Vec<D>& of_all = averaged[static_cast<std::size_t>(mesh.ring_of_node().begin[static_cast<std::size_t>(n)]) + i];
      ASSERT_LE((rows[i] - of_all).norm(), round_off * (1 + of_all.norm())) << "node " << n;
    }
  }
}

TYPED_TEST(GroupGradientsIn, OnOneSideOfABoundaryOfCellsSeeThatSideOnly)
{
  constexpr int D = TypeParam::D;
  const Mesh<D>& mesh = jittered_mesh<D>();
  const Index n = inner_node(mesh);
  const auto star = mesh.cells_of_node()[n];
  const auto is_left = [&](Index c) { return c == star.front() || c == star.back(); };
  std::vector<Real> shares;
  for (const Index c : star)
    for (const bool left : {true, false})
      shares.push_back(is_left(c) == left ? mesh.volume(c) : 0);
  const auto ring = mesh.ring_of_node()[n];
  std::vector<Vec<D>> rows(groups * ring.size());
  fit_shares(mesh, n, groups, std::span(shares));
  group_gradients<D>(mesh, n, groups, shares, rows);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto has_it = [&](Index c) { return std::ranges::find(mesh.cell(c), ring[i]) != mesh.cell(c).end(); };
    if (!has_it(star.front()) && !has_it(star.back())) {
      ASSERT_EQ(rows[i], (Vec<D>::Zero().eval())) << "a node that the group on the left does not reach";
    }
  }
}

}  // namespace
}  // namespace talus::test::group_gradients_test
