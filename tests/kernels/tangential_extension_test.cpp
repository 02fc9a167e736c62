// Rows of the tangential extension.
#include "kernels/tangential_extension.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace talus::test::tangential_extension_test {
namespace {

template <int N>
struct Dimension {
  static constexpr int D = N;
};
template <class T>
class TangentialExtensionIn : public ::testing::Test {};
using Dimensions = ::testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(TangentialExtensionIn, Dimensions);

/// Sources below a node at the origin, filled by 0.3 to 1 times `scale`, and the node itself.
template <int D>
std::vector<ExtensionSource<D>> half_space(Real own_fill, Real scale = 1)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<Real> number(0, 1);
  std::vector<ExtensionSource<D>> sources{{Vec<D>::Zero(), own_fill}};
  for (int k = 0; k < 40; ++k) {
    Vec<D> arm;
    for (int d = 0; d < D; ++d)
      arm[d] = 6 * number(random) - 3;
    arm[D - 1] = -0.3 - std::abs(arm[D - 1]);
    sources.push_back({arm, scale * (0.3 + 0.7 * number(random))});
  }
  return sources;
}

template <int D, class Field>
Vec<D> extended(const ExtensionRow<D>& row, std::span<const ExtensionSource<D>> sources, Field&& field)
{
  const Vec<D> at_node = field(Vec<D>(Vec<D>::Zero()));
  Vec<D> u = (row.own - 1) * at_node;
  for (const ExtensionSource<D>& source : sources)
    u += row.coefficient(source) * field(source.arm);
  return at_node + row.tangential(u);
}

TYPED_TEST(TangentialExtensionIn, KeepsLinearFields)
{
  constexpr int D = TypeParam::D;
  const Mat<D> slope = Mat<D>::Random();
  for (const Real own : {0.0, 0.1, 0.3}) {
    const auto sources = half_space<D>(own);
    const auto row = extension_row<D>(own, 1.2, sources, sources.size(), Vec<D>::Ones());
    ASSERT_TRUE(row.extends());
    const Vec<D> u = extended<D>(row, sources, [&](const Vec<D>& x) { return Vec<D>(slope * x + Vec<D>::Ones()); });
    EXPECT_LT((u - Vec<D>::Ones()).norm(), 1e-12);
  }
}

TYPED_TEST(TangentialExtensionIn, ContinuesAlongTheSurfaceOnly)
{
  constexpr int D = TypeParam::D;
  const auto sources = half_space<D>(0);
  const auto row = extension_row<D>(0, 1, sources, sources.size(), 3 * Vec<D>::Unit(D - 1));
  // inside all move by 1, the node itself by 5
  const Vec<D> u = extended<D>(row, sources, [](const Vec<D>& x) { return Vec<D>((x.isZero(0) ? 5 : 1) * Vec<D>::Ones()); });
  EXPECT_NEAR(u[0], 1, 1e-12);
  EXPECT_NEAR(u[D - 1], 5, 1e-12);
}

TYPED_TEST(TangentialExtensionIn, LeavesNodesThatAreFilledOrHaveNoInside)
{
  constexpr int D = TypeParam::D;
  const Vec<D> up = Vec<D>::Unit(D - 1);
  const auto row = [&](Real own, const std::vector<ExtensionSource<D>>& sources, const Vec<D>& outwards) {
    return extension_row<D>(own, 1, sources, sources.size(), outwards);
  };
  EXPECT_FALSE(row(0.5, half_space<D>(0.5), up).extends());
  EXPECT_FALSE(row(0.1, half_space<D>(0.1, 0.02), up).extends()) << "next to nothing around";
  EXPECT_FALSE(row(0.1, half_space<D>(0.1), Vec<D>::Zero()).extends()) << "no surface";
  auto flat = half_space<D>(0.1);
  for (auto& source : flat)
    source.arm[D - 1] *= 0.02;
  EXPECT_FALSE(row(0.1, flat, up).extends()) << "a film";
  EXPECT_FALSE(row(0.1, {}, up).extends());
}

TEST(TangentialExtension, CountsFillingInLevels)
{
  EXPECT_EQ(extension_fill(0), 0);
  EXPECT_EQ(extension_fill(-1e-17), 0);
  EXPECT_EQ(extension_fill(0.9), 1);
  EXPECT_EQ(extension_fill(2), 1);
  EXPECT_NEAR(extension_fill(0.4), 0.4 / 0.875, 1.0 / 256);
  EXPECT_EQ(extension_fill(0.4), extension_fill(0.4004));
}

}  // namespace
}  // namespace talus::test::tangential_extension_test
