// Edges that show the shape of a mesh, counted by hand on boxes.
#include "mesh/outline.hpp"

#include <gtest/gtest.h>

#include "mesh/generate.hpp"

namespace talus::outline_test {

namespace {

template <int D>
MeshEdges edges_of_box(const MeshData<D>& data)
{
  const Mesh<D> mesh(data);
  std::vector<Real> nodes;
  for (const Vec<D>& x : mesh.nodes())
    for (int d = 0; d < 3; ++d)
      nodes.push_back(d < D ? x[std::min(d, D - 1)] : 0);
  std::vector<Index> corners;
  for (const auto& cell : mesh.cells())
    corners.insert(corners.end(), cell.begin(), cell.end());
  return edges_of(D, nodes, corners);
}

TEST(Outline, OfTrianglesItIsTheBoundary)
{
  const MeshEdges edges = edges_of_box(box<2>({0, 0}, {3, 2}, {3, 2}));
  EXPECT_EQ(edges.outline.size(), 2u * (3 + 2));
  EXPECT_EQ(edges.all.size(), 12u + 12 - 1) << "Euler: nodes and cells less one";
}

TEST(Outline, OfTetrahedraItIsWhereTheBoundaryIsBent)
{
  const MeshEdges edges = edges_of_box(box<3>({0, 0, 0}, {3, 2, 1}, {3, 2, 1}));
  EXPECT_EQ(edges.outline.size(), 4u * (3 + 2 + 1)) << "the twelve edges of the box, nothing inside its sides";
  EXPECT_EQ(edges.all.size(), 3u * 44 / 2) << "three to each of 44 facets, each shared by two";
}

}  // namespace

}  // namespace talus::outline_test
