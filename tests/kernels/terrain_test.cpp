// The projected kernel on meshes whose boundary is curved and creased, as ground and slip surfaces are.
#include <gtest/gtest.h>

#include <algorithm>

#include "kernels/projected.hpp"
#include "tests/kernels/terrains.hpp"

namespace talus::test::terrain_test {
namespace {

/// Nodes that have no weights but their own; every row is checked: not negative, sum one, linear fields kept inside and where a node is treated as a corner.
std::size_t nodes_as_corners(const Mesh<3>& mesh)
{
  constexpr Real round_off = 1e-12;
  const Projected<3> kernel(mesh);
  const auto corners = kernel.nodes_as_corners();
  EXPECT_TRUE(std::is_sorted(corners.begin(), corners.end()));
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    Real sum = 0, least = 1;
    Vec<3> centre = Vec<3>::Zero();
    kernel.node_operators().for_each_in_row(n, [&](Index v, Real S, const Vec<3>&) {
      sum += S, least = std::min(least, S);
      centre += S * (mesh.node(v) - mesh.node(n));
    });
    EXPECT_NEAR(sum, 1, round_off) << "node " << n;
    EXPECT_GE(least, 0) << "node " << n;
    const bool is_corner = std::binary_search(corners.begin(), corners.end(), n);
    const bool keeps_linear_fields = is_corner || !mesh.on_boundary(n);
    EXPECT_TRUE(!keeps_linear_fields || centre.norm() <= round_off * mesh.node_size(n)) << "node " << n;
  }
  return corners.size();
}

struct Drawn {
  std::uint64_t seed;
  Real size;
};

class TerrainWhereANodeHasNoWeights : public ::testing::TestWithParam<Drawn> {};

TEST_P(TerrainWhereANodeHasNoWeights, IsTakenAndTheNodeIsACorner)
{
  const auto [seed, size] = GetParam();
  const Mesh<3> mesh(mesh_of(random_terrain(seed), size, seed));
  const std::size_t corners = nodes_as_corners(mesh);
  EXPECT_GT(corners, 0);
  EXPECT_LT(corners, static_cast<std::size_t>(mesh.n_nodes()) / 20);
}

INSTANTIATE_TEST_SUITE_P(OfFew, TerrainWhereANodeHasNoWeights,
                         ::testing::Values(Drawn{1, 15}, Drawn{7, 10}, Drawn{11, 15}, Drawn{30, 12}, Drawn{45, 10}),
                         [](const auto& of) { return "Seed" + std::to_string(of.param.seed); });

TEST(Terrains, FiftyAtFiveSizesAreTakenNightly)
{
  std::size_t corners = 0, meshes_with_some = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed)
    for (const Real size : {20, 15, 12, 10, 8}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", size " + std::to_string(size));
      const std::size_t here = nodes_as_corners(Mesh<3>(mesh_of(random_terrain(seed), size, seed)));
      corners += here, meshes_with_some += here > 0 ? 1 : 0;
    }
  RecordProperty("nodes_as_corners", static_cast<int>(corners));
  EXPECT_GE(meshes_with_some, 50) << "otherwise these terrains try nothing";
}

}  // namespace
}  // namespace talus::test::terrain_test
