// Numbers of several particles: functions as exact as those of one number, choices, lanes that mind their own business, rows and lanes.
#include "core/simd.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "core/tensor.hpp"

namespace talus::lanes_test {
namespace {

/// Units of the last place between f of lanes and its exact value, the worst of random arguments sign * 10^[low, high].
template <class F, class Exact>
Real worst_error(F&& f, Exact&& exact, Real low, Real high, bool negative)
{
  std::mt19937 bits(1);
  std::uniform_real_distribution<Real> power(low, high);
  Real worst = 0;
  for (int n = 0; n < 20000; ++n) {
    const SimdReal x = in_each_lane([&](int) { return (negative ? -1 : 1) * std::pow(10, power(bits)); });
    const SimdReal y = f(x);
    for (int i = 0; i < pack_size; ++i) {
      const auto right = static_cast<Real>(exact(static_cast<long double>(x[i])));
      const Real unit = std::nextafter(std::abs(right), HUGE_VAL) - std::abs(right);
      worst = std::max(worst, std::abs(y[i] - right) / unit);
    }
  }
  return worst;
}

TEST(SimdReal, LogarithmAndExponentialKeepTheLastDigits)
{
  const auto log_of = [](const SimdReal& x) { return log(x); };
  const auto exp_of = [](const SimdReal& x) { return exp(x); };
  EXPECT_LE(worst_error(
                log_of, [](long double x) { return std::log(x); }, -300, 300, false),
            2);
  for (const bool negative : {false, true})
    EXPECT_LE(worst_error(
                  exp_of, [](long double x) { return std::exp(x); }, -10, 2.8, negative),
              2);
}

TEST(SimdReal, DifferencesFromOneKeepTheDigitsOfSmallNumbers)
{
  const auto log_of = [](const SimdReal& x) { return log1p(x); };
  const auto exp_of = [](const SimdReal& x) { return expm1(x); };
  const auto exact_log = [](long double x) { return std::log1p(x); };
  const auto exact_exp = [](long double x) { return std::expm1(x); };
  for (const bool negative : {false, true}) {
    EXPECT_LE(worst_error(log_of, exact_log, -300, -1.001, negative), 3);
    EXPECT_LE(worst_error(exp_of, exact_exp, -300, -1.001, negative), 3);
    EXPECT_LE(worst_error(log_of, exact_log, -20, negative ? -0.001 : 300, negative), 5);
    EXPECT_LE(worst_error(exp_of, exact_exp, -20, 2.8, negative), 5);
  }
}

TEST(SimdReal, PowersKeepAllButTheLastDigits)
{
  for (const Real n : {-7.0, -0.3, 0.26, 1.03, 6.0}) {
    const auto of = [&](const SimdReal& x) { return pow(x, n); };
    const auto exact = [&](long double x) { return std::pow(x, static_cast<long double>(n)); };
    EXPECT_LE(worst_error(of, exact, -6, 1, false), 4 + 2 * std::abs(n) * 6 * std::log(10)) << n;
  }
  EXPECT_EQ(pow(SimdReal(0), 0.3)[1], 0);
}

TEST(SimdReal, OddNumbersStayInTheirLane)
{
  const Real nan = std::nan("");
  const SimdReal x = Pack{nan, -2, HUGE_VAL, 0.5};
  for (const auto& y : {log(x), log1p(x)}) {
    EXPECT_TRUE(std::isnan(y[0]));
    EXPECT_TRUE(std::isnan(y[1]));
    EXPECT_EQ(y[2], HUGE_VAL);
    EXPECT_TRUE(std::isfinite(y[3]));
  }
  for (const auto& y : {exp(x), expm1(x)}) {
    EXPECT_TRUE(std::isnan(y[0]));
    EXPECT_EQ(y[2], HUGE_VAL);
    EXPECT_TRUE(std::isfinite(y[1]) && std::isfinite(y[3]));
  }
  EXPECT_EQ(log1p(SimdReal(-1))[0], -HUGE_VAL);
  const SimdReal::Mask finite = isfinite(x);
  EXPECT_FALSE(finite[0] || finite[2]);
  EXPECT_TRUE(finite[1] && finite[3]);
}

TEST(SimdReal, ChoicesAreMadeInEveryLaneAlone)
{
  const SimdReal a = Pack{1, 2, 3, 4};
  const SimdReal::Mask large = a > 2;
  const SimdReal chosen = where(large, a, -a);
  for (int i = 0; i < pack_size; ++i)
    EXPECT_EQ(chosen[i], i < 2 ? -(i + 1) : i + 1);
  EXPECT_TRUE(any_of(large) && any_of(!large) && !all_of(large));
  EXPECT_TRUE(all_of(large || a <= 2) && !any_of(large && a <= 2));
  EXPECT_FALSE(any_of(a > std::nan("")));
}

const SimdReal some = Pack{0.25, -1, 4, 1e-300};

TEST(SimdReal, EveryLaneComputesAsANumberDoes)
{
  const SimdReal other = Pack{3, 0.5, -2, 7};
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

TEST(SimdReal, AreNumbersOfTensors)
{
  const Mat3 a{{1, 2, 3}, {0, 4, -1}, {5, 1, 2}}, b{{0.5, 0, 1}, {1, 1, 0}, {-2, 3, 1}};
  const Mat3Of<SimdReal> product = a.cast<SimdReal>() * b.cast<SimdReal>();
  EXPECT_EQ(lane_of(product, 2), Mat3(a * b));
  EXPECT_EQ(product.determinant()[1], Mat3(a * b).determinant());
  EXPECT_EQ(lane_of(unpack(pack(Mat3Of<SimdReal>(product + product.transpose()))), 0), Mat3(a * b + (a * b).transpose()));
}

template <int n>
void rows_become_lanes()
{
  constexpr int width = n + pack_size - 1;
  Real from[pack_size][width];
  std::iota(&from[0][0], &from[0][0] + pack_size * width, 1.0);
  Pack columns[n];
  load_rows<n>({from[0], from[1], from[2], from[3]}, [&](int k, const Pack& pack) { columns[k] = pack; });
  for (int k = 0; k < n; ++k)
    for (int lane = 0; lane < pack_size; ++lane)
      ASSERT_EQ(columns[k][lane], from[lane][k]);
}

TEST(SimdReal, RowsBecomeLanes)
{
  rows_become_lanes<1>();
  rows_become_lanes<2>();
  rows_become_lanes<3>();
  rows_become_lanes<4>();
  rows_become_lanes<6>();
  rows_become_lanes<9>();
}

}  // namespace
}  // namespace talus::lanes_test
