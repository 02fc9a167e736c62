// Sums that are rounded once, against additions that the processor rounds once, and in many orders.
#include "core/parallel/exact_sum.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace talus::exact_sum_test {
namespace {

constexpr Real infinity = std::numeric_limits<Real>::infinity(), not_a_number = std::numeric_limits<Real>::quiet_NaN();
constexpr Real largest = std::numeric_limits<Real>::max(), smallest = std::numeric_limits<Real>::denorm_min();

Real exact(const std::vector<Real>& numbers)
{
  ExactSum sum;
  for (const Real x : numbers)
    sum.add(x);
  return sum.value();
}

/// Equal bits, but for zeros, which an exact sum gives the sign plus, and NaN.
testing::AssertionResult same(Real a, Real b)
{
  if ((std::isnan(a) && std::isnan(b)) || (a == b && (b != 0 || !std::signbit(a))))
    return testing::AssertionSuccess();
  return testing::AssertionFailure() << std::hexfloat << a << " is not " << b;
}

/// Any pattern of bits: as many subnormal as huge numbers, none of them infinite or NaN.
Real anything(std::mt19937_64& random)
{
  for (;;)
    if (const Real x = std::bit_cast<Real>(random()); std::isfinite(x))
      return x;
}

TEST(ExactSum, OfNothingIsZero)
{
  EXPECT_TRUE(same(ExactSum{}.value(), 0));
  EXPECT_TRUE(same(exact({-0.0, -0.0}), 0));
  EXPECT_TRUE(same(exact({1, -1}), 0));
}

TEST(ExactSum, OfOneNumberIsTheNumber)
{
  std::mt19937_64 random(1);
  ExactSum sum;
  for (int i = 0; i < 20000; ++i) {
    const Real x = anything(random);
    sum.add(x);
    ASSERT_TRUE(same(sum.value(), x));
    sum.clear();
  }
  for (const Real x : {largest, -largest, smallest, -smallest, std::numeric_limits<Real>::min()})
    EXPECT_TRUE(same(exact({x}), x));
}

TEST(ExactSum, OfTwoIsRoundedAsTheProcessorRounds)
{
  std::mt19937_64 random(2);
  for (int i = 0; i < 50000; ++i) {
    const Real x = anything(random);
    const Real y = i % 2 == 0 ? anything(random) : std::ldexp(anything(random), std::ilogb(x)) * 1e-9;  // wide apart, or near
    if (std::isfinite(y)) {
      ASSERT_TRUE(same(exact({x, y}), x + y));
      ASSERT_TRUE(same(exact({x, -y}), x - y));
    }
  }
}

TEST(ExactSum, OfThreeIsRoundedAsTheProcessorRoundsAProductAndASum)
{
  std::mt19937_64 random(3);
  std::uniform_real_distribution<Real> number(-1, 1);
  std::uniform_int_distribution<int> exponent(-120, 120);
  for (int i = 0; i < 50000; ++i) {
    const Real a = number(random), b = number(random), c = std::ldexp(number(random), exponent(random));
    const Real product = a * b, rest = std::fma(a, b, -product);
    ASSERT_TRUE(same(exact({rest, c, product}), std::fma(a, b, c)));
  }
}

TEST(ExactSum, RoundsTiesToEvenAndSeesTheLastBit)
{
  const Real half = std::ldexp(1, -53), next = 1 + 2 * half;
  for (const Real sign : {1.0, -1.0}) {
    EXPECT_EQ(exact({sign, sign * half}), sign);
    EXPECT_EQ(exact({sign * half, sign, sign * smallest}), sign * next);
    EXPECT_EQ(exact({sign, sign * half, -sign * smallest}), sign);
    EXPECT_EQ(exact({sign * next, sign * half}), sign * (1 + 4 * half));
    EXPECT_EQ(exact({sign * next, sign * half, -sign * smallest}), sign * next);
  }
}

TEST(ExactSum, GoesBeyondTheLargestNumberAndComesBack)
{
  const Real half = std::ldexp(1, 970);  // of the last bit of the largest
  EXPECT_EQ(exact({largest, largest, -largest}), largest);
  EXPECT_EQ(exact({largest, half}), infinity);
  EXPECT_EQ(exact({-largest, -half}), -infinity);
  EXPECT_EQ(exact({largest, half, -smallest}), largest);
  EXPECT_EQ(exact({1e308, -1e308, 1e-308}), 1e-308);
  EXPECT_EQ(exact({1e308, 1e-308, 1e308, -1e308, 3, -1e308}), 3);
}

TEST(ExactSum, WithWhatIsNotFiniteIsAsInIeeeArithmetic)
{
  EXPECT_EQ(exact({1, infinity, -largest}), infinity);
  EXPECT_EQ(exact({-infinity, 1, -infinity}), -infinity);
  EXPECT_TRUE(std::isnan(exact({infinity, 1, -infinity})));
  EXPECT_TRUE(std::isnan(exact({1, not_a_number, infinity})));
  ExactSum sum;
  sum.add(not_a_number);
  sum.clear();
  EXPECT_TRUE(same(sum.value(), 0));
}

#if LDBL_MANT_DIG == 113
using Wide = long double;
#else
__extension__ using Wide = __float128;  // a name that compilers know only where long double is shorter
#endif

TEST(ExactSum, DoesNotDependOnTheOrder)
{
  static_assert(sizeof(Wide) == 16);  // 113 bits: exact for what follows
  std::mt19937_64 random(4);
  std::uniform_real_distribution<Real> number(-1, 1);
  std::vector<Real> numbers(100000);
  Wide wide = 0;
  for (Real& x : numbers) {
    x = std::ldexp(number(random), static_cast<int>(random() % 40));
    wide += static_cast<Wide>(x);
  }
  for (int order = 0; order < 5; ++order) {
    EXPECT_EQ(exact(numbers), static_cast<Real>(wide));
    std::shuffle(numbers.begin(), numbers.end(), random);
  }
}

TEST(ExactSum, LeavesNothingOfWhatCancels)
{
  std::mt19937_64 random(5);
  std::vector<Real> numbers;
  for (int i = 0; i < 20000; ++i) {
    numbers.push_back(anything(random));
    numbers.push_back(-numbers.back());
  }
  for (const Real left : {0.0, smallest, -1e-310, 1.0 / 3, -largest}) {
    numbers.push_back(left);
    std::shuffle(numbers.begin(), numbers.end(), random);
    EXPECT_TRUE(same(exact(numbers), left));
    numbers.push_back(-left);
  }
}

TEST(ExactSum, OfSumsIsTheSumOfAll)
{
  std::mt19937_64 random(6);
  ExactSum all, total, through_words;
  std::vector<std::int64_t> words(ExactSum::words, 0), part_words(ExactSum::words);
  for (int part = 0; part < 50; ++part) {
    ExactSum sum;
    for (int i = 0; i < part * part; ++i) {  // the first is empty
      const Real x = anything(random);
      sum.add(x);
      all.add(x);
    }
    total.add(sum);
    sum.write(part_words);
    for (std::size_t w = 0; w < words.size(); ++w)
      words[w] += part_words[w];
  }
  through_words.read(words);
  EXPECT_EQ(total.value(), all.value());
  EXPECT_EQ(through_words.value(), all.value());
  through_words.read(words);
  EXPECT_EQ(through_words.value(), all.value());

  ExactSum odd;
  odd.add(-infinity);
  odd.write(words);
  through_words.add(words);
  EXPECT_EQ(through_words.value(), -infinity);
}

TEST(ExactSum, HoldsMoreSummandsThanAreAddedBetweenCarries)
{
  for (const Real x : {largest, -1.0 / 3, smallest}) {
    ExactSum sum;
    sum.add(x);
    for (int i = 0; i < 50; ++i)
      sum.add(sum);
    for (int i = 0; i < 1000; ++i)
      sum.add(x);
    std::vector<std::int64_t> words(ExactSum::words);
    for (int i = 0; i < 2000; ++i) {  // carries in between, of words as large as those of 2^20 ranks
      ExactSum one;
      one.add(x);
      one.write(words);
      for (std::int64_t& w : words)
        w <<= 20;
      sum.add(words);
    }
    const Real times = std::ldexp(1, 50) + 1000 + 2000 * std::ldexp(1, 20);  // exact
    EXPECT_TRUE(same(sum.value(), std::abs(x) == largest ? infinity : std::fma(times, x, 0.0)));
    std::vector<Real> back(1000, -x);
    for (const Real y : back)
      sum.add(y);
    EXPECT_TRUE(same(sum.value(), std::abs(x) == largest ? infinity : (times - 1000) * x));
  }
}

struct Pair {
  Real mass = 0;
  Vec<2> push = Vec<2>::Zero();
};

TEST(ExactSums, AddEveryEntry)
{
  static_assert(ExactSums<Pair>::words == 3 * ExactSum::words);
  ExactSums<Pair> sums, others;
  sums.add({1, {1e20, 3}});
  sums.add({2, {1, -3}});
  others.add({0, {-1e20, 0.5}});
  sums.add(others);
  EXPECT_EQ(sums.value().mass, 3);
  EXPECT_EQ(sums.value().push, Vec<2>(1, 0.5));

  std::vector<std::int64_t> words(ExactSums<Pair>::words);
  sums.write(words);
  others.read(words);
  others.add(words);
  EXPECT_EQ(others.value().mass, 6);
  EXPECT_EQ(others.value().push, Vec<2>(2, 1));
  others.clear();
  EXPECT_EQ(others.value().mass, 0);

  ExactSums<Real> plain;
  plain.add(2.5);
  EXPECT_EQ(plain.value(), 2.5);
}

}  // namespace
}  // namespace talus::exact_sum_test
