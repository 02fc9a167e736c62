// Smoothing moves interior nodes to the centres of their stars, keeps every shape and makes no bad cells.
#include "mesh/smooth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "core/parallel/threads.hpp"
#include "mesh/generate/generate.hpp"
#include "mesh/quality.hpp"

namespace talus::smooth_test {
namespace {

constexpr Index sweeps = 5;

template <int D>
MeshData<D> regular()
{
  if constexpr (D == 2)
    return box<2>({0, 0}, {2, 1}, {20, 10});
  else
    return box<3>({0, 0, 0}, {2, 1, 1}, {10, 5, 5});
}

template <int D>
MeshData<D> irregular(Real amount)
{
  return jittered(regular<D>(), amount, 5);
}

template <int D>
void expect_evener(Real amount, Real factor)
{
  const MeshData<D> given = irregular<D>(amount);
  const auto before = quality(Mesh<D>(given)), after = quality(Mesh<D>(smoothed(given, sweeps)));
  EXPECT_LT(after.offsets.median, before.offsets.median / factor);
  EXPECT_LT(after.offsets.most, before.offsets.most / factor);
  EXPECT_GE(after.smallest_altitude, before.smallest_altitude);
  EXPECT_GE(after.smallest_mean_ratio, std::min(before.smallest_mean_ratio, smoothed_mean_ratio));
  EXPECT_GT(after.average_mean_ratio, before.average_mean_ratio);
  EXPECT_NEAR(after.volume, before.volume, 1e-13 * before.volume);
}
TEST(Smoothed, TakesMostOfTheOffsetsFromPlaneMeshes) { expect_evener<2>(0.3, 5); }
TEST(Smoothed, TakesMostOfTheOffsetsFromSolidMeshes) { expect_evener<3>(0.3, 5); }

template <int D>
void expect_no_bad_cells_from_slivers()
{
  const MeshData<D> given = slivered(irregular<D>(0.2), 0.05, 4, 1);  // 3 degrees
  const auto before = quality(Mesh<D>(given)), after = quality(Mesh<D>(smoothed(given, sweeps)));
  EXPECT_GE(after.smallest_altitude, before.smallest_altitude);
  EXPECT_GE(after.smallest_mean_ratio, before.smallest_mean_ratio);
}
TEST(Smoothed, MakesNoPlaneSliverWorse) { expect_no_bad_cells_from_slivers<2>(); }
TEST(Smoothed, MakesNoSolidSliverWorse) { expect_no_bad_cells_from_slivers<3>(); }

template <int D>
void expect_regular_nodes_to_stay()
{
  const MeshData<D> given = regular<D>();
  const MeshData<D> made = smoothed(given, sweeps);
  for (std::size_t n = 0; n < given.nodes.size(); ++n)
    ASSERT_LT((made.nodes[n] - given.nodes[n]).norm(), 1e-14) << "node " << n;
}
TEST(Smoothed, LeavesRegularMeshesAlone)
{
  expect_regular_nodes_to_stay<2>();
  expect_regular_nodes_to_stay<3>();
}

TEST(Smoothed, NothingMovesWithoutSweeps)
{
  const MeshData<2> given = irregular<2>(0.3);
  EXPECT_EQ(smoothed(given, 0).nodes, given.nodes);
}

/// The left half is a cell group; one node, and one facet elsewhere, have names.
TEST(Smoothed, NodesOfBoundariesInterfacesAndNamedGroupsStay)
{
  MeshData<2> given = irregular<2>(0.3);
  for (Index c = 0; c < static_cast<Index>(given.cells.size()); ++c) {
    Simplex<2> s;
    for (std::size_t a = 0; a < 3; ++a)
      s[a] = regular<2>().nodes[static_cast<std::size_t>(given.cells[static_cast<std::size_t>(c)][a])];
    if (centroid<2>(s)[0] < 1)
      given.cell_sets["left"].push_back(c);
  }
  const Mesh<2> mesh(given);
  const auto inner = [&](const std::array<Index, 3>& cell) {
    return std::ranges::all_of(cell, [&](Index n) { return (given.nodes[static_cast<std::size_t>(n)] - Vec<2>(1.5, 0.5)).norm() < 0.3; });
  };
  const auto named = *std::ranges::find_if(given.cells, inner);
  given.node_sets["gauge"] = {named[0]};
  given.facet_sets["seam"] = {{named[1], named[2]}};
  const MeshData<2> made = smoothed(given, sweeps);
  std::size_t moved = 0;
  for (std::size_t n = 0; n < given.nodes.size(); ++n) {
    const Vec<2> x = regular<2>().nodes[n];
    const bool outer = x[0] < 0.01 || x[0] > 1.99 || x[1] < 0.01 || x[1] > 0.99, interface = std::abs(x[0] - 1) < 0.01;
    if (outer || interface || std::ranges::find(named, static_cast<Index>(n)) != named.end())
      EXPECT_EQ(made.nodes[n], given.nodes[n]) << "node " << n;
    else
      moved += made.nodes[n] != given.nodes[n] ? 1 : 0;
  }
  EXPECT_EQ(moved, 21U * 11 - 2 * (20 + 10) - 9 - 3) << "all others";
}

TEST(Smoothed, TheOrderOfTheCornersDoesNotMatter)
{
  const MeshData<3> given = irregular<3>(0.3);
  MeshData<3> turned = given;
  for (std::size_t c = 0; c < turned.cells.size(); c += 2)
    std::swap(turned.cells[c][0], turned.cells[c][1]);
  const MeshData<3> a = smoothed(given, sweeps), b = smoothed(turned, sweeps);
  for (std::size_t n = 0; n < a.nodes.size(); ++n)
    ASSERT_LT((a.nodes[n] - b.nodes[n]).norm(), 1e-12) << "node " << n;
}

TEST(Smoothed, ThreadsChangeNoBit)
{
  const int before = threads();
  set_threads(1);
  const auto one = smoothed(irregular<3>(0.3), sweeps).nodes;
  set_threads(3);
  EXPECT_EQ(smoothed(irregular<3>(0.3), sweeps).nodes, one);
  set_threads(before);
}

TEST(Smoothed, RefusesCellsThatMeshRefuses)
{
  MeshData<2> given = regular<2>();
  given.cells[3][1] = 100'000;
  EXPECT_THROW(smoothed(given, 1), std::invalid_argument);
}

/// A square of four cells about a node: the centre of its star is that of the square, wherever the node is.
TEST(StarOffsets, ArePartsOfTheMeanEdge)
{
  MeshData<2> data;
  data.nodes = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1.3, 0.9}};
  data.cells = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  const Mesh<2> mesh(data);
  const Vec<2> x = data.nodes[4];
  Real edge = 0;
  for (std::size_t n = 0; n < 4; ++n)
    edge += (data.nodes[n] - x).norm() / 4;
  const Real expected = std::hypot(0.3, 0.1) / edge;
  const StarOffsets<2> offsets = star_offsets(mesh);
  EXPECT_EQ(offsets.nodes, 1);
  EXPECT_NEAR(offsets.median, expected, 1e-15);
  EXPECT_NEAR(offsets.most, expected, 1e-15);
  EXPECT_NEAR(offsets.largest, expected, 1e-15);
  EXPECT_EQ(offsets.largest_place, x);
  EXPECT_EQ(to_string(offsets),
            "interior nodes: 0.221 h from the centre of their cells in the median, up to 0.221 h for 95 %, 0.221 h at (1.3, 0.9); h: mean "
            "edge\n");
  const MeshData<2> centred = smoothed(data, 1);
  EXPECT_LT((centred.nodes[4] - Vec<2>(1, 1)).norm(), 1e-15);
}

TEST(StarOffsets, AdviceIsGivenAboveTheLimitOnly)
{
  StarOffsets<2> offsets{.nodes = 9, .median = large_star_offset, .most = 0.5, .largest = 0.6};
  EXPECT_EQ(advice(offsets), "");
  offsets.median = 0.13;
  EXPECT_EQ(
      advice(offsets),
      "more than 0.12 h in the median: the kernel projected is less accurate on such meshes; mesh.smoothing: 5 makes them more even\n");
}

TEST(StarOffsets, MeshesWithoutInteriorNodesHaveNone)
{
  const StarOffsets<3> offsets = star_offsets(Mesh<3>(box<3>({0, 0, 0}, {1, 1, 1}, {1, 1, 1})));
  EXPECT_EQ(offsets.nodes, 0);
  EXPECT_EQ(to_string(offsets), "");
}

/// One node of a regular mesh is moved: it and its neighbours are fewer than 5 % of 19 * 9.
TEST(StarOffsets, FewNodesShowInTheLargestOnly)
{
  MeshData<2> data = regular<2>();
  const auto moved = std::ranges::find_if(data.nodes, [](const Vec<2>& x) { return (x - Vec<2>(0.5, 0.5)).norm() < 0.01; });
  *moved += Vec<2>(0.02, 0);
  const StarOffsets<2> offsets = star_offsets(Mesh<2>(data));
  EXPECT_EQ(offsets.nodes, 19 * 9);
  EXPECT_NEAR(offsets.median, 0, 1e-12);
  EXPECT_LT(offsets.most, 0.05);
  EXPECT_GT(offsets.largest, 0.15);
  EXPECT_EQ(offsets.largest_place, *moved);
}

}  // namespace
}  // namespace talus::smooth_test
