// Points are found in parts of a mesh as in the whole.
#include "tests/mesh/shared_mesh.hpp"

namespace talus::part_test {
namespace {

template <class M>
class LocationInPart : public ::testing::Test {};
using Dimensions = ::testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(LocationInPart, Dimensions);

TYPED_TEST(LocationInPart, PointsAreWhereTheyAreInTheWhole)
{
  constexpr int D = TypeParam::value;
  const Shared<D> shared;
  const Locator<D> locate_in_whole(shared.whole);
  std::mt19937_64 random(3);
  for (const Part<D>& part : shared.parts) {
    const Locator<D> locate(part.mesh);
    const auto distance = rings_from_own(part);
    const auto expect_same = [&](const Vec<D>& x) {
      const auto expected = locate_in_whole(shared.whole, x, none);
      ASSERT_TRUE(expected);
      for (const Index hint : {none, static_cast<Index>(random() % z(part.mesh.n_cells()))}) {
        const auto found = locate(part.mesh, x, hint);
        ASSERT_TRUE(found);
        EXPECT_EQ(part.subdomain.whole_cell(*found), *expected);
      }
    };
    for (Index c = 0; c < part.mesh.n_cells(); ++c) {
      const auto& cell = part.mesh.cell(c);
      if (std::none_of(cell.begin(), cell.end(), [&](Index n) { return distance[z(n)] == 0; }))
        continue;  // neither own nor in the first ring
      const Simplex<D> s = part.mesh.corners(c);
      expect_same(centroid<D>(s));
      for (int i = 0; i < 5; ++i) {  // on nodes, edges and facets and inside, as many shares are left
        std::array<Real, D + 1> share{};
        Real sum = 0;
        for (Real& w : share)
          sum += w = static_cast<Real>(random() % 3);
        if (sum == 0)
          continue;
        for (Real& w : share)
          w /= sum;
        expect_same(point<D>(s, share));
      }
    }
    int outside = 0;
    for (Index c = 0; c < shared.whole.n_cells(); ++c)
      if (part.subdomain.local_cell(c) == none)
        for (const Index hint : {none, static_cast<Index>(random() % z(part.mesh.n_cells()))}) {
          EXPECT_FALSE(locate(part.mesh, centroid<D>(shared.whole.corners(c)), hint));
          ++outside;
        }
    EXPECT_GT(outside, 0);
  }
}

TYPED_TEST(LocationInPart, NearestPointsOfTheBoundaryAreThoseOfTheWhole)
{
  constexpr int D = TypeParam::value;
  const Shared<D> shared;
  const Locator<D> locate_in_whole(shared.whole);
  for (const Part<D>& part : shared.parts) {
    const Locator<D> locate(part.mesh);
    int tried = 0;
    for (const Facet f : part.mesh.boundary_facets()) {
      if (!part.subdomain.owns_cell(f.cell))
        continue;
      const Vec<D> out = part.mesh.area_vector(f).normalized();
      for (const Index n : part.mesh.nodes_of(f))
        for (const Real share : {0.0, 0.2}) {
          const Vec<D> middle = centroid<D>(part.mesh.corners(f.cell));
          const Vec<D> on = (1 - share) * part.mesh.node(n) + share * (middle - (middle - part.mesh.node(n)).dot(out) * out);
          const Vec<D> x = on + 0.3 * part.mesh.altitude(f.cell) * out;
          const auto expected = locate_in_whole.nearest(shared.whole, x), found = locate.nearest(part.mesh, x);
          EXPECT_FALSE(locate(part.mesh, x, f.cell));
          EXPECT_EQ(found.x, expected.x);
          EXPECT_EQ(part.subdomain.whole_cell(found.cell), expected.cell);
          EXPECT_EQ(found.facet, (Facet{found.cell, expected.facet.local}));
          ++tried;
        }
    }
    EXPECT_GT(tried, 20);
  }
}

}  // namespace
}  // namespace talus::part_test
