// The tables of a mesh and its quality are the same to the bit for any number of threads.
#include <gtest/gtest.h>

#include "core/parallel/threads.hpp"
#include "mesh/digest.hpp"
#include "mesh/generate/generate.hpp"
#include "mesh/quality.hpp"

namespace talus::mesh_threads_test {
namespace {

template <int D>
MeshData<D> data()
{
  if constexpr (D == 2)
    return jittered(box(Vec<2>(0, 0), Vec<2>(2, 1), {160, 120}, Diagonals::random), 0.3, 5, BoundaryNodes::slide);
  else
    return jittered(box<3>({0, 0, 0}, {2, 1, 1}, {24, 16, 16}), 0.3, 5, BoundaryNodes::slide);
}

template <int D>
void expect_same(const Mesh<D>& a, const Mesh<D>& b)
{
  EXPECT_EQ(digest(a), digest(b));  // nodes, cells and sets
  EXPECT_EQ(a.cells_of_node().begin, b.cells_of_node().begin);
  EXPECT_EQ(a.cells_of_node().item, b.cells_of_node().item);
  EXPECT_EQ(a.ring_of_node().begin, b.ring_of_node().begin);
  EXPECT_EQ(a.ring_of_node().item, b.ring_of_node().item);
  EXPECT_TRUE(std::ranges::equal(a.boundary_facets(), b.boundary_facets()));
  EXPECT_TRUE(std::ranges::equal(a.altitudes(), b.altitudes()));
  for (Index c = 0; c < a.n_cells(); ++c) {
    ASSERT_EQ(a.neighbours(c), b.neighbours(c)) << "cell " << c;
    ASSERT_EQ(a.volume(c), b.volume(c)) << "cell " << c;
    ASSERT_TRUE(a.gradients(c) == b.gradients(c)) << "cell " << c;
  }
  for (Index n = 0; n < a.n_nodes(); ++n)
    ASSERT_EQ(a.node_size(n), b.node_size(n)) << "node " << n;
  EXPECT_EQ(a.largest_edge(), b.largest_edge());
  EXPECT_EQ(to_string(quality(a)), to_string(quality(b)));
  EXPECT_EQ(quality(a).average_mean_ratio, quality(b).average_mean_ratio);
}

template <int D>
void expect_same_for_any_number_of_threads()
{
  const int before = threads();
  set_threads(1);
  const Mesh<D> of_one(data<D>());
  for (const int n : {2, 3, 7}) {
    SCOPED_TRACE(n);
    set_threads(n);
    expect_same(of_one, Mesh<D>(data<D>()));
  }
  set_threads(before);
}

TEST(MeshThreads, ChangeNoBitOfPlaneMeshes) { expect_same_for_any_number_of_threads<2>(); }
TEST(MeshThreads, ChangeNoBitOfSolidMeshes) { expect_same_for_any_number_of_threads<3>(); }

template <int D>
std::string refusal(const MeshData<D>& data)
{
  try {
    const Mesh<D> mesh(data);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "none";
}

/// With several threads a later cell may be looked at before an earlier one.
TEST(MeshThreads, TheFirstOfSeveralBadCellsIsNamed)
{
  const int before = threads();
  MeshData<3> bad = data<3>();
  const auto last = static_cast<Index>(bad.cells.size()) - 1;
  for (const Index c : {last / 3, last / 2, last})
    bad.cells[static_cast<std::size_t>(c)][0] = bad.cells[static_cast<std::size_t>(c)][1];
  for (const int n : {1, 2, 5}) {
    set_threads(n);
    EXPECT_TRUE(refusal(bad).starts_with("cell " + std::to_string(last / 3) + " at ")) << refusal(bad);
  }
  set_threads(before);
}

}  // namespace
}  // namespace talus::mesh_threads_test
