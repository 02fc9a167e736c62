// Numbers of several particles that compute like one, and rows of numbers turned into them and back.
#include "core/lanes.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "core/tensor.hpp"

namespace talus {
namespace {

const Lanes some = Pack{0.25, -1, 4, 1e-300};

TEST(Lanes, EveryLaneComputesAsANumberDoes)
{
  const Lanes other = Pack{3, 0.5, -2, 7};
  for (int i = 0; i < pack_size; ++i) {
    EXPECT_EQ((some + other)[i], some[i] + other[i]);
    EXPECT_EQ((some - 2)[i], some[i] - 2);
    EXPECT_EQ((some * other)[i], some[i] * other[i]);
    EXPECT_EQ((1 / other)[i], 1 / other[i]);
    EXPECT_EQ((-some)[i], -some[i]);
    EXPECT_EQ(abs(some)[i], std::abs(some[i]));
    EXPECT_EQ(max(some, other)[i], std::max(some[i], other[i]));
    EXPECT_EQ(min(some, other)[i], std::min(some[i], other[i]));
    EXPECT_EQ(sqrt(abs(some))[i], std::sqrt(std::abs(some[i])));
    EXPECT_EQ((some < other)[i], some[i] < other[i]);
    EXPECT_EQ(where(some >= other, some, 9)[i], some[i] >= other[i] ? some[i] : 9);
  }
  EXPECT_EQ(sum(some.of), (0.25 - 1) + (4 + 1e-300));
}

TEST(Lanes, LogarithmAndExponentialAreWithinTwoUnitsOfTheLastPlace)
{
  constexpr Real two_units = 2 * std::numeric_limits<Real>::epsilon();
  for (const Real x : {1e-300, 1e-8, 0.3, 0.999999, 1.0, 1.000001, 17.0, 1e200}) {
    const Lanes of_log = log(Lanes(Pack{x, 2 * x, x, x})), of_exp = exp(Lanes(Pack{-x, x, 0, std::log(x)}));
    EXPECT_NEAR(of_log[0], std::log(x), two_units * std::abs(std::log(x)));
    EXPECT_NEAR(of_log[1], std::log(2 * x), two_units * std::abs(std::log(2 * x)));
    if (x < 100) {
      EXPECT_NEAR(of_exp[0], std::exp(-x), two_units * std::exp(-x));
      EXPECT_NEAR(of_exp[1], std::exp(x), two_units * std::exp(x));
    }
    EXPECT_EQ(of_exp[2], 1);
  }
  const Lanes odd = log(Lanes(Pack{0, -1, std::numeric_limits<Real>::infinity(), std::nan("")}));
  EXPECT_EQ(odd[0], -std::numeric_limits<Real>::infinity());
  EXPECT_TRUE(std::isnan(odd[1]));
  EXPECT_EQ(odd[2], std::numeric_limits<Real>::infinity());
  EXPECT_TRUE(std::isnan(odd[3]));
}

TEST(Lanes, AskAboutAllLanesAtOnce)
{
  EXPECT_TRUE(somewhere(some > 3));
  EXPECT_FALSE(everywhere(some > 3));
  EXPECT_FALSE(somewhere(some > 5));
  EXPECT_TRUE(everywhere(some < 5));
  EXPECT_FALSE(somewhere(Lanes(std::nan("")) < 5));
  EXPECT_TRUE(everywhere(!(Lanes(std::nan("")) < 5)));
}

TEST(Lanes, AreNumbersOfTensors)
{
  const Mat3 a{{1, 2, 3}, {0, 4, -1}, {5, 1, 2}}, b{{0.5, 0, 1}, {1, 1, 0}, {-2, 3, 1}};
  const Mat3Of<Lanes> product = a.cast<Lanes>() * b.cast<Lanes>();
  EXPECT_EQ(lane_of(product, 2), Mat3(a * b));
  EXPECT_EQ(product.determinant()[1], Mat3(a * b).determinant());
  EXPECT_EQ(lane_of(unpack(pack(Mat3Of<Lanes>(product + product.transpose()))), 0), Mat3(a * b + (a * b).transpose()));
}

template <int n>
void rows_there_and_back()
{
  Real from[pack_size][n], to[pack_size][n]{};
  std::iota(&from[0][0], &from[0][0] + pack_size * n, 1.0);
  Pack columns[n];
  load_rows<n>({from[0], from[1], from[2], from[3]}, columns);
  for (int k = 0; k < n; ++k)
    for (int lane = 0; lane < pack_size; ++lane)
      ASSERT_EQ(columns[k][lane], from[lane][k]);
  store_rows<n>(columns, {to[0], to[1], to[2], to[3]}, 3);
  for (int k = 0; k < n; ++k) {
    for (int lane = 0; lane < 3; ++lane)
      ASSERT_EQ(to[lane][k], from[lane][k]);
    ASSERT_EQ(to[3][k], 0) << "a row beyond the count was written";
  }
}

TEST(Lanes, RowsBecomeLanesAndLanesRows)
{
  rows_there_and_back<2>();
  rows_there_and_back<3>();
  rows_there_and_back<4>();
  rows_there_and_back<6>();
  rows_there_and_back<9>();
}

}  // namespace
}  // namespace talus
