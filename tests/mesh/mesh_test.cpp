// Renumbering, connectivity, measures and named sets of Mesh, on boxes whose numbers are known.
#include "mesh/mesh.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <set>

#include "mesh/digest.hpp"
#include "mesh/generate/generate.hpp"
#include "mesh/simplex.hpp"

namespace talus::mesh_test {
namespace {

using ::testing::ElementsAre;

MeshData<2> plane(Index n)
{
  return jittered(box(Vec<2>(0, 0), Vec<2>(2, 1), {2 * n, n}, Diagonals::random), 0.3, 5, BoundaryNodes::slide);
}
MeshData<3> solid(Index n) { return jittered(box<3>({0, 0, 0}, {2, 1, 1}, {2 * n, n, n}), 0.3, 5, BoundaryNodes::slide); }

/// The same mesh with cells and nodes in random order and every other cell turned over.
template <int D>
MeshData<D> scrambled(const MeshData<D>& data)
{
  std::mt19937_64 random(3);
  const auto permutation = [&](std::size_t n) {
    std::vector<Index> p(n);
    std::iota(p.begin(), p.end(), 0);
    std::shuffle(p.begin(), p.end(), random);
    return p;
  };
  const auto cell_at = permutation(data.cells.size()), node_at = permutation(data.nodes.size());
  MeshData<D> result = data;
  for (std::size_t n = 0; n < node_at.size(); ++n)
    result.nodes[node_at[n]] = data.nodes[n];
  for (std::size_t c = 0; c < cell_at.size(); ++c) {
    auto& cell = result.cells[cell_at[c]];
    cell = data.cells[c];
    for (Index& n : cell)
      n = node_at[n];
    if (c % 2 == 1)
      std::swap(cell[0], cell[1]);
  }
  for (auto& [name, facets] : result.facet_sets)
    for (auto& facet : facets)
      for (Index& n : facet)
        n = node_at[n];
  for (auto& [name, cells] : result.cell_sets)
    for (Index& c : cells)
      c = cell_at[c];
  return result;
}

template <class M>
class MeshOf : public ::testing::Test {};
template <int N>
struct Dimension {
  static constexpr int value = N;
};
using Dimensions = ::testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(MeshOf, Dimensions);

template <int D>
MeshData<D> sample()
{
  if constexpr (D == 2)
    return plane(6);
  else
    return solid(3);
}

TEST(MeshDigest, NoticesTheLastBit)
{
  const MeshData<2> data = plane(3);
  const auto before = digest(Mesh<2>(data));
  EXPECT_EQ(digest(Mesh<2>(data)), before);
  auto moved = data;
  moved.nodes[4][1] = std::nextafter(moved.nodes[4][1], 9);
  EXPECT_NE(digest(Mesh<2>(moved)), before);
  EXPECT_NE(digest(Mesh<2>(plane(4))), before);
}

TYPED_TEST(MeshOf, DigestNoticesGroups)
{
  constexpr int D = TypeParam::value;
  const MeshData<D> data = sample<D>();
  std::set<std::uint64_t> seen{digest(Mesh<D>(data))};
  EXPECT_EQ(digest(Mesh<D>(data)), *seen.begin());
  const auto is_another = [&](auto&& change) {
    MeshData<D> changed = data;
    change(changed);
    return seen.insert(digest(Mesh<D>(std::move(changed)))).second;
  };
  EXPECT_TRUE(is_another([](auto& d) { d.facet_sets["x_nim"] = d.facet_sets.at("x_min"), d.facet_sets.erase("x_min"); })) << "another name";
  EXPECT_TRUE(is_another([](auto& d) { std::swap(d.facet_sets.at("x_min"), d.facet_sets.at("x_max")); })) << "names change places";
  EXPECT_TRUE(is_another([](auto& d) { d.facet_sets.at("x_min").pop_back(); })) << "one facet less";
  EXPECT_TRUE(is_another([](auto& d) { d.facet_sets.erase("x_min"); }));
  EXPECT_TRUE(is_another([](auto& d) { d.cell_sets["part"] = {0, 1}; }));
  EXPECT_TRUE(is_another([](auto& d) { d.cell_sets["part"] = {0, 2}; }));
  EXPECT_TRUE(is_another([](auto& d) { d.node_sets["part"] = {0}; }));
  EXPECT_TRUE(is_another([](auto& d) { d.node_sets["part"] = {1}; }));
  EXPECT_TRUE(is_another([](auto& d) { d.node_sets["trap"] = {1}; }));
  EXPECT_FALSE(is_another([](auto& d) { std::reverse(d.cell_sets.at("all").begin(), d.cell_sets.at("all").end()); }))
      << "a group has no order";
}

TYPED_TEST(MeshOf, VolumesArePositiveAndSumToTheBox)
{
  constexpr int D = TypeParam::value;
  const Mesh<D> mesh(scrambled(sample<D>()));
  Real sum = 0;
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    EXPECT_GT(mesh.volume(c), 0);
    sum += mesh.volume(c);
  }
  EXPECT_NEAR(sum, 2, 1e-13 * 2);  // round-off of a few hundred terms
}

TYPED_TEST(MeshOf, NeighboursAreSymmetricAndShareAFacet)
{
  constexpr int D = TypeParam::value;
  const Mesh<D> mesh(scrambled(sample<D>()));
  Index interior = 0, boundary = 0;
  for (Index c = 0; c < mesh.n_cells(); ++c)
    for (Index a = 0; a <= D; ++a) {
      const Index other = mesh.neighbours(c)[a];
      if (other == none) {
        ++boundary;
        continue;
      }
      ++interior;
      const auto& back = mesh.neighbours(other);
      EXPECT_EQ(std::count(back.begin(), back.end(), c), 1);
      for (const Index n : mesh.nodes_of({c, a}))
        EXPECT_EQ(std::count(mesh.cell(other).begin(), mesh.cell(other).end(), n), 1);
    }
  EXPECT_EQ(boundary, D == 2 ? 2 * (12 + 6) : 2 * 2 * (18 + 18 + 9));
  EXPECT_EQ(interior + boundary, mesh.n_cells() * (D + 1));
}

TYPED_TEST(MeshOf, BoundaryIsClosedAndFacesOutwards)
{
  constexpr int D = TypeParam::value;
  const Mesh<D> mesh(sample<D>());
  Vec<D> sum = Vec<D>::Zero();
  Real flux = 0;
  for (const Facet f : mesh.boundary_facets()) {
    Vec<D> middle = Vec<D>::Zero();
    for (const Index n : mesh.nodes_of(f)) {
      EXPECT_TRUE(mesh.on_boundary(n));
      middle += mesh.node(n) / D;
    }
    sum += mesh.area_vector(f);
    flux += middle.dot(mesh.area_vector(f));
    EXPECT_GT(mesh.area_vector(f).dot(middle - centroid<D>(mesh.corners(f.cell))), 0);
  }
  EXPECT_LT(sum.norm(), 1e-13);               // of an area of order ten
  EXPECT_NEAR(flux, 2.0 * D, 1e-12 * 2 * D);  // the flux of x through the boundary is D times the volume
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    const Vec<D>& x = mesh.node(n);
    EXPECT_EQ(mesh.on_boundary(n), (x.array() == mesh.low().array()).any() || (x.array() == mesh.high().array()).any());
  }
}

TYPED_TEST(MeshOf, RingsAndCellsOfNodesAreThoseOfBruteForce)
{
  constexpr int D = TypeParam::value;
  const Mesh<D> mesh(scrambled(sample<D>()));
  for (Index n = 0; n < mesh.n_nodes(); ++n) {
    std::vector<Index> cells, ring;
    for (Index c = 0; c < mesh.n_cells(); ++c)
      if (std::count(mesh.cell(c).begin(), mesh.cell(c).end(), n) > 0) {
        cells.push_back(c);
        ring.insert(ring.end(), mesh.cell(c).begin(), mesh.cell(c).end());
      }
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    EXPECT_THAT(mesh.cells_of_node()[n], ::testing::ElementsAreArray(cells));
    EXPECT_THAT(mesh.ring_of_node()[n], ::testing::ElementsAreArray(ring));
    Real sum = 0;
    for (const Index m : ring)
      sum += (mesh.node(m) - mesh.node(n)).norm();
    EXPECT_NEAR(mesh.node_size(n), sum / static_cast<Real>(ring.size() - 1), 1e-14);
  }
}

TYPED_TEST(MeshOf, GradientsAndBarycentricCoordinatesReproduceLinearFields)
{
  constexpr int D = TypeParam::value;
  const Mesh<D> mesh(sample<D>());
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    const auto g = mesh.gradients(c);
    const auto lambda = mesh.barycentric(c, centroid<D>(mesh.corners(c)));
    Mat<D> identity = Mat<D>::Zero();
    for (int a = 0; a <= D; ++a) {
      identity += mesh.node(mesh.cell(c)[a]) * g[a].transpose();
      EXPECT_NEAR(lambda[a], 1.0 / (D + 1), 1e-13);
      EXPECT_LE(mesh.altitude(c) * g[a].norm(), 1 + 1e-12);
    }
    EXPECT_LT((identity - Mat<D>::Identity()).norm(), 1e-12);  // coordinate / altitude is about 1e2
  }
}

TYPED_TEST(MeshOf, SetsSurviveRenumbering)
{
  constexpr int D = TypeParam::value;
  const Mesh<D> mesh(scrambled(sample<D>()));
  const auto floor = mesh.facet_set("y_min");
  ASSERT_TRUE(floor.has_value());
  EXPECT_EQ(floor->size(), D == 2 ? 12u : 2u * 18u);
  Real area = 0;
  for (const Facet f : *floor) {
    EXPECT_EQ(mesh.neighbours(f.cell)[f.local], none);
    area -= mesh.area_vector(f)[1];
  }
  EXPECT_NEAR(area, 2, 1e-13);
  std::vector<Index> expected;
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    if (mesh.node(n)[1] == 0)
      expected.push_back(n);
  EXPECT_EQ(mesh.node_set("y_min"), expected);
  EXPECT_EQ(mesh.cell_set("all")->size(), mesh.cells().size());
  EXPECT_EQ(mesh.node_set("all")->size(), mesh.nodes().size());
  EXPECT_FALSE(mesh.node_set("y_mni").has_value());
  EXPECT_FALSE(mesh.facet_set("all").has_value());
  EXPECT_FALSE(mesh.cell_set("y_min").has_value());
}

TYPED_TEST(MeshOf, RangesOfCellsAreCompact)
{
  constexpr int D = TypeParam::value;
  constexpr Index block = D == 2 ? 32 : 48;  // a cube of 16 (2-D) or 8 bricks (3-D) at best
  const Mesh<D> mesh([] {
    if constexpr (D == 2)
      return box<2>({0, 0}, {32, 32}, {32, 32});
    else
      return box<3>({0, 0, 0}, {16, 16, 16}, {16, 16, 16});
  }());
  Real mean = 0;
  for (Index first = 0; first < mesh.n_cells(); first += block) {
    Vec<D> low = centroid<D>(mesh.corners(first)), high = low;
    for (Index c = first; c < first + block; ++c) {
      low = low.cwiseMin(centroid<D>(mesh.corners(c)));
      high = high.cwiseMax(centroid<D>(mesh.corners(c)));
    }
    mean += (high - low).maxCoeff() * block / mesh.n_cells();
  }
  EXPECT_LT(mean, D == 2 ? 6 : 4);  // 1.5 to 2 times the side of the ideal cube; a row of the box would be 16
}

TYPED_TEST(MeshOf, NodesAreNumberedByFirstUse)
{
  constexpr int D = TypeParam::value;
  const Mesh<D> mesh(scrambled(sample<D>()));
  Index known = 0;
  for (const auto& cell : mesh.cells()) {
    const Index highest = *std::max_element(cell.begin(), cell.end());
    EXPECT_LE(highest, known + D);
    known = std::max(known, highest + 1);
  }
  EXPECT_EQ(known, mesh.n_nodes());
}

TEST(Mesh, UnusedNodesAreDropped)
{
  MeshData<2> data = box<2>({0, 0}, {1, 1}, {1, 1});
  data.nodes.insert(data.nodes.begin(), Vec<2>(50, 50));
  for (auto& cell : data.cells)
    for (Index& n : cell)
      ++n;
  data.facet_sets.clear();
  data.node_sets["corner"] = {0, 1, 1};
  const Mesh<2> mesh(data);
  EXPECT_EQ(mesh.n_nodes(), 4);
  EXPECT_EQ(mesh.high(), Vec<2>(1, 1));
  ASSERT_EQ(mesh.node_set("corner")->size(), 1u);
  EXPECT_EQ(mesh.node(mesh.node_set("corner")->front()), Vec<2>(0, 0));
}

TEST(Mesh, InteriorFacetsOfASetComeLastAndOnce)
{
  MeshData<2> data = box<2>({0, 0}, {1, 1}, {1, 1});  // nodes 0 1 / 2 3, diagonal 0-3
  data.facet_sets["both"] = {{3, 0}, {0, 1}, {0, 3}};
  const Mesh<2> mesh(data);
  const auto facets = *mesh.facet_set("both");
  ASSERT_EQ(facets.size(), 2u);
  EXPECT_EQ(mesh.neighbours(facets[0].cell)[facets[0].local], none);
  EXPECT_EQ(facets[1].cell, 0);
  EXPECT_EQ(mesh.neighbours(0)[facets[1].local], 1);
}

TEST(Mesh, NamesOfSetsAreSortedAndUnique)
{
  MeshData<2> data = box<2>({0, 0}, {1, 1}, {1, 1});
  data.node_sets["y_min"] = {3};
  const Mesh<2> mesh(data);
  EXPECT_THAT(mesh.node_set_names(), ElementsAre("all", "x_max", "x_min", "y_max", "y_min"));
  EXPECT_THAT(mesh.cell_set_names(), ElementsAre("all"));
  EXPECT_EQ(mesh.node_set("y_min")->size(), 3u);  // the two of the side and the one of the node set
}

}  // namespace
}  // namespace talus::mesh_test
