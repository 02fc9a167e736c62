// Tables, small tensors, compressed rows, and sums whose bits do not depend on the number of threads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "core/parallel/threads.hpp"
#include "core/tensor.hpp"
#include "core/time_table.hpp"

namespace talus::numbers_test {
namespace {

TEST(Table, IsLinearBetweenPointsAndConstantOutside)
{
  const Table table{{{1, 10}, {2, 20}, {4, 0}}};
  EXPECT_EQ(table(-5), 10);
  EXPECT_EQ(table(1), 10);
  EXPECT_EQ(table(1.5), 15);
  EXPECT_EQ(table(2), 20);
  EXPECT_EQ(table(3), 10);
  EXPECT_EQ(table(4), 0);
  EXPECT_EQ(table(100), 0);
}

TEST(Table, WithoutPointsIsOne) { EXPECT_EQ(Table{}(17), 1); }
TEST(Table, WithOnePointIsConstant)
{
  const Table table{{{3, 8}}};
  EXPECT_EQ(table(0), 8);
  EXPECT_EQ(table(3), 8);
  EXPECT_EQ(table(9), 8);
}

TEST(Tensor, PackingIsUndoneByUnpacking)
{
  Mat3 a;
  a << 1, 4, 6, 4, 2, 5, 6, 5, 3;
  EXPECT_THAT(pack(a), ::testing::ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_EQ(unpack(pack(a)), a);
}

TEST(Tensor, PartsAddUpToTheWhole)
{
  Mat3 a;
  a << 1, 2, 3, 4, 5, 6, 7, 8, 10;
  EXPECT_EQ(sym(a) + skew(a), a);
  EXPECT_EQ(skew(a), -skew(a).transpose());
  EXPECT_NEAR(dev(a).trace(), 0, 1e-15 * 16);  // trace 16
}

TEST(Tensor, MisesStressOfTensionAndShear)
{
  Mat3 tension = Mat3::Zero(), shear = Mat3::Zero();
  tension(1, 1) = -7;
  shear(0, 2) = shear(2, 0) = 7;
  EXPECT_DOUBLE_EQ(von_mises(tension), 7);
  EXPECT_DOUBLE_EQ(von_mises(shear), 7 * std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(second_invariant(shear), 49);
  EXPECT_DOUBLE_EQ(von_mises(Mat3(5 * Mat3::Identity())), 0);
}

TEST(Tensor, PlaneTensorsAreEmbeddedWithZerosOutOfPlane)
{
  Mat<2> a;
  a << 1, 2, 3, 4;
  const Mat3 b = embed(a);
  EXPECT_EQ((b.topLeftCorner<2, 2>()), a);
  EXPECT_EQ(b.squaredNorm(), 30);
}

TEST(Tensor, LameConstantsGiveBackYoungsModulus)
{
  const auto [lambda, mu] = lame(210e9, 0.3);
  EXPECT_NEAR(mu * (3 * lambda + 2 * mu) / (lambda + mu), 210e9, 1e-14 * 210e9);
  EXPECT_NEAR(lambda / (2 * (lambda + mu)), 0.3, 1e-15);
}

TEST(Csr, RowsMayBeEmpty)
{
  const Csr rows{{0, 2, 2, 3}, {7, 8, 9}};
  EXPECT_EQ(rows.size(), 3);
  EXPECT_THAT(rows[0], ::testing::ElementsAre(7, 8));
  EXPECT_TRUE(rows[1].empty());
  EXPECT_THAT(rows[2], ::testing::ElementsAre(9));
  EXPECT_EQ(Csr{}.size(), 0);
}

/// Numbers of very unequal size: adding them in another order gives other bits.
std::vector<Real> awkward_numbers(Index n)
{
  std::mt19937_64 random(2);
  std::vector<Real> numbers(static_cast<std::size_t>(n));
  for (Real& x : numbers)
    x = std::ldexp(static_cast<Real>(random() >> 11) - 0x1p52, static_cast<int>(random() % 60) - 80);
  return numbers;
}

class Threads : public ::testing::Test {
 protected:
  ~Threads() override { set_threads(before_); }
  int before_ = threads();
};

TEST_F(Threads, SumHasTheSameBitsForOneTwoThreeAndFour)
{
  const Index n = 10 * sum_block + 17;
  const auto numbers = awkward_numbers(n);
  const auto sum = [&](int count) {
    set_threads(count);
    return parallel_sum<Real>(n, [&](Index i) { return numbers[i]; });
  };
  const Real one = sum(1);
  Real backwards = 0;
  for (Index i = n; i-- > 0;)
    backwards += numbers[i];
  EXPECT_NE(one, backwards);  // the numbers do tell orders apart
  for (const int count : {2, 3, 4}) {
    const Real other = sum(count);
    EXPECT_EQ(std::memcmp(&one, &other, sizeof one), 0) << count;
  }
}

TEST_F(Threads, SumOfWholeNumbersIsExactAcrossBlockEnds)
{
  set_threads(3);
  for (const Index n : {0, 1, sum_block - 1, sum_block, sum_block + 1, 3 * sum_block})
    EXPECT_EQ((parallel_sum<std::int64_t>(n, [](Index i) { return std::int64_t{i}; })), std::int64_t{n} * (n - 1) / 2);
}

TEST_F(Threads, EveryItemIsVisitedOnce)
{
  for (const int count : {1, 2, 4}) {
    set_threads(count);
    std::vector<int> even(1000, 0), uneven(1000, 0);
    parallel_for(1000, [&](Index i) { ++even[i]; });
    parallel_for_uneven(1000, [&](Index i) { ++uneven[i]; });
    EXPECT_THAT(even, ::testing::Each(1));
    EXPECT_THAT(uneven, ::testing::Each(1));
  }
}

TEST_F(Threads, MinimumStopsAtTheStart)
{
  set_threads(2);
  const auto f = [](Index i) { return std::abs(i - 700) + 3.0; };
  EXPECT_EQ(parallel_min(1000, 1e9, f), 3);
  EXPECT_EQ(parallel_min(1000, 1, f), 1);
  EXPECT_EQ(parallel_min(0, 5, f), 5);
}

}  // namespace
}  // namespace talus::numbers_test
