// Edges that show the shape of a mesh, counted by hand on boxes.
#include "mesh/geometry/outline.hpp"

#include <gtest/gtest.h>

#include "mesh/generate/generate.hpp"

namespace talus::outline_test {

namespace {

struct Plain {
  std::vector<Real> nodes;
  std::vector<Index> corners;
};

template <int D>
Plain plain(const Mesh<D>& mesh)
{
  std::vector<Real> nodes;
  for (const Vec<D>& x : mesh.nodes())
    for (int d = 0; d < 3; ++d)
      nodes.push_back(d < D ? x[std::min(d, D - 1)] : 0);
  std::vector<Index> corners;
  for (const auto& cell : mesh.cells())
    corners.insert(corners.end(), cell.begin(), cell.end());
  return {nodes, corners};
}

template <int D>
MeshEdges edges_of_box(const MeshData<D>& data)
{
  const Plain box = plain(Mesh<D>(data));
  return edges_of(D, box.nodes, box.corners);
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

template <int D>
void expect_sizes_of_its_nodes(const Mesh<D>& mesh)
{
  const Plain box = plain(mesh);
  Real sum = 0;
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    sum += mesh.node_size(n);
  EXPECT_NEAR(mean_node_size(D, box.nodes, box.corners), sum / mesh.n_nodes(), 1e-12);
}

TEST(Outline, MeanSizeOfTheNodesIsThatOfTheMesh)
{
  expect_sizes_of_its_nodes(Mesh<2>(box<2>({0, 0}, {3, 2}, {3, 2})));
  expect_sizes_of_its_nodes(Mesh<3>(box<3>({0, 0, 0}, {3, 2, 1}, {3, 2, 1})));
}

}  // namespace

}  // namespace talus::outline_test
