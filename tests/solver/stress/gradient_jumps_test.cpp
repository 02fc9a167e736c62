// Jumps of gradients: none of linear displacements, forces that are their transpose, and modes that averaged gradients do not see.
#include "solver/stress/gradient_jumps.hpp"

#include <gtest/gtest.h>

#include "kernels/node_operators.hpp"
#include "mesh/generate/generate.hpp"

namespace talus::gradient_jumps_test {
namespace {

template <int D>
struct Filled {
  explicit Filled(MeshData<D> data) : mesh(std::move(data))
  {
    std::vector<Real> filled, stiffness;
    for (Index c = 0; c < mesh.n_cells(); ++c) {  // some are half full, some empty
      filled.push_back((c % 3) / 2.0 * mesh.volume(c));
      stiffness.push_back(3e5 * filled.back());
    }
    jumps = GradientJumps<D>(mesh, filled, stiffness);
  }
  std::vector<Vec<D>> displacements(const std::function<Vec<D>(Index)>& displacement) const
  {
    std::vector<Vec<D>> u;
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      u.push_back(displacement(n));
    return u;
  }
  Mesh<D> mesh;
  GradientJumps<D> jumps;
};

template <int D>
Filled<D> irregular()
{
  std::array<Index, D> cells;
  cells.fill(4);
  return Filled<D>(jittered(box<D>(Vec<D>::Zero(), Vec<D>::Ones(), cells), 0.2, 3));
}

template <int D>
void expect_none_for_linear_fields()
{
  Filled<D> filled = irregular<D>();
  const Mat<D> slope = Mat<D>::Random();
  filled.jumps.find(filled.mesh, filled.displacements([&](Index n) { return Vec<D>(slope * filled.mesh.node(n) + Vec<D>::Ones()); }));
  EXPECT_GT(filled.jumps.cells().size(), 0);
  for (const auto& one : filled.jumps.cells()) {
    EXPECT_LT(one.jump.norm(), 1e-12);
    EXPECT_LT((one.gradient - slope).norm(), 1e-12);
    EXPECT_NEAR(one.modulus, 3e5, 1e-6);
  }
}

template <int D>
void expect_forces_that_are_their_transpose()
{
  Filled<D> filled = irregular<D>();
  for (int k = 0; k < 20; ++k) {
    std::vector<Mat<D>> stress(to_size(filled.mesh.n_cells()));
    for (Mat<D>& one : stress)
      one.setRandom();
    const std::vector<Vec<D>> u = filled.displacements([](Index) { return Vec<D>(Vec<D>::Random()); });
    std::vector<Vec<D>> force(u.size(), Vec<D>::Zero());
    filled.jumps.find(filled.mesh, u);
    Real work = 0, of_forces = 0;
    for (const auto& one : filled.jumps.cells())
      work += stress[to_size(one.cell)].cwiseProduct(one.jump).sum();
    filled.jumps.add_forces(filled.mesh, stress, force);
    Vec<D> sum = Vec<D>::Zero();
    for (std::size_t n = 0; n < u.size(); ++n)
      of_forces += u[n].dot(force[n]), sum += force[n];
    EXPECT_NEAR(of_forces, -work, 1e-10 * std::abs(work));
    EXPECT_LT(sum.norm(), 1e-10);
  }
}

TEST(GradientJumps, LinearFieldsHaveNone)
{
  expect_none_for_linear_fields<2>();
  expect_none_for_linear_fields<3>();
}

TEST(GradientJumps, ForcesDoTheWorkOfTheStressAndCancel)
{
  expect_forces_that_are_their_transpose<2>();
  expect_forces_that_are_their_transpose<3>();
}

/// The modes for which they are there: displacements that change sign from one column of nodes to the next.
TEST(GradientJumps, AlternatingDisplacementsHaveThem)
{
  constexpr Index n = 8;
  Filled<2> filled(box<2>({0, 0}, {1, 1}, {n, n}));
  const auto sign = [&](Index node) { return std::lround(filled.mesh.node(node)[0] * n) % 2 == 0 ? 1.0 : -1.0; };
  const std::vector<Vec<2>> gradients = averaged_gradients(filled.mesh);  // in the order of the rings
  for (Index node = 0; node < filled.mesh.n_nodes(); ++node) {
    if (filled.mesh.on_boundary(node))
      continue;
    Vec<2> seen = Vec<2>::Zero();
    auto entry = to_size(filled.mesh.ring_of_node().begin[to_size(node)]);
    for (const Index v : filled.mesh.ring_of_node()[node])
      seen += sign(v) * gradients[entry++];
    EXPECT_LT(seen.norm(), 1e-12 * n);
  }
  filled.jumps.find(filled.mesh, filled.displacements([&](Index node) { return Vec<2>(sign(node), 0); }));
  Real mean = 0;
  for (const auto& one : filled.jumps.cells())
    mean += filled.mesh.volume(one.cell) * one.jump.squaredNorm();
  EXPECT_GT(mean, 0.5 * 4 * n * n);  // |grad u| = 2 n
}

}  // namespace
}  // namespace talus::gradient_jumps_test
