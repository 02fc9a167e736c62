// Generated boxes: counts, sides, and that each way of spoiling them does what it says.
#include "mesh/generate/generate.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "mesh/quality.hpp"

namespace talus::generate_test {
namespace {

constexpr Real degree = 0.017453292519943295;

TEST(Box, CountsOfCellsNodesAndSides)
{
  const Mesh<2> plane(box<2>({0, 0}, {3, 2}, {3, 2}));
  EXPECT_EQ(plane.n_cells(), 12);
  EXPECT_EQ(plane.n_nodes(), 12);
  EXPECT_EQ(plane.facet_set("x_max")->size(), 2u);
  EXPECT_EQ(plane.facet_set("y_max")->size(), 3u);
  const Mesh<3> solid(box<3>({0, 0, 0}, {3, 2, 1}, {3, 2, 1}));
  EXPECT_EQ(solid.n_cells(), 36);
  EXPECT_EQ(solid.n_nodes(), 24);
  EXPECT_EQ(solid.facet_set("z_min")->size(), 12u);
  EXPECT_EQ(solid.facet_set("x_min")->size(), 4u);
  EXPECT_EQ(solid.boundary_facets().size(), 2u * 2 * (6 + 3 + 2));
}

TEST(Box, SidesLieWhereTheirNamesSay)
{
  const Vec<3> low(-1, 0.1, 5), high(2, 0.7, 5.3);
  const Mesh<3> mesh(box<3>(low, high, {3, 7, 2}));
  for (int d = 0; d < 3; ++d)
    for (const bool top : {false, true}) {
      const std::string name = std::string(1, "xyz"[d]) + (top ? "_max" : "_min");
      const auto side = mesh.facet_set(name);
      ASSERT_TRUE(side.has_value());
      Real area = 0;
      for (const Facet f : *side) {
        area += mesh.area_vector(f)[d];
        for (const Index n : mesh.nodes_of(f))
          EXPECT_EQ(mesh.node(n)[d], top ? high[d] : low[d]);  // to the bit
      }
      const Vec<3> size = high - low;
      EXPECT_NEAR(area, (top ? 1 : -1) * size.prod() / size[d], 1e-14 * size.prod() / size[d] * 100);
    }
}

TEST(Box, DiagonalsAreCutAsAsked)
{
  const auto rising = [](Diagonals diagonals) {
    const Mesh<2> mesh(box(Vec<2>(0, 0), Vec<2>(8, 8), {8, 8}, diagonals));
    int count = 0;
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      for (const Index m : mesh.ring_of_node()[n])
        count += (mesh.node(m) - mesh.node(n)) == Vec<2>(1, 1) ? 1 : 0;
    return count;
  };
  EXPECT_EQ(rising(Diagonals::rising), 64);
  EXPECT_EQ(rising(Diagonals::falling), 0);
  EXPECT_EQ(rising(Diagonals::alternating), 32);
  EXPECT_GT(rising(Diagonals::random), 16);
  EXPECT_LT(rising(Diagonals::random), 48);
}

TEST(Box, RefusesEmptyExtentsAndCounts)
{
  EXPECT_THROW(box<2>({0, 0}, {0, 1}, {1, 1}), std::invalid_argument);
  EXPECT_THROW(box<3>({0, 0, 0}, {1, 1, 1}, {1, 0, 1}), std::invalid_argument);
  EXPECT_THROW(box<3>({0, 0, 0}, {1, 1, 1}, {2000, 2000, 2000}), std::invalid_argument);
}

TEST(Jittered, SameSeedSameMeshAndOtherSeedOtherMesh)
{
  const auto start = box<3>({0, 0, 0}, {1, 1, 1}, {4, 4, 4});
  EXPECT_EQ(jittered(start, 0.2, 7).nodes, jittered(start, 0.2, 7).nodes);
  EXPECT_NE(jittered(start, 0.2, 7).nodes, jittered(start, 0.2, 8).nodes);
}

TEST(Jittered, FirstNumbersAreThoseOfTheGeneratorOnEveryMachine)
{
  // mt19937_64 with its default seed gives 9981545732273789042 as the 10000th number (C++ standard, [rand.predef]).
  std::mt19937_64 bits;
  bits.discard(9999);
  EXPECT_EQ(bits(), 9981545732273789042u);
  std::mt19937_64 random(1);
  const auto start = box<2>({0, 0}, {2, 2}, {2, 2});  // node 4 in the middle, edges of length one
  const auto moved = jittered(start, 0.1, 1);
  random.discard(2 * 4);
  const Real first = static_cast<Real>(random() >> 11) * 0x1p-53;
  EXPECT_EQ(moved.nodes[4][0], 1 + 0.1 * (2 * first - 1));
}

TEST(Jittered, MovesInteriorNodesByAboutTheAmountAndKeepsTheBoundary)
{
  const auto start = box<3>({0, 0, 0}, {1, 1, 1}, {5, 5, 5});
  const auto stay = jittered(start, 0.2, 7), slide = jittered(start, 0.2, 7, BoundaryNodes::slide);
  const auto on_side = [](const Vec<3>& x) { return static_cast<int>((x.array() == 0).count() + (x.array() == 1).count()); };
  int moved_inside = 0, moved_on_sides = 0;
  for (std::size_t n = 0; n < start.nodes.size(); ++n) {
    const Vec<3>& x = start.nodes[n];
    EXPECT_LE((stay.nodes[n] - x).cwiseAbs().maxCoeff(), 0.2 * 0.2 * (1 + 1e-14));
    if (on_side(x) == 0) {
      moved_inside += (stay.nodes[n] - x).norm() > 0.01 * 0.2 ? 1 : 0;
    } else {
      EXPECT_EQ(stay.nodes[n], x);
      EXPECT_EQ(on_side(slide.nodes[n]), on_side(x));
      moved_on_sides += slide.nodes[n] != x ? 1 : 0;
    }
  }
  EXPECT_GT(moved_inside, 60);                 // of 64
  EXPECT_EQ(moved_on_sides, 6 * 16 + 12 * 4);  // all on faces and edges, no corner
}

TEST(Jittered, CellsStayPositiveForAnyAmount)
{
  for (const Real amount : {0.3, 1.0, 10.0}) {
    const auto start = box<3>({0, 0, 0}, {1, 1, 1}, {4, 4, 4});
    const auto data = jittered(start, amount, 2, BoundaryNodes::slide);
    for (const auto& cell : start.cells) {
      Simplex<3> before, after;
      for (int a = 0; a < 4; ++a) {
        before[a] = start.nodes[cell[a]];
        after[a] = data.nodes[cell[a]];
      }
      EXPECT_GT(signed_volume<3>(after) * signed_volume<3>(before), 0);
    }
    EXPECT_NEAR(quality(Mesh<3>(data)).volume, 1, 1e-13);  // a cell turned over would count twice
  }
}

TEST(Graded, SpacingGrowsByTheRatio)
{
  const Index n = 50;
  const auto data = graded(box<2>({1, 0}, {3, 1}, {n, 1}), 8);
  Real previous = 0, growth = 0;
  for (Index i = 0; i < n; ++i) {
    const Real width = data.nodes[i + 1][0] - data.nodes[i][0];
    if (i > 0) {
      growth = width / previous;
      EXPECT_NEAR(growth, std::pow(8.0, 1.0 / n), 1e-10);  // geometric; differences of numbers of order one over 50
    }
    previous = width;
  }
  EXPECT_EQ(data.nodes[0][0], 1);
  EXPECT_NEAR(data.nodes[n][0], 3, 1e-14);
  EXPECT_EQ(graded(box<2>({1, 0}, {3, 1}, {n, 1}), 1).nodes, (box<2>({1, 0}, {3, 1}, {n, 1}).nodes));
  EXPECT_THROW(graded(data, 0), std::invalid_argument);
}

TEST(Slivered, SmallestAngleIsTheOneAskedFor)
{
  for (const Real angle : {5 * degree, 0.1 * degree, 1e-5}) {
    const Mesh<2> plane(slivered(box<2>({0, 0}, {1, 1}, {8, 8}), angle, 4, 3));
    const Mesh<3> solid(slivered(box<3>({0, 0, 0}, {1, 1, 1}, {6, 6, 6}), angle, 3, 3));
    EXPECT_NEAR(quality(plane).smallest_angle, angle, 1e-9 * angle);
    EXPECT_NEAR(quality(solid).smallest_angle, angle, 1e-9 * angle);
    EXPECT_NEAR(quality(plane).volume, 1, 1e-13);
    EXPECT_NEAR(quality(solid).volume, 1, 1e-13);
    int flat = 0;
    for (Index c = 0; c < solid.n_cells(); ++c)
      flat += smallest_angle<3>(solid.corners(c)) < 1.001 * angle ? 1 : 0;
    EXPECT_GE(flat, 3);  // one at each place at least
  }
}

TEST(Slivered, SaysWhenThereIsNoRoom)
{
  EXPECT_THROW(slivered(box<2>({0, 0}, {1, 1}, {2, 2}), 0.01, 2, 1), std::invalid_argument);
  EXPECT_THROW(slivered(box<2>({0, 0}, {1, 1}, {8, 8}), 0.6, 1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace talus::generate_test
