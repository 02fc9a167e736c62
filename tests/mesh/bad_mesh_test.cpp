// Every message of a mesh that is refused: which cell or node, and where.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "mesh/generate/generate.hpp"
#include "mesh/mesh.hpp"

namespace talus::bad_mesh_test {
namespace {

template <int D>
std::string message(MeshData<D> data)
{
  try {
    const Mesh<D> mesh(std::move(data));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

/// Two triangles of the unit square: cells 0 1 3 and 0 3 2.
MeshData<2> square() { return box<2>({0, 0}, {1, 1}, {1, 1}); }
MeshData<3> cube() { return box<3>({0, 0, 0}, {1, 1, 1}, {1, 1, 1}); }

TEST(BadMesh, TheGoodOnesAreAccepted)
{
  EXPECT_EQ(message(square()), "accepted");
  EXPECT_EQ(message(cube()), "accepted");
}

TEST(BadMesh, NoCells)
{
  EXPECT_EQ(message(MeshData<2>{}), "the mesh has no triangles");
  EXPECT_EQ(message(MeshData<3>{}), "the mesh has no tetrahedra");
}

TEST(BadMesh, CoordinateIsNotFinite)
{
  auto data = cube();
  data.nodes[3][1] = std::numeric_limits<Real>::quiet_NaN();
  EXPECT_EQ(message(data), "node 3 at (1, nan, 0) has a coordinate that is not a finite number");
  data.nodes[3][1] = -std::numeric_limits<Real>::infinity();
  EXPECT_EQ(message(data), "node 3 at (1, -inf, 0) has a coordinate that is not a finite number");
}

TEST(BadMesh, NodeNumberOutOfRange)
{
  auto data = square();
  data.cells[1][2] = 4;
  EXPECT_EQ(message(data), "cell 1 refers to node 4, but there are 4 nodes, counted from 0");
  data.cells[1][2] = -1;
  EXPECT_EQ(message(data), "cell 1 refers to node -1, but there are 4 nodes, counted from 0");
}

TEST(BadMesh, NodeTwiceInACell)
{
  auto data = square();
  data.cells[1] = {0, 3, 3};
  EXPECT_EQ(message(data), "cell 1 at (1, 1) has node 3 twice");
}

TEST(BadMesh, FlatCell)
{
  auto data = square();
  data.nodes[1] = Vec<2>(0.5, 0.5 - 1e-12);
  EXPECT_EQ(message(data), "cell 0 at (0.5, 0.5) is flat: its area is 5e-13 m^2 with a longest edge of 1.41 m");
  auto solid = cube();
  solid.nodes[7] = solid.nodes[0];
  EXPECT_THAT(message(solid), ::testing::StartsWith("cell 0 at (0.5, 0.25, 0) is flat: its volume is 0 m^3"));
}

TEST(BadMesh, FlatnessDoesNotDependOnTheUnit)
{
  auto data = cube();
  for (auto& x : data.nodes)
    x *= 1e-6;
  EXPECT_EQ(message(data), "accepted");
}

TEST(BadMesh, SameCellTwice)
{
  auto data = square();
  data.cells.push_back({3, 0, 1});
  EXPECT_EQ(message(data), "cells 0 and 2 at (0.666667, 0.333333) are the same cell twice");
  MeshData<3> alone;
  alone.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  alone.cells = {{0, 1, 2, 3}, {0, 1, 2, 3}};
  EXPECT_EQ(message(alone), "cells 0 and 1 at (0.25, 0.25, 0.25) are the same cell twice");
}

TEST(BadMesh, FacetOfThreeCells)
{
  auto data = square();
  data.nodes.emplace_back(2, 0.5);
  data.cells.push_back({0, 3, 4});
  EXPECT_EQ(message(data), "the facet with nodes 0 and 3 at (0.5, 0.5) belongs to more than two cells: 0, 1 and 2");
}

TEST(BadMesh, CellsOnTheSameSideOfTheirFacet)
{
  MeshData<2> plane;
  plane.nodes = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  plane.cells = {{0, 1, 2}, {0, 1, 3}};
  EXPECT_EQ(message(plane), "cells 0 and 1 overlap: they lie on the same side of their common facet with nodes 0 and 1 at (0.5, 0)");
  MeshData<3> solid;
  solid.nodes = {{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 1}, {1, 1, 2}};
  solid.cells = {{0, 1, 2, 3}, {1, 2, 0, 4}};
  EXPECT_EQ(message(solid), "cells 0 and 1 overlap: they lie on the same side of their common facet with nodes 0, 1 and 2 at (1, 1, 0)");
}

TEST(BadMesh, GroupsThatPointNowhere)
{
  auto data = square();
  data.node_sets["pin"] = {0, 9};
  EXPECT_EQ(message(data), "node set \"pin\" refers to node 9, but there are 4, counted from 0");
  data = square();
  data.cell_sets["clay"] = {-2};
  EXPECT_EQ(message(data), "cell set \"clay\" refers to cell -2, but there are 2, counted from 0");
  data = square();
  data.facet_sets["wall"] = {{0, 7}};
  EXPECT_EQ(message(data), "facet set \"wall\" refers to node 7, but there are 4, counted from 0");
  data = square();
  data.facet_sets["wall"] = {{1, 2}};
  EXPECT_EQ(message(data), "facet set \"wall\": nodes 1 and 2, the first at (1, 0), are not a facet of any cell");
  data = square();
  data.nodes.emplace_back(5, 5);
  data.node_sets["centre"] = {4};
  EXPECT_EQ(message(data), "node set \"centre\": none of its 1 nodes belongs to a cell");
}

}  // namespace
}  // namespace talus::bad_mesh_test
