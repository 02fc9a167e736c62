// What a rank holds of a mesh against the whole: the same cells, nodes, measures, boundary, groups and places.
#include "tests/mesh/shared_mesh.hpp"

namespace talus::part_test {
namespace {

template <class M>
class PartOf : public ::testing::Test {};
using Dimensions = ::testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(PartOf, Dimensions);

TYPED_TEST(PartOf, EveryBlockCellAndNodeHasOneOwner)
{
  constexpr int D = TypeParam::value;
  const Shared<D> shared;
  std::vector<int> block_owners(shared.ranks.size(), 0), node_owners(z(shared.whole.n_nodes()), 0);
  for (const Part<D>& part : shared.parts) {
    EXPECT_EQ(part.subdomain.whole_cells, shared.whole.n_cells());
    EXPECT_EQ(part.subdomain.whole_nodes, shared.whole.n_nodes());
    EXPECT_EQ(part.subdomain.rank_of_whole_block, shared.ranks);
    for (Index b = 0; b < static_cast<Index>(part.subdomain.block.size()); ++b) {
      EXPECT_EQ(part.subdomain.rank_of_block[z(b)], shared.ranks[z(part.subdomain.block[z(b)])]);
      block_owners[z(part.subdomain.block[z(b)])] += part.subdomain.owns_block(b) ? 1 : 0;
    }
    for (Index n = 0; n < part.mesh.n_nodes(); ++n) {
      const Index lowest = shared.whole.cells_of_node()[part.subdomain.node[z(n)]].front();
      EXPECT_EQ(part.subdomain.rank_of_node[z(n)], shared.ranks[z(lowest / block_cells)]);
      node_owners[z(part.subdomain.node[z(n)])] += part.subdomain.owns_node(n) ? 1 : 0;
    }
  }
  EXPECT_EQ(block_owners, std::vector<int>(shared.ranks.size(), 1));
  EXPECT_EQ(node_owners, std::vector<int>(z(shared.whole.n_nodes()), 1));
}

TYPED_TEST(PartOf, LocalNumbersAreInTheOrderOfTheWholeAndBlocksStayBlocks)
{
  constexpr int D = TypeParam::value;
  const Shared<D> shared;
  for (const Part<D>& part : shared.parts) {
    EXPECT_EQ(blocks_of(part.mesh.n_cells()), static_cast<Index>(part.subdomain.block.size()));
    Index before = none, held = 0;
    for (Index c = 0; c < part.mesh.n_cells(); ++c) {
      const Index whole = part.subdomain.whole_cell(c);
      EXPECT_LT(before, whole);
      EXPECT_EQ(whole / block_cells, part.subdomain.block[z(c / block_cells)]);
      EXPECT_EQ(part.subdomain.owns_cell(c), shared.ranks[z(whole / block_cells)] == part.subdomain.rank);
      EXPECT_THAT(whole_nodes(part, part.mesh.cell(c)), ElementsAreArray(shared.whole.cell(whole)));
      before = whole;
    }
    for (Index c = 0; c < shared.whole.n_cells(); ++c)
      if (const Index local = part.subdomain.local_cell(c); local != none) {
        EXPECT_EQ(part.subdomain.whole_cell(local), c);
        ++held;
      }
    EXPECT_EQ(held, part.mesh.n_cells());
    EXPECT_TRUE(std::is_sorted(part.subdomain.node.begin(), part.subdomain.node.end()));
    held = 0;
    for (Index n = 0; n < shared.whole.n_nodes(); ++n)
      if (const Index local = part.subdomain.local_node(n); local != none) {
        EXPECT_EQ(part.subdomain.node[z(local)], n);
        ++held;
      }
    EXPECT_EQ(held, part.mesh.n_nodes());
    EXPECT_LT(held, shared.whole.n_nodes()) << "this part has to leave something out, or the tests show little";
  }
}

TYPED_TEST(PartOf, MeasuresAreThoseOfTheWholeToTheLastBit)
{
  constexpr int D = TypeParam::value;
  const Shared<D> shared;
  for (const Part<D>& part : shared.parts) {
    EXPECT_EQ(part.mesh.low(), shared.whole.low());
    EXPECT_EQ(part.mesh.high(), shared.whole.high());
    EXPECT_EQ(part.mesh.largest_edge(), shared.whole.largest_edge());
    for (Index c = 0; c < part.mesh.n_cells(); ++c) {
      const Index whole = part.subdomain.whole_cell(c);
      EXPECT_EQ(part.mesh.volume(c), shared.whole.volume(whole));
      EXPECT_EQ(part.mesh.altitude(c), shared.whole.altitude(whole));
      EXPECT_EQ(part.mesh.gradients(c), shared.whole.gradients(whole));
    }
    for (Index n = 0; n < part.mesh.n_nodes(); ++n) {
      const Index whole = part.subdomain.node[z(n)];
      EXPECT_EQ(part.mesh.node(n), shared.whole.node(whole));
      EXPECT_EQ(part.mesh.node_size(n), shared.whole.node_size(whole));
      EXPECT_EQ(part.mesh.on_boundary(n), shared.whole.on_boundary(whole));
    }
  }
}

TYPED_TEST(PartOf, WhereTheMeshWasCutIsNoBoundary)
{
  constexpr int D = TypeParam::value;
  const Shared<D> shared;
  for (const Part<D>& part : shared.parts) {
    Index n_cut = 0, n_boundary = 0;
    for (Index c = 0; c < part.mesh.n_cells(); ++c) {
      const auto& across = shared.whole.neighbours(part.subdomain.whole_cell(c));
      for (Index a = 0; a <= D; ++a) {
        const Index held = across[z(a)] == none ? none : part.subdomain.local_cell(across[z(a)]);
        EXPECT_EQ(part.mesh.neighbours(c)[z(a)], held);
        n_boundary += across[z(a)] == none ? 1 : 0;
        n_cut += across[z(a)] != none && held == none ? 1 : 0;
      }
    }
    EXPECT_GT(n_cut, 0);
    std::vector<Facet> expected;
    for (const Facet f : shared.whole.boundary_facets())
      if (const Index c = part.subdomain.local_cell(f.cell); c != none)
        expected.push_back({c, f.local});
    EXPECT_EQ(static_cast<Index>(expected.size()), n_boundary);
    EXPECT_THAT(part.mesh.boundary_facets(), ElementsAreArray(expected));
  }
}

/// Distance of each node of the whole from the vertices of the cells of a rank, step by step through all cells.
template <int D>
std::vector<int> brute_force_rings(const Shared<D>& shared, int rank)
{
  std::vector<int> distance(z(shared.whole.n_nodes()), out_of_reach);
  for (Index c = 0; c < shared.whole.n_cells(); ++c)
    if (shared.ranks[z(c / block_cells)] == rank)
      for (const Index n : shared.whole.cell(c))
        distance[z(n)] = 0;
  for (int ring = 1; ring <= 5; ++ring)
    for (const auto& cell : shared.whole.cells())
      if (std::any_of(cell.begin(), cell.end(), [&](Index n) { return distance[z(n)] == ring - 1; }))
        for (const Index n : cell)
          distance[z(n)] = std::min(distance[z(n)], ring);
  return distance;
}

TYPED_TEST(PartOf, RingsAreDeepEnoughAndNoBlockIsHeldInVain)
{
  constexpr int D = TypeParam::value;
  const Shared<D> shared;
  for (const int rings : {0, 1, 2, 3}) {
    for (int rank = 0; rank < 3; ++rank) {
      const Part<D> part = cut<D>(shared.whole, shared.ranks, rank, rings);
      const auto expected = brute_force_rings(shared, rank), distance = rings_from_own(part);
      std::vector<std::uint8_t> wanted(shared.ranks.size(), 0);
      for (Index c = 0; c < shared.whole.n_cells(); ++c) {
        const auto& cell = shared.whole.cell(c);
        if (shared.ranks[z(c / block_cells)] == rank ||
            std::any_of(cell.begin(), cell.end(), [&](Index n) { return expected[z(n)] < rings; }))
          wanted[z(c / block_cells)] = 1;
      }
      for (Index b = 0; b < static_cast<Index>(wanted.size()); ++b)
        EXPECT_EQ(std::count(part.subdomain.block.begin(), part.subdomain.block.end(), b), wanted[z(b)]);
      for (Index n = 0; n < shared.whole.n_nodes(); ++n) {
        const Index local = part.subdomain.local_node(n);
        if (expected[z(n)] <= rings) {
          ASSERT_NE(local, none);
          EXPECT_EQ(distance[z(local)], expected[z(n)]);
        }
        if (local != none && expected[z(n)] <= 5) {
          EXPECT_GE(distance[z(local)], expected[z(n)]);
        }
        if (expected[z(n)] < rings) {
          EXPECT_THAT(whole_cells(part, part.mesh.cells_of_node()[local]), ElementsAreArray(shared.whole.cells_of_node()[n]));
          EXPECT_THAT(whole_nodes(part, part.mesh.ring_of_node()[local]), ElementsAreArray(shared.whole.ring_of_node()[n]));
        }
      }
    }
  }
}

TYPED_TEST(PartOf, SetsAreThoseOfTheWholeAsFarAsTheyAreHeld)
{
  constexpr int D = TypeParam::value;
  const Shared<D> shared;
  const Mesh<D>& whole = shared.whole;
  const auto members = [](const auto& held) {
    std::vector<Index> result;
    for (const Index i : held)
      if (i != none)
        result.push_back(i);
    return result;
  };
  for (const Part<D>& part : shared.parts) {
    const Mesh<D>& mesh = part.mesh;
    EXPECT_EQ(mesh.node_set_names(), whole.node_set_names());
    EXPECT_EQ(mesh.facet_set_names(), whole.facet_set_names());
    EXPECT_EQ(mesh.cell_set_names(), whole.cell_set_names());
    for (const auto& name : whole.node_set_names()) {
      std::vector<Index> expected = *whole.node_set(name);
      std::transform(expected.begin(), expected.end(), expected.begin(), [&](Index n) { return part.subdomain.local_node(n); });
      EXPECT_EQ(*mesh.node_set(name), members(expected)) << name;
    }
    for (const auto& name : whole.cell_set_names()) {
      std::vector<Index> expected = *whole.cell_set(name);
      std::transform(expected.begin(), expected.end(), expected.begin(), [&](Index c) { return part.subdomain.local_cell(c); });
      EXPECT_EQ(*mesh.cell_set(name), members(expected)) << name;
    }
    for (const auto& name : whole.facet_set_names()) {
      const auto nodes_of = [&](Facet f) {
        const auto nodes = whole.nodes_of(f);
        return std::set<Index>(nodes.begin(), nodes.end());
      };
      const std::vector<Facet> facets = *mesh.facet_set(name), of_all = *whole.facet_set(name);
      std::set<std::set<Index>> expected, seen;
      for (const Facet f : of_all) {
        const Index across = whole.neighbours(f.cell)[z(f.local)];
        if (part.subdomain.local_cell(f.cell) != none || (across != none && part.subdomain.local_cell(across) != none))
          expected.insert(nodes_of(f));
      }
      std::tuple<bool, Index, Index> before{false, none, none};
      for (const Facet f : facets) {
        const Facet of_whole{part.subdomain.whole_cell(f.cell), f.local};
        EXPECT_TRUE(seen.insert(nodes_of(of_whole)).second) << "twice in " << name;
        EXPECT_TRUE(mesh.neighbours(f.cell)[z(f.local)] == none || mesh.neighbours(f.cell)[z(f.local)] > f.cell);
        const std::tuple key(whole.neighbours(of_whole.cell)[z(f.local)] != none, f.cell, f.local);
        EXPECT_LT(before, key);
        before = key;
      }
      EXPECT_EQ(seen, expected) << name;
    }
  }
}

TYPED_TEST(PartOf, OneRankHoldsEverything)
{
  constexpr int D = TypeParam::value;
  const Shared<D> shared(1);
  const Mesh<D>& mesh = shared.parts[0].mesh;
  const Mesh<D>& whole = shared.whole;
  EXPECT_EQ(digest(mesh), digest(whole));
  EXPECT_THAT(mesh.boundary_facets(), ElementsAreArray(whole.boundary_facets()));
  EXPECT_EQ(mesh.cells_of_node().item, whole.cells_of_node().item);
  EXPECT_EQ(mesh.ring_of_node().item, whole.ring_of_node().item);
  for (Index c = 0; c < whole.n_cells(); ++c)
    EXPECT_EQ(mesh.neighbours(c), whole.neighbours(c));
  EXPECT_EQ(rings_from_own(shared.parts[0]), std::vector<int>(z(whole.n_nodes()), 0));
}

TYPED_TEST(PartOf, ARankWithoutBlocksHoldsNothing)
{
  constexpr int D = TypeParam::value;
  const Shared<D> shared(100);  // of 17 or 94 blocks
  const Part<D>& idle = shared.parts.back();
  EXPECT_EQ(std::count(shared.ranks.begin(), shared.ranks.end(), 99), 0);
  EXPECT_EQ(idle.mesh.n_cells(), 0);
  EXPECT_EQ(idle.mesh.n_nodes(), 0);
  EXPECT_EQ(idle.mesh.low(), shared.whole.low());
  EXPECT_EQ(idle.mesh.cells_of_node().size(), 0);
  EXPECT_EQ(idle.mesh.ring_of_node().size(), 0);
  EXPECT_TRUE(idle.mesh.boundary_facets().empty());
  EXPECT_EQ(idle.mesh.facet_set("x_min"), std::vector<Facet>());
  EXPECT_EQ(idle.mesh.node_set("x_min"), std::vector<Index>());
  EXPECT_EQ(idle.subdomain.local_cell(0), none);
  EXPECT_EQ(idle.subdomain.local_node(0), none);
  EXPECT_TRUE(rings_from_own(idle).empty());
  const Locator<D> locate(idle.mesh);
  EXPECT_FALSE(locate(idle.mesh, shared.whole.node(0), none));
  EXPECT_EQ((locate.nearest(idle.mesh, shared.whole.node(0)).x - shared.whole.node(0)).norm(), std::numeric_limits<Real>::infinity());
  const Vec<D> nowhere = Vec<D>::Constant(std::numeric_limits<Real>::quiet_NaN());
  EXPECT_FALSE(locate(idle.mesh, nowhere, none));
}

TYPED_TEST(PartOf, APartCanBeCutAgain)
{
  constexpr int D = TypeParam::value;
  const Shared<D> shared;
  const Part<D>& part = shared.parts[0];
  std::vector<Index> some, of_whole;
  for (Index c = 1; c < part.mesh.n_cells(); c += 3) {
    some.push_back(c);
    of_whole.push_back(part.subdomain.whole_cell(c));
  }
  const Mesh<D> twice(part.mesh, some), once(shared.whole, of_whole);
  EXPECT_EQ(digest(twice), digest(once));
  EXPECT_THAT(twice.boundary_facets(), ElementsAreArray(once.boundary_facets()));
}

TEST(Part, NonsenseIsRefused)
{
  const Mesh<2> mesh(rough_box<2>(4));
  EXPECT_THROW(Mesh<2>(mesh, std::vector<Index>{1, 1}), std::invalid_argument);
  EXPECT_THROW(Mesh<2>(mesh, std::vector<Index>{2, 1}), std::invalid_argument);
  EXPECT_THROW(Mesh<2>(mesh, std::vector<Index>{-1}), std::invalid_argument);
  EXPECT_THROW(Mesh<2>(mesh, std::vector<Index>{mesh.n_cells()}), std::invalid_argument);
  EXPECT_THROW(cut<2>(mesh, std::vector<int>{0, 0}, 0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace talus::part_test
