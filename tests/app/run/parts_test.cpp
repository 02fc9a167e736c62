// Parts that need no program: formulas, fronts, schedules, names of folders.
#include <gmock/gmock.h>

#include <numbers>
#include <stdexcept>

#include "app/observers/history.hpp"
#include "app/observers/recorder.hpp"
#include "app/observers/results.hpp"
#include "app/setup/expression.hpp"
#include "app/setup/quick.hpp"
#include "core/parallel/threads.hpp"
#include "io/scene/manual/formula_words.hpp"
#include "io/scene/manual/manual.hpp"
#include "materials/interface/constitutive_law_of.hpp"
#include "materials/law_examples.hpp"
#include "mesh/generate/generate.hpp"

namespace talus::parts_test {

namespace {

TEST(Expression, KnowsPlaceAndPi)
{
  const std::vector<Vec3> places{{1, 2, 3}, {0.5, 0, 0}};
  EXPECT_EQ(evaluate("x + 10 * y + 100 * z", places), (std::vector<Real>{321, 0.5}));
  EXPECT_DOUBLE_EQ(evaluate("sin(pi * x)", places)[1], 1.0);
  EXPECT_EQ(evaluate("y > 1 ? 7 : -7", places), (std::vector<Real>{7, -7}));
}

TEST(Expression, FormulaFollowsPlaceAndTime)
{
  const Formula formula("x * t + y");
  EXPECT_EQ(formula({2, 1, 0}, 3), 7);
  EXPECT_EQ(formula({2, 5, 0}, 0), 5);
  EXPECT_THROW(Formula("x * velocity"), std::invalid_argument);
}

TEST(Expression, ManyPlacesAndManyThreadsGiveTheNumbersOfOneByOne)
{
  const Formula formula("x > 1 ? sin(pi * x) * exp(-t) : x ^ y + cos(3 * t)");
  std::vector<Vec3> places;
  for (int i = 0; i < 5000; ++i)
    places.emplace_back(0.0007 * i, 2 - 0.0003 * i, 0);
  std::vector<Real> one_by_one;
  for (const Vec3& place : places)
    one_by_one.push_back(formula(place, 0.25));
  const int before = threads();
  for (const int n : {1, 2, 4}) {
    set_threads(n);
    std::vector<Real> values(places.size());
    parallel_for(50, [&](Index chunk) {
      const auto begin = static_cast<std::size_t>(chunk) * 100;
      formula(std::span(places).subspan(begin, 100), 0.25, std::span(values).subspan(begin, 100));
    });
    EXPECT_EQ(values, one_by_one) << n << " threads";
  }
  set_threads(before);
  EXPECT_EQ(evaluate("x > 1 ? sin(pi * x) * exp(-t) : x ^ y + cos(3 * t)", places)[4999], formula(places[4999], 0));
}

TEST(Expression, RefusesWhatIsNoFormula)
{
  const std::vector<Vec3> places{{0, 0, 0}};
  for (const char* wrong : {"", "2 +", "velocity", "sin(", "1 / x", "sqrt(x - 1)"})
    EXPECT_THROW(evaluate(wrong, places), std::invalid_argument) << wrong;
  EXPECT_THROW(evaluate("2 +", std::span<const Vec3>{}), std::invalid_argument) << "even where there is nothing to evaluate";
}

TEST(Formulas, TheManualHasTheFunctionsThatThereAre)
{
  std::vector<std::string> told;
  for (const FormulaFunction& function : formula_functions)
    told.emplace_back(function.name);
  EXPECT_THAT(told, testing::UnorderedElementsAreArray(functions_of_formulas()));
  EXPECT_THAT(manual_of("atan2"), testing::HasSubstr("atan2(y, x)"));
  EXPECT_THAT(manual_of("formula"), testing::HasSubstr("rint(a)"));
}

TEST(Formulas, AreWorthWhatTheManualSays)
{
  const std::vector<Vec3> here{Vec3(2, 3, 4)};
  const auto value = [&](const std::string& formula) { return evaluate(formula, here).at(0); };
  EXPECT_NEAR(value("sin(1)^2 + cos(1)^2 + tan(1) - sin(1) / cos(1)"), 1, 1e-14);
  EXPECT_NEAR(value("asin(sin(0.3)) + acos(cos(0.4)) + atan(tan(0.5))"), 1.2, 1e-14);
  EXPECT_NEAR(value("atan2(1, -1)"), 3 * std::numbers::pi / 4, 1e-14) << "y first";
  EXPECT_NEAR(value("asinh(sinh(0.3)) + acosh(cosh(0.4)) + atanh(tanh(0.5))"), 1.2, 1e-14);
  EXPECT_NEAR(value("ln(exp(2)) + log(_e) + log2(8) + log10(100)"), 8, 1e-14);
  EXPECT_EQ(value("sqrt(9) + abs(-4) + sign(-7) + sign(0)"), 6);
  EXPECT_EQ(value("rint(2.4)"), 2);
  EXPECT_EQ(value("rint(2.5)"), 3);
  EXPECT_EQ(value("rint(-2.5)"), -2);
  EXPECT_EQ(value("min(x, y, z) + 10 * max(x, y, z) + 100 * sum(x, y, z) + 1000 * avg(x, y, z)"), 2 + 40 + 900 + 3000);
  EXPECT_EQ(value("-2^2"), -4);
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("x < y && y <= z || 0 ? 5 : 6"), 5);
  EXPECT_EQ(value("(x == 2) + (x != 2) + (z >= 4) + (z > 4)"), 2);
}

TEST(Expression, GradientOfALinearFieldIsExactToRoundOff)
{
  const std::vector<Vec3> places{{1, 2, 3}, {-40, 0.1, 0}};
  const std::vector<Real> sizes{0.1, 5};
  const auto found = gradients("7 + 2 * x - 3 * y + 0.5 * z", places, sizes);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Real value = 7 + 2 * std::abs(places[i][0]) + 3 * places[i][1] + 0.5 * places[i][2];  // of the largest sum on the way
    EXPECT_LE((found[i] - Vec3(2, -3, 0.5)).norm(), 10 * std::pow(std::numeric_limits<Real>::epsilon(), 2.0 / 3) * value / sizes[i]);
  }
}

TEST(Expression, GradientFollowsACurveToTheSquareOfItsStep)
{
  const std::vector<Vec3> places{{0.3, 0, 0}};
  // Truncation and round-off are eps^(2/3) = 4e-11 each, times derivatives and a value below 100.
  EXPECT_NEAR(gradients("exp(4 * x)", places, std::vector<Real>{1})[0][0], 4 * std::exp(1.2), 1e-8);
}

TEST(Expression, GradientIsZeroToTheBitWhereNothingChanges)
{
  const std::vector<Vec3> places{{0.3, 1e3, -7}};
  const std::vector<Real> sizes{0.1};
  EXPECT_EQ(gradients("0.1 + 0.2 * pi", places, sizes)[0], Vec3::Zero());
  const Vec3 along_x = gradients("sin(x)", places, sizes)[0];
  EXPECT_EQ(along_x[1], 0);
  EXPECT_EQ(along_x[2], 0);
}

TEST(Expression, JumpsAndKinksHaveNoGradientOfTheirOwn)
{
  const std::vector<Real> sizes{0.1};
  const auto at = [&](const char* formula, Real x) { return gradients(formula, std::vector<Vec3>{{x, 0, 0}}, sizes)[0][0]; };
  constexpr Real round_off = 1e-8;  // eps^(2/3) of values of 3 over cells of 0.1
  EXPECT_EQ(at("x >= 1 ? 3 : -3", 1), 0);
  EXPECT_NEAR(at("x >= 1 ? 2 * x : -3", 1), 2, round_off);
  EXPECT_NEAR(at("x > 1 ? -3 : 2 * x", 1), 2, round_off);
  EXPECT_NEAR(at("abs(x - 1)", 1), 0, round_off) << "the mean of both sides";
  EXPECT_TRUE(std::isfinite(at("sqrt(x)", 0))) << "not finite to the left";
  EXPECT_NEAR(at("sqrt(x - 1) * 0 + 2 * x", 1), 2, round_off) << "finite to the right only";
}

/// Two particles of "left" and two of "right" on a line.
struct RowOfFour {
  Problem<2> problem{Mesh<2>(box<2>(Vec<2>::Zero(), Vec<2>::Ones(), {1, 1}))};
  State<2> state;
  CellOrder order;
  std::vector<VelocityField<2>> fields = std::vector<VelocityField<2>>(1);

  RowOfFour()
  {
    for (const Real x : {3.0, 0.0, 2.0, 1.0}) {
      state.particles.id.push_back(static_cast<std::int64_t>(state.particles.id.size()));
      state.particles.x.push_back({x, 0});
      state.particles.mass.push_back(1);
    }
    state.bodies = {{"left", 0, 2, {}}, {"right", 2, 4, {}}};
    for (const Body& body : state.bodies)
      state.materials.push_back(make_material(law_example<NeoHookean>(), body.begin, body.end, body.name));
    order.row = {0, 1, 2, 3}, order.first = {0, 2, 4}, order.blocks = 1;
  }
  RunView<2> view() const { return {problem, state, order, fields, "the only", "run", 0, 0}; }
};

TEST(Front, IsTheCoordinateThatAShareOfTheMassDoesNotPass)
{
  const RowOfFour row;
  FrontSpec spec;
  spec.direction = Direction::x_plus;
  spec.mass_share = 1;
  EXPECT_EQ(front(spec, row.view()), 3);
  spec.mass_share = 0.5;
  EXPECT_EQ(front(spec, row.view()), 1);
  spec.direction = Direction::x_minus;
  EXPECT_EQ(front(spec, row.view()), 2);
  spec.mass_share = 1;
  spec.body = "right";
  EXPECT_EQ(front(spec, row.view()), 1);
}

TEST(Moved, IsTheDisplacementThatAShareOfTheMassDoesNotExceed)
{
  RowOfFour row;
  Particles<2>& particles = row.state.particles;
  particles.x0 = particles.x;
  for (std::size_t p = 0; p < 4; ++p)
    particles.x0.set(p, particles.x0[p] - Vec<2>(3, 4) * std::vector<Real>{0.2, 0, 0.6, 0.4}[p]);
  MovedSpec spec;
  spec.mass_share = 1;
  EXPECT_NEAR(moved(spec, row.view()), 3, 1e-14);
  spec.mass_share = 0.5;
  EXPECT_NEAR(moved(spec, row.view()), 1, 1e-14);
  spec.body = "right";
  EXPECT_NEAR(moved(spec, row.view()), 2, 1e-14);
}

TEST(NearestParticle, IsLookedForInItsBody)
{
  const RowOfFour row;
  PointSpec spec;
  spec.at = {2.9, 0};
  EXPECT_EQ(nearest_particle(spec, row.view()), 0);
  spec.body = "right";
  EXPECT_EQ(nearest_particle(spec, row.view()), 2);
  spec = {};
  spec.at = {0.5, 0};
  EXPECT_EQ(nearest_particle(spec, row.view()), 1) << "the lower id of two equally near ones";
}

TEST(Schedule, ComesOncePerIntervalHoweverLongTheSteps)
{
  Schedule schedule(0.1);
  std::vector<Real> written;
  for (const Real time : {0.0, 0.05, 0.1, 0.11, 0.35, 0.36, 0.4})
    if (schedule.due(time))
      written.push_back(time);
  EXPECT_EQ(written, (std::vector<Real>{0.0, 0.1, 0.35, 0.4}));
}

TEST(Results, AreNamedAfterTheFolderOfAScene)
{
  EXPECT_EQ(default_results("scenes/bar/scene.yaml"), "runs/bar");
  EXPECT_EQ(default_results("scenes/bar/fine.yaml"), "runs/fine");
}

TEST(Quick, CutsStagesInProportion)
{
  std::vector<Stage> stages(2);
  stages[0].duration = 3, stages[0].ramp = 1, stages[0].residual = 1e-3;
  stages[1].duration = 1;
  OutputSpec outputs;
  outputs.history.emplace().every = 1e-3;
  shorten(0.001, stages, outputs);
  EXPECT_DOUBLE_EQ(stages[0].duration, 0.15);
  EXPECT_DOUBLE_EQ(stages[0].ramp, 0.05);
  EXPECT_DOUBLE_EQ(stages[1].duration, 0.05);
  EXPECT_FALSE(stages[0].residual.has_value());
  EXPECT_DOUBLE_EQ(outputs.history->every, 0.05);
}

}  // namespace

}  // namespace talus::parts_test
