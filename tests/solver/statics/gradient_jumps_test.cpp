// Displacements that averaged gradients do not see have a stiffness, and linear ones have none.
#include "solver/statics/gradient_jumps.hpp"

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
  std::vector<Vec<D>> forces(const std::function<Vec<D>(Index)>& displacement)
  {
    std::vector<Vec<D>> u, force(to_size(mesh.n_nodes()), Vec<D>::Zero());
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      u.push_back(displacement(n));
    jumps.find_gradients(mesh, u);
    jumps.add_forces(mesh, std::vector<Real>(to_size(mesh.n_cells()), left), force);
    energy = 0;
    for (std::size_t n = 0; n < u.size(); ++n)
      energy -= u[n].dot(force[n]) / 2;
    return force;
  }
  Mesh<D> mesh;
  GradientJumps<D> jumps;
  Real energy = 0, left = 1;
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
  for (const Vec<D>& force : filled.forces([&](Index n) { return Vec<D>(slope * filled.mesh.node(n) + Vec<D>::Ones()); }))
    EXPECT_LT(force.norm(), 1e-10 * 3e5);
}

template <int D>
void expect_energy_and_no_net_force()
{
  Filled<D> filled = irregular<D>();
  for (int k = 0; k < 20; ++k) {
    Vec<D> sum = Vec<D>::Zero();
    for (const Vec<D>& force : filled.forces([](Index) { return Vec<D>(Vec<D>::Random()); }))
      sum += force;
    EXPECT_GT(filled.energy, 0);
    EXPECT_LT(sum.norm(), 1e-9 * 3e5);
  }
}

TEST(GradientJumps, LinearFieldsHaveNone)
{
  expect_none_for_linear_fields<2>();
  expect_none_for_linear_fields<3>();
}

TEST(GradientJumps, TheirStiffnessIsTheShareThatIsLeft)
{
  Filled<2> filled = irregular<2>();
  const auto bent = [&](Index n) { return Vec<2>(filled.mesh.node(n)[0] * filled.mesh.node(n)[1], 0); };
  filled.forces(bent);
  const Real whole = filled.energy;
  filled.left = 0.25;
  filled.forces(bent);
  EXPECT_GT(whole, 0);
  EXPECT_NEAR(filled.energy, whole / 4, 1e-12 * whole);
}

TEST(GradientJumps, OthersHaveEnergyAndForcesThatCancel)
{
  expect_energy_and_no_net_force<2>();
  expect_energy_and_no_net_force<3>();
}

/// The modes for which it is there: displacements that change sign from one column of nodes to the next.
TEST(GradientJumps, GiveAStiffnessToModesWithoutOne)
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
  filled.forces([&](Index node) { return Vec<2>(sign(node), 0); });
  EXPECT_GT(filled.energy, 0.1 * 3e5 * 4 * n * n);  // of mu |grad u|^2 / 2 over the square with |grad u| = 2 n: 2 mu n^2
}

}  // namespace
}  // namespace talus::gradient_jumps_test
