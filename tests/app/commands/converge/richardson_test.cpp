// Order, extrapolated value and grid convergence index of sequences that are known exactly.
#include <gmock/gmock.h>

#include <cmath>

#include "app/commands/converge/richardson.hpp"

namespace talus::richardson_test {

namespace {

const std::vector<Real> halves{0.4, 0.2, 0.1};

/// limit + factor h^order at all sizes.
std::vector<Real> sequence(Real limit, Real factor, Real order, const std::vector<Real>& sizes)
{
  std::vector<Real> values;
  for (const Real size : sizes)
    values.push_back(limit + factor * std::pow(size, order));
  return values;
}

void expect_exact(Real order, const std::vector<Real>& sizes)
{
  constexpr Real limit = 7, factor = -3;
  const auto result = extrapolate(sizes, sequence(limit, factor, order, sizes), 1e-12);
  EXPECT_EQ(result.verdict, Convergence::converges);
  EXPECT_EQ(result.trend, Trend::rises);
  EXPECT_NEAR(result.order.value(), order, 1e-9);
  EXPECT_NEAR(result.extrapolated.value(), limit, 1e-9);
  if (order <= formal_order) {
    EXPECT_NEAR(result.uncertainty.value(), 1.25 * 3 * std::pow(sizes.back(), order), 1e-9) << "1.25 times the error";
  }
}

TEST(Richardson, FindsOrderAndLimitOfAPower)
{
  for (const Real order : {0.6, 1.0, 1.5, 2.0, 2.9})
    expect_exact(order, halves);
}

TEST(Richardson, AndWhereRatiosDiffer)
{
  for (const Real order : {0.6, 1.0, 2.0}) {
    expect_exact(order, {0.35, 0.2, 0.15});
    expect_exact(order, {0.4, 0.3, 0.1});
    expect_exact(order, {1.0, 0.2, 0.15});  // ratio 5 after 1.33: the fixed-point iteration of the paper fails
  }
}

/// Celik et al. 2008, table 1, first column: N = 18000, 8000, 4500 cells, r21 = 1.5, r32 = 1.333; reattachment length.
TEST(Richardson, GivesTheNumbersOfTheExampleOfCelik)
{
  const std::vector<Real> sizes{1.5 * 1.333, 1.5, 1}, values{5.863, 5.972, 6.063};
  const auto result = extrapolate(sizes, values, 1e-12);
  EXPECT_EQ(result.verdict, Convergence::converges);
  EXPECT_NEAR(result.order.value(), 1.53, 0.01);
  EXPECT_NEAR(result.extrapolated.value(), 6.1685, 0.001);
  EXPECT_NEAR(result.uncertainty.value() / 6.063, 0.022, 0.0005);
}

TEST(Richardson, AHighOrderDoesNotMakeTheUncertaintySmall)
{
  const auto result = extrapolate(halves, sequence(1, 1, 2.9, halves), 1e-12);
  const Real change = std::pow(0.2, 2.9) - std::pow(0.1, 2.9);
  EXPECT_EQ(result.trend, Trend::falls);
  EXPECT_NEAR(result.uncertainty.value(), 1.25 * change / 3, 1e-12);
}

void expect_nothing_told(const Extrapolation& result, Convergence verdict)
{
  EXPECT_EQ(enum_names(Convergence{})[static_cast<std::size_t>(result.verdict)],
            enum_names(Convergence{})[static_cast<std::size_t>(verdict)]);
  EXPECT_FALSE(result.extrapolated);
  EXPECT_FALSE(result.uncertainty);
}

TEST(Richardson, OscillationIsNamedAndNotExtrapolated)
{
  const auto falls = extrapolate(halves, std::vector<Real>{1, 3, 2}, 0);
  expect_nothing_told(falls, Convergence::oscillates);
  EXPECT_EQ(falls.trend, Trend::turns);
  expect_nothing_told(extrapolate(halves, std::vector<Real>{1, 2, 0}, 0), Convergence::oscillates_and_grows);
  expect_nothing_told(extrapolate(halves, std::vector<Real>{1, 2, 1}, 0), Convergence::oscillates_and_grows);
}

TEST(Richardson, DivergenceIsNamedAndNotExtrapolated)
{
  expect_nothing_told(extrapolate(halves, std::vector<Real>{1, 2, 4}, 0), Convergence::diverges);
  expect_nothing_told(extrapolate(halves, std::vector<Real>{1, 2, 3}, 0), Convergence::diverges);
  expect_nothing_told(extrapolate(halves, std::vector<Real>{1, 1, 3}, 0), Convergence::diverges);
  // The last change is the smaller one, but the sizes change by even less.
  expect_nothing_told(extrapolate(std::vector<Real>{0.4, 0.2, 0.19}, std::vector<Real>{0, 1, 1.5}, 0), Convergence::diverges);
  // The last change is the larger one, and the sizes change by more than that: order 1.
  const auto larger = extrapolate(std::vector<Real>{0.5, 0.4, 0.1}, std::vector<Real>{0.5, 0.4, 0.1}, 0);
  EXPECT_EQ(larger.verdict, Convergence::converges);
  EXPECT_NEAR(larger.extrapolated.value(), 0, 1e-9);
}

TEST(Richardson, OrdersOutsideTheRangeAreNotBelieved)
{
  const auto low = extrapolate(halves, sequence(1, 1, 0.4, halves), 1e-12);
  expect_nothing_told(low, Convergence::order_low);
  EXPECT_NEAR(low.order.value(), 0.4, 1e-9) << "but told";
  expect_nothing_told(extrapolate(halves, sequence(1, 1, 3.5, halves), 1e-12), Convergence::order_high);
  const auto infinite = extrapolate(halves, std::vector<Real>{1, 0, -1e-9}, 0);
  expect_nothing_told(infinite, Convergence::order_high);
  EXPECT_TRUE(std::isinf(infinite.order.value()));
}

TEST(Richardson, NoChangeIsConstantAndALateOneUndecided)
{
  const auto constant = extrapolate(halves, std::vector<Real>{5, 5 + 1e-12, 5}, 1e-9);
  EXPECT_EQ(constant.verdict, Convergence::constant);
  EXPECT_EQ(constant.trend, Trend::stays);
  EXPECT_EQ(constant.extrapolated, 5);
  EXPECT_NEAR(constant.uncertainty.value(), 1e-12, 1e-15);
  expect_nothing_told(extrapolate(halves, std::vector<Real>{1, 2, 2}, 1e-9), Convergence::undecided);
  expect_nothing_told(extrapolate(std::vector<Real>{0.8, 0.4, 0.2, 0.1}, std::vector<Real>{1, 2, 2, 2}, 1e-9), Convergence::undecided);
}

TEST(Richardson, CoarserSizesHaveToAgree)
{
  const std::vector<Real> sizes{0.8, 0.4, 0.2, 0.1};
  EXPECT_EQ(extrapolate(sizes, sequence(1, 1, 2, sizes), 1e-12).verdict, Convergence::converges);
  std::vector<Real> values = sequence(1, 1, 2, sizes);
  values[0] = values[1] - 0.1;  // the first change has the other sign
  expect_nothing_told(extrapolate(sizes, values, 1e-12), Convergence::unsteady);
}

TEST(Richardson, MissingValuesAreNotJudged)
{
  expect_nothing_told(extrapolate(halves, std::vector<Real>{1, std::nan(""), 2}, 0), Convergence::no_value);
}

TEST(Richardson, EveryVerdictHasAMeaning)
{
  for (std::size_t i = 0; i < enum_names(Convergence{}).size(); ++i)
    EXPECT_FALSE(meaning_of(static_cast<Convergence>(i)).empty());
}

}  // namespace

}  // namespace talus::richardson_test
