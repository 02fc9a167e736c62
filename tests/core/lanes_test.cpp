// Numbers of several particles: functions as exact as those of one number, choices, and lanes that mind their own business.
#include "core/lanes.hpp"

#include <gtest/gtest.h>

#include <random>

namespace talus {
namespace {

/// Units of the last place between f of lanes and its exact value, the worst of random arguments sign * 10^[low, high].
template <class F, class Exact>
Real worst_error(F&& f, Exact&& exact, Real low, Real high, bool negative)
{
  std::mt19937 bits(1);
  std::uniform_real_distribution<Real> power(low, high);
  Real worst = 0;
  for (int n = 0; n < 20000; ++n) {
    const Lanes x = in_each_lane([&](int) { return (negative ? -1 : 1) * std::pow(10, power(bits)); });
    const Lanes y = f(x);
    for (int i = 0; i < pack_size; ++i) {
      const auto right = static_cast<Real>(exact(static_cast<long double>(x[i])));
      const Real unit = std::nextafter(std::abs(right), HUGE_VAL) - std::abs(right);
      worst = std::max(worst, std::abs(y[i] - right) / unit);
    }
  }
  return worst;
}

TEST(Lanes, LogarithmAndExponentialKeepTheLastDigits)
{
  const auto log_of = [](const Lanes& x) { return log(x); };
  const auto exp_of = [](const Lanes& x) { return exp(x); };
  EXPECT_LE(worst_error(
                log_of, [](long double x) { return std::log(x); }, -300, 300, false),
            2);
  for (const bool negative : {false, true})
    EXPECT_LE(worst_error(
                  exp_of, [](long double x) { return std::exp(x); }, -10, 2.8, negative),
              2);
}

TEST(Lanes, DifferencesFromOneKeepTheDigitsOfSmallNumbers)
{
  const auto log_of = [](const Lanes& x) { return log1p(x); };
  const auto exp_of = [](const Lanes& x) { return expm1(x); };
  const auto exact_log = [](long double x) { return std::log1p(x); };
  const auto exact_exp = [](long double x) { return std::expm1(x); };
  for (const bool negative : {false, true}) {
    EXPECT_LE(worst_error(log_of, exact_log, -300, -1.001, negative), 3);
    EXPECT_LE(worst_error(exp_of, exact_exp, -300, -1.001, negative), 3);
    EXPECT_LE(worst_error(log_of, exact_log, -20, negative ? -0.001 : 300, negative), 5);
    EXPECT_LE(worst_error(exp_of, exact_exp, -20, 2.8, negative), 5);
  }
}

TEST(Lanes, PowersKeepAllButTheLastDigits)
{
  for (const Real n : {-7.0, -0.3, 0.26, 1.03, 6.0}) {
    const auto of = [&](const Lanes& x) { return pow(x, n); };
    const auto exact = [&](long double x) { return std::pow(x, static_cast<long double>(n)); };
    EXPECT_LE(worst_error(of, exact, -6, 1, false), 4 + 2 * std::abs(n) * 6 * std::log(10)) << n;
  }
  EXPECT_EQ(pow(Lanes(0), 0.3)[1], 0);
}

TEST(Lanes, OddNumbersStayInTheirLane)
{
  const Real nan = std::nan("");
  const Lanes x = Pack{nan, -2, HUGE_VAL, 0.5};
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
  EXPECT_EQ(log1p(Lanes(-1))[0], -HUGE_VAL);
  const Lanes::Mask finite = isfinite(x);
  EXPECT_FALSE(finite[0] || finite[2]);
  EXPECT_TRUE(finite[1] && finite[3]);
}

TEST(Lanes, ChoicesAreMadeInEveryLaneAlone)
{
  const Lanes a = Pack{1, 2, 3, 4};
  const Lanes::Mask large = a > 2;
  const Lanes chosen = where(large, a, -a);
  for (int i = 0; i < pack_size; ++i)
    EXPECT_EQ(chosen[i], i < 2 ? -(i + 1) : i + 1);
  EXPECT_TRUE(somewhere(large) && somewhere(!large) && !everywhere(large));
  EXPECT_TRUE(everywhere(large || a <= 2) && !somewhere(large && a <= 2));
  EXPECT_FALSE(somewhere(a > std::nan("")));
}

}  // namespace
}  // namespace talus
