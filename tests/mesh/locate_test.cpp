// Point location against brute force, on regular, jittered, graded and sliver meshes, with ties, lost and outside points.
#include "mesh/locate.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "mesh/generate/generate.hpp"
#include "mesh/simplex.hpp"

namespace talus::locate_test {
namespace {

class Random {
 public:
  Real operator()() { return static_cast<Real>(bits_() >> 11) * 0x1p-53; }
  Index below(Index n) { return static_cast<Index>((*this)() * n); }
  template <int D>
  Vec<D> in(const Vec<D>& low, const Vec<D>& high)
  {
    Vec<D> x;
    for (int d = 0; d < D; ++d)
      x[d] = low[d] + (high[d] - low[d]) * (*this)();
    return x;
  }

 private:
  std::mt19937_64 bits_{11};
};

/// Lowest cell that holds x up to `tolerance` times its longest edge.
template <int D>
std::optional<Index> brute_force(const Mesh<D>& mesh, const Vec<D>& x, Real tolerance = location_tolerance)
{
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    const auto s = mesh.corners(c);
    const auto lambda = barycentric<D>(s, x), height = altitudes<D>(s);
    bool inside = true;
    for (int a = 0; a <= D; ++a)
      inside = inside && lambda[a] * height[a] >= -tolerance * longest_edge<D>(s);
    if (inside)
      return c;
  }
  return std::nullopt;
}

constexpr Real degree = 0.017453292519943295;

std::vector<Mesh<2>> plane_meshes()
{
  const auto start = box(Vec<2>(-1, 2), Vec<2>(1, 3), {16, 8}, Diagonals::alternating);
  std::vector<Mesh<2>> meshes;
  meshes.emplace_back(start);
  meshes.emplace_back(jittered(start, 0.4, 3, BoundaryNodes::slide));
  meshes.emplace_back(graded(start, 1e3));
  meshes.emplace_back(slivered(start, 0.01 * degree, 8, 3));
  return meshes;
}
std::vector<Mesh<3>> solid_meshes()
{
  const auto start = box<3>({-1, 2, 0}, {1, 3, 1}, {8, 4, 4});
  std::vector<Mesh<3>> meshes;
  meshes.emplace_back(start);
  meshes.emplace_back(jittered(start, 0.4, 3, BoundaryNodes::slide));
  meshes.emplace_back(graded(start, 1e3));
  meshes.emplace_back(slivered(start, 0.01 * degree, 3, 3));
  return meshes;
}

template <int D>
void expect_brute_force_answers(const Mesh<D>& mesh)
{
  const Locator<D> locate(mesh);
  Random random;
  const Vec<D> margin = 0.05 * (mesh.high() - mesh.low());  // some points fall outside
  int outside = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec<D> x = random.in<D>(mesh.low() - margin, mesh.high() + margin);
    const auto expected = brute_force(mesh, x);
    outside += expected ? 0 : 1;
    ASSERT_EQ(locate(mesh, x, none), expected);
    ASSERT_EQ(locate(mesh, x, random.below(mesh.n_cells())), expected);
  }
  EXPECT_GT(outside, 10);
  EXPECT_LT(outside, 500);
}

/// Points on nodes, edges and facets: the lowest of the cells around wins, from every hint.
template <int D>
void expect_lowest_cell_on_ties(const Mesh<D>& mesh)
{
  const Locator<D> locate(mesh);
  Random random;
  const auto expect = [&](const Vec<D>& x, Index c, Index lowest) {
    ASSERT_EQ(locate(mesh, x, none), lowest);
    ASSERT_EQ(locate(mesh, x, c), lowest);
    ASSERT_EQ(locate(mesh, x, random.below(mesh.n_cells())), lowest);
  };
  for (Index n = 0; n < mesh.n_nodes(); ++n)
    expect(mesh.node(n), mesh.cells_of_node()[n].back(), mesh.cells_of_node()[n].front());
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    const auto& cell = mesh.cell(c);
    const Real t = 0.2 + 0.6 * random();
    Index lowest = none;  // of the cells at the edge between the first two nodes
    for (const Index other : mesh.cells_of_node()[cell[0]])
      if (lowest == none && std::count(mesh.cell(other).begin(), mesh.cell(other).end(), cell[1]) > 0)
        lowest = other;
    expect(t * mesh.node(cell[0]) + (1 - t) * mesh.node(cell[1]), c, lowest);
    for (Index a = 0; a <= D; ++a) {
      Vec<D> middle = Vec<D>::Zero();
      for (const Index n : mesh.nodes_of({c, a}))
        middle += mesh.node(n) / D;
      const Index across = mesh.neighbours(c)[a];
      expect(middle, c, across == none ? c : std::min(c, across));
    }
  }
}

TEST(Locator, AnswersLikeBruteForceOnTriangles)
{
  for (const auto& mesh : plane_meshes())
    expect_brute_force_answers(mesh);
}

TEST(Locator, AnswersLikeBruteForceOnTetrahedra)
{
  for (const auto& mesh : solid_meshes())
    expect_brute_force_answers(mesh);
}

TEST(Locator, LowestCellWinsOnNodesEdgesAndFacetsOfTriangles)
{
  const auto meshes = plane_meshes();
  for (std::size_t i = 0; i < 3; ++i)  // in the flattest cells a middle is within the tolerance of more cells than its neighbours
    expect_lowest_cell_on_ties(meshes[i]);
}

TEST(Locator, LowestCellWinsOnNodesEdgesAndFacetsOfTetrahedra)
{
  const auto meshes = solid_meshes();
  for (std::size_t i = 0; i < 3; ++i)
    expect_lowest_cell_on_ties(meshes[i]);
}

TEST(Locator, AnswersDoNotDependOnTheHintInFlatCells)
{
  const Mesh<3> mesh = solid_meshes()[3];
  const Locator<3> locate(mesh);
  Random random;
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    const Vec<3> inside = centroid<3>(mesh.corners(c));
    const auto expected = locate(mesh, inside, none);
    EXPECT_EQ(expected, brute_force(mesh, inside));
    for (int i = 0; i < 20; ++i)
      ASSERT_EQ(locate(mesh, inside, random.below(mesh.n_cells())), expected);
  }
}

TEST(Locator, NothingOutsideBeyondRoundOff)
{
  const Mesh<2> mesh(box<2>({0, 0}, {1, 1}, {4, 4}));
  const Locator<2> locate(mesh);
  const Real h = 0.25 * std::sqrt(2.0);  // longest edge
  EXPECT_TRUE(locate(mesh, Vec<2>(1 + 0.5e-10 * h, 0.4), none));
  EXPECT_FALSE(locate(mesh, Vec<2>(1 + 2e-10 * h, 0.4), none));
  for (Index hint = none; hint < mesh.n_cells(); ++hint) {
    EXPECT_FALSE(locate(mesh, Vec<2>(1.5, 0.4), hint));
    EXPECT_FALSE(locate(mesh, Vec<2>(-1e300, 1e300), hint));
  }
}

TEST(Locator, NotAPlaceIsNowhere)
{
  const Mesh<3> mesh(box<3>({0, 0, 0}, {1, 1, 1}, {2, 2, 2}));
  const Locator<3> locate(mesh);
  for (const Real bad :
       {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity(), -std::numeric_limits<Real>::infinity()})
    for (int d = 0; d < 3; ++d)
      for (Index hint = none; hint < mesh.n_cells(); ++hint) {
        Vec<3> x(0.3, 0.4, 0.2);
        x[d] = bad;
        EXPECT_FALSE(locate(mesh, x, hint));
      }
}

TEST(Locator, PointsDeepInsideACellAreInNoOther)
{
  for (const auto& mesh : solid_meshes()) {
    const Locator<3> locate(mesh);
    Random random;
    int deep = 0;
    for (Index c = 0; c < mesh.n_cells(); ++c) {
      const auto is_deep = [&](const Vec<3>& x) {
        return std::ranges::all_of(mesh.barycentric(c, x), [&](Real share) { return share > locate.least_inside(mesh, c); });
      };
      EXPECT_FALSE(is_deep(mesh.node(mesh.cell(c)[1])));
      const auto s = mesh.corners(c);
      EXPECT_TRUE(is_deep(centroid<3>(s)));
      for (int i = 0; i < 10; ++i) {
        std::array<Real, 4> lambda{0, 1.2 * random() - 0.1, 0.6 * random() - 0.1, 0.4 * random() - 0.1};
        lambda[0] = 1 - lambda[1] - lambda[2] - lambda[3];
        const Vec<3> x = point<3>(s, lambda);
        if (!is_deep(x))
          continue;
        ++deep;
        EXPECT_EQ(locate(mesh, x, none), c);
      }
    }
    EXPECT_GT(deep, mesh.n_cells());  // of ten tries per cell
  }
}

/// A square with a slot in the middle, and a second square that does not touch it.
Mesh<2> slotted()
{
  MeshData<2> data = box<2>({0, 0}, {10, 1}, {10, 10});
  std::erase_if(data.cells, [&](const auto& cell) {
    const Real x = (data.nodes[cell[0]][0] + data.nodes[cell[1]][0] + data.nodes[cell[2]][0]) / 3;
    const Real y = (data.nodes[cell[0]][1] + data.nodes[cell[1]][1] + data.nodes[cell[2]][1]) / 3;
    return (x > 4 && x < 5 && y > 0.2) || (x > 7 && x < 8);
  });
  data.facet_sets.clear();
  data.cell_sets.clear();
  return Mesh<2>(data);
}

TEST(Locator, LostPointIsFoundAcrossHolesAndGaps)
{
  const Mesh<2> mesh = slotted();
  const Locator<2> locate(mesh);
  for (const Vec<2>& x : {Vec<2>(3.3, 0.87), Vec<2>(5.3, 0.87), Vec<2>(9.3, 0.87), Vec<2>(4.3, 0.11)}) {
    const auto expected = brute_force(mesh, x);
    ASSERT_TRUE(expected);
    for (Index hint = 0; hint < mesh.n_cells(); ++hint)
      EXPECT_EQ(locate(mesh, x, hint), expected);
  }
  for (Index hint = 0; hint < mesh.n_cells(); ++hint) {
    EXPECT_FALSE(locate(mesh, Vec<2>(4.5, 0.87), hint));
    EXPECT_FALSE(locate(mesh, Vec<2>(7.5, 0.5), hint));
  }
}

template <int D>
void expect_nearest_of_all_facets(const Mesh<D>& mesh)
{
  const Locator<D> locate(mesh);
  Random random;
  const Vec<D> margin = 2 * (mesh.high() - mesh.low());
  for (int i = 0; i < 300; ++i) {
    const Vec<D> x = random.in<D>(mesh.low() - margin, mesh.high() + margin);
    Real least = std::numeric_limits<Real>::infinity();
    for (const Facet f : mesh.boundary_facets())
      least = std::min(least, (closest_point(facet<D>(mesh.corners(f.cell), f.local), x) - x).norm());
    const auto nearest = locate.nearest(mesh, x);
    EXPECT_EQ((nearest.x - x).norm(), least);
    EXPECT_EQ(nearest.cell, nearest.facet.cell);
    EXPECT_EQ(mesh.neighbours(nearest.cell)[nearest.facet.local], none);
    EXPECT_TRUE(locate(mesh, nearest.x, nearest.cell));
  }
}

TEST(Locator, NearestPointIsThatOfAllBoundaryFacets)
{
  for (const auto& mesh : plane_meshes())
    expect_nearest_of_all_facets(mesh);
  for (const auto& mesh : solid_meshes())
    expect_nearest_of_all_facets(mesh);
  expect_nearest_of_all_facets(slotted());
}

TEST(Locator, NearestPointOfABoxIsTheProjection)
{
  const Mesh<3> mesh(box<3>({0, 0, 0}, {1, 1, 1}, {3, 3, 3}));
  const Locator<3> locate(mesh);
  Random random;
  for (int i = 0; i < 200; ++i) {
    Vec<3> x = random.in<3>(Vec<3>(-2, -2, -2), Vec<3>(3, 3, 3));
    x[i % 3] = i % 2 == 0 ? 2 : -1;
    EXPECT_LT((locate.nearest(mesh, x).x - x.cwiseMax(0).cwiseMin(1)).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace talus::locate_test
