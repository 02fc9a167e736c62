// talus fos: what motion says, which factors come next, and a bank whose factor is found.
#include <gmock/gmock.h>

#include "app/commands/fos/fos_search.hpp"
#include "core/error.hpp"
#include "tests/app/program.hpp"

namespace talus::fos_test {

namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Ten metres high; settles by 0.1 m under its own weight.
const AtRest bank{.gravity = 10, .height = 10, .wave_speed = 100};

HistoryTable history_of(Real (*moved)(Real), Real (*kinetic)(Real))
{
  HistoryTable table{{{"time", "s"}, {"mass", "kg"}, {"kinetic", "J"}, {"moved", "m"}}, {{}, {}, {}, {}}};
  for (int row = 0; row <= 100; ++row) {
    const Real time = 0.04 * row;
    const std::array<Real, 4> values{time, 1000, kinetic(time), moved(time)};
    for (std::size_t c = 0; c < 4; ++c)
      table.values[c].push_back(values[c]);
  }
  return table;
}
const std::vector<std::string> columns{"moved"};

TEST(FosSearch, MotionIsWhatIsAddedInTheSecondHalfAndWhatIsStillAlive)
{
  const auto slides = motion_of(history_of([](Real t) { return 0.5 * t; }, [](Real t) { return 10 * t; }), columns, bank);
  ASSERT_TRUE(slides);
  EXPECT_NEAR(slides->growth, 1, 1e-12);
  ASSERT_TRUE(slides->liveliness);
  EXPECT_NEAR(*slides->liveliness, 0.95, 1e-12);  // mean from 3.6 to 4 s over the peak at 4 s
  EXPECT_NEAR(slides->moved, 2, 1e-12);
  EXPECT_NEAR(slides->duration, 4, 1e-12);
  EXPECT_EQ(judge(*slides, {}), Verdict::fails);

  const auto rests =
      motion_of(history_of([](Real t) { return std::min(t, 1.0); }, [](Real t) { return t < 1 ? 100.0 : 0; }), columns, bank);
  EXPECT_EQ(rests->growth, 0);
  EXPECT_EQ(rests->liveliness, 0);
  EXPECT_EQ(judge(*rests, {}), Verdict::holds);
}

TEST(FosSearch, WhatIsSmallBesideTheSettlementIsNoGrowth)
{
  const auto trembles = motion_of(history_of([](Real t) { return 1e-5 * t; }, [](Real) { return 1e-6; }), columns, bank);
  EXPECT_NEAR(trembles->growth, 2e-5 / 0.05, 1e-12);
  EXPECT_NEAR(trembles->liveliness.value_or(0), 1, 1e-12);
  EXPECT_EQ(judge(*trembles, {}), Verdict::holds);
}

TEST(FosSearch, MeasuresThatContradictEachOtherAreUnclear)
{
  EXPECT_EQ(judge({.growth = 0.2, .liveliness = 1e-5, .steadiness = {}}, {}), Verdict::unclear);
  EXPECT_EQ(judge({.growth = 0.05, .liveliness = 1e-2, .steadiness = {}}, {}), Verdict::unclear);
  EXPECT_EQ(judge({.growth = 0.019, .liveliness = 1e-2, .steadiness = {}}, {}), Verdict::holds) << "a fifth of the limit is clear";
  EXPECT_EQ(judge({.growth = 0.51, .liveliness = 1e-5, .steadiness = {}}, {}), Verdict::fails);
  EXPECT_EQ(judge({.growth = std::nan(""), .liveliness = 1, .steadiness = {}}, {}), Verdict::fails);
  EXPECT_FALSE(motion_of(history_of([](Real t) { return t; }, [](Real t) { return t; }), std::vector<std::string>{"crest"}, bank));
}

TEST(FosSearch, EquilibriaFailWhereTheyMoveOnSteadily)
{
  const auto none = [](Real) { return 0.0; };
  const auto slides = motion_of(history_of([](Real t) { return 0.5 * t; }, none), columns, bank);
  ASSERT_TRUE(slides);
  EXPECT_FALSE(slides->liveliness);
  ASSERT_TRUE(slides->steadiness);
  EXPECT_NEAR(*slides->steadiness, 1, 1e-9);
  EXPECT_EQ(judge(*slides, {}), Verdict::fails);
  const auto settles = motion_of(history_of([](Real t) { return 1 - std::exp(-t / 1.5); }, none), columns, bank);
  EXPECT_GT(settles->growth, 0.1);
  EXPECT_NEAR(settles->steadiness.value_or(0), std::exp(-4 / 3.0 / 1.5), 1e-3);
  EXPECT_EQ(judge(*settles, {}), Verdict::holds) << "moves less and less";
  const auto rests = motion_of(history_of(none, none), columns, bank);
  EXPECT_EQ(judge(*rests, {}), Verdict::holds);
}

TEST(FosSearch, DurationFollowsFromHeightAndWaves)
{
  EXPECT_NEAR(usual_duration(bank), 3, 1e-12);
  EXPECT_NEAR(usual_duration({.gravity = 10, .height = 10, .wave_speed = 30}), 6.7, 1e-12) << "twenty passes of waves";
}

/// Searches with a slope that fails above `truth`; the factors in the order in which they were tried.
std::vector<std::vector<Real>> search(Real truth, const FosRange& range, std::size_t jobs, std::vector<FosTrial>& trials)
{
  std::vector<std::vector<Real>> rounds;
  for (auto next = next_factors(trials, range, jobs); !next.empty(); next = next_factors(trials, range, jobs)) {
    rounds.push_back(next);
    for (const Real factor : next)
      trials.push_back({.factor = factor, .verdict = factor > truth ? Verdict::fails : Verdict::holds, .motion = {}, .message = {}});
  }
  return rounds;
}

TEST(FosSearch, BisectsOnTidyFactorsUntilTheBracketIsNarrow)
{
  std::vector<FosTrial> trials;
  const auto rounds = search(1.37, {.from = 1, .to = 2, .width = 0.1}, 1, trials);
  EXPECT_THAT(rounds, ElementsAre(ElementsAre(1), ElementsAre(2), ElementsAre(1.5), ElementsAre(1.25), ElementsAre(1.4), ElementsAre(1.3)));
  EXPECT_EQ(bracket_of(trials).low, 1.3);
  EXPECT_EQ(bracket_of(trials).high, 1.4);
}

TEST(FosSearch, TriesSeveralFactorsAtOnce)
{
  std::vector<FosTrial> trials;
  const auto rounds = search(1.37, {.from = 0.5, .to = 3, .width = 0.02}, 4, trials);
  EXPECT_THAT(rounds.front(), ElementsAre(0.5, 3));
  EXPECT_THAT(rounds[1], ElementsAre(1, 1.5, 2, 2.5));
  EXPECT_LE(rounds.size(), 5U);
  const Bracket bracket = bracket_of(trials);
  EXPECT_LE(*bracket.high - *bracket.low, 0.02 * (1 + 1e-9));
  EXPECT_LE(*bracket.low, 1.37);
  EXPECT_GT(*bracket.high, 1.37);
}

TEST(FosSearch, TheRangeGivesWayAndThenIsRefused)
{
  std::vector<FosTrial> strong;
  search(7, {.from = 1, .to = 2, .width = 0.5}, 2, strong);
  EXPECT_GE(*bracket_of(strong).low, 6.5);
  std::vector<FosTrial> weak;
  search(0.3, {.from = 1, .to = 2, .width = 0.1}, 2, weak);
  EXPECT_LE(*bracket_of(weak).high, 0.4);
  std::vector<FosTrial> trials;
  EXPECT_THROW(search(1e3, {.from = 1, .to = 2, .width = 0.1}, 2, trials), RunError);
  trials.clear();
  EXPECT_THROW(search(0, {.from = 1, .to = 2, .width = 0.1}, 2, trials), RunError);
}

TEST(FosSearch, VerdictsThatAreNotInOrderAreTold)
{
  const auto trial = [](Real factor, Verdict verdict) {
    return FosTrial{.factor = factor, .verdict = verdict, .motion = {}, .message = {}};
  };
  const std::vector<FosTrial> trials{trial(1, Verdict::holds), trial(1.2, Verdict::fails), trial(1.3, Verdict::holds),
                                     trial(1.4, Verdict::fails)};
  const Bracket bracket = bracket_of(trials);
  EXPECT_EQ(bracket.low, 1);
  EXPECT_EQ(bracket.high, 1.2);
  EXPECT_THAT(bracket.out_of_order, ElementsAre(1.3));
}

/// A vertical bank of clay 1 m high, which fails where c = 0.26 to 0.27 of its weight times its height (Taylor 1937; upper bound 3.83, found here by
/// coarse cells): 5.2 kPa at most.
std::string bank_scene(const std::string& stages, const std::string& law = "mohr_coulomb, friction_angle: 0, cohesion: 1.0e4")
{
  return "title: Bank\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [3, 1.25], cells: [12, 5]}}\n"
         "materials: [{name: clay, law: " +
         law +
         ", density: 2000, youngs_modulus: 2.0e6, poisson_ratio: 0.4}]\n"
         "bodies: [{name: bank, material: clay, shape: {type: box, low: [0, 0], high: [1.5, 1]}, particles_per_cell: 3, f_bar: true}]\n"
         "loads: [{type: gravity, acceleration: [0, -9.81]}]\n"
         "boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}, {type: roller, on: x_max}]\n"
         "on_exit: delete\n" +
         stages;
}
const std::string at_rest = "stages: [{type: geostatic, duration: 20, residual: 1.0e-2}, {type: run, duration: 60}]\n";

class FosProgram : public Program {
 protected:
  Outcome fos(const std::string& words) const { return talus("fos bank.yaml --out out --threads 1 --no-pictures " + words); }
};

TEST_F(FosProgram, FindsWhereABankFailsAndGoesOnWithWhatIsThere)
{
  write("bank.yaml", bank_scene(at_rest));
  const Outcome coarse = fos("--from 1 --to 4 --width 1 --jobs 2");
  ASSERT_EQ(coarse.code, 0) << coarse.err;
  EXPECT_THAT(coarse.out, AllOf(HasSubstr("at rest: begins"), HasSubstr("materials[0].cohesion=2500"), HasSubstr("factor of safety ")));
  const Outcome finer = fos("--from 1 --to 4 --width 0.5 --jobs 2");
  ASSERT_EQ(finer.code, 0) << finer.err;
  EXPECT_THAT(finer.out, AllOf(HasSubstr("at rest: done before"), HasSubstr("trials judged before"), Not(HasSubstr("1: begins"))));
  const std::string csv = read("out/fos.csv");
  EXPECT_THAT(csv, testing::StartsWith(
                       "factor,verdict,moved [m],growth,kinetic_over_peak,duration [s],by_growth_alone,steadiness,message\n1,holds,"));
  EXPECT_THAT(csv, HasSubstr("\n4,fails,"));
  const auto number = [&](const std::string& key) {
    const std::string json = read("out/fos.json");
    return std::stod(json.substr(json.find(key) + key.size()));
  };
  const Real factor = number("\"factor_of_safety\": ");
  EXPECT_NEAR(factor, 3.83 * 1e4 / (2000 * 9.81), 0.5);
  EXPECT_LT(number("\"highest_that_holds\": "), factor);
  EXPECT_GT(number("\"lowest_that_fails\": "), factor);

  const std::string json = read("out/fos.json");
  const std::string mark = "\"command\": \"talus ";
  std::string command = json.substr(json.find(mark) + mark.size());
  command = command.substr(0, command.find("\"\n"));
  for (auto at = command.find("\\\""); at != command.npos; at = command.find("\\\"", at))
    command.replace(at, 2, "\"");
  command.replace(command.find("--out out/trial_1 "), 18, "--out alone --quiet ");
  ASSERT_EQ(talus(command).code, 0) << command;
  EXPECT_EQ(read("alone/history.csv"), read("out/trial_1/history.csv")) << "anybody can repeat a trial";
}

/// Each increment of a static trial has the same loads: a bank that stands moves in the first one only, one that fails in each.
TEST_F(FosProgram, StaticTrialsFindTheFactorThatRunsFind)
{
  write("bank.yaml", bank_scene("stages: [{type: static, increments: 2, initial_stress: {k0: 0.7}}, {type: run, duration: 60}]\n"));
  const Outcome outcome = fos("--from 1.75 --to 2.25 --width 0.25 --jobs 2");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("6 equilibria each; fails: growth above 0.1 and steadiness above 0.5, or no equilibrium"));
  const std::string json = read("out/fos.json"), key = "\"factor_of_safety\": ";
  EXPECT_NEAR(std::stod(json.substr(json.find(key) + key.size())), 3.83 * 1e4 / (2000 * 9.81), 0.25);  // runs find 1.875
  EXPECT_THAT(read("out/trial_1.75/summary.json"), HasSubstr("type: static, increments: 6"));
  EXPECT_EQ(fos("--duration 2").code, 2);
  EXPECT_THAT(fos("--kinetic 1.0e-3").err, HasSubstr("belong to trials that are runs"));
  const Outcome lenient = fos("--from 1.75 --to 2.25 --width 0.5 --growth 10 --steadiness 2 --jobs 2");
  EXPECT_THAT(lenient.out, HasSubstr("2.25  holds")) << "neither limit is reached";
  EXPECT_EQ(fos("--trials damped").code, 2);
  write("bank.yaml", bank_scene(at_rest));
  EXPECT_THAT(fos("--increments 4").err, HasSubstr("--increments and --steadiness belong to static trials"));
}

TEST_F(FosProgram, SaysWhatKeepsStrengthFromBeingDivided)
{
  write("bank.yaml", bank_scene("time: {end: 1}\n"));
  const Outcome no_rest = fos("");
  EXPECT_EQ(no_rest.code, 2);
  EXPECT_THAT(no_rest.err, HasSubstr("stages: there is no stage of type geostatic or static"));
  write("bank.yaml", bank_scene(at_rest, "neo_hookean"));
  const Outcome rubber = fos("");
  EXPECT_EQ(rubber.code, 2);
  EXPECT_THAT(rubber.err, HasSubstr("no body has a material with strength"));
  write("bank.yaml", bank_scene(at_rest));
  EXPECT_THAT(fos("--bodies bnk").err, HasSubstr("in the state at rest there is no body \"bnk\" — did you mean \"bank\"?"));
  EXPECT_EQ(fos("--from 2 --to 1").code, 2);
  EXPECT_EQ(fos("--width 0").code, 2);
  EXPECT_EQ(talus("fos").code, 2);
  EXPECT_FALSE(exists("out"));
}

/// All that a body can say of how it is filled, a water table that moves before the state at rest, and a wall for one stage only.
TEST_F(FosProgram, TrialsKeepWhatABodyIsAndNotHowItIsFilled)
{
  std::string scene = bank_scene(
      "water: {table: {elevation: 0.2}}\nstages: [{type: geostatic, duration: 20, residual: 1.0e-2, name: first, initial_stress: {k0: "
      "0.6}}, "
      "{type: geostatic, duration: 20, residual: 1.0e-2, name: second, water: {table: {elevation: 0.4}}}, {type: run, duration: 60, water: "
      "{table: {elevation: 0.1}}}]\n");
  scene.replace(scene.find("f_bar: true"), 11, "f_bar: true, saturated_density: 2100, velocity: [0, 0]");
  scene.replace(scene.find("on: x_max"), 9, "where: x_max, during: [second]");
  write("bank.yaml", scene);
  const Outcome outcome = fos("--from 1 --to 4 --width 3 --jobs 2 --quick --duration 1");
  EXPECT_TRUE(outcome.code == 0 || outcome.code == 1) << outcome.err;
  const std::string scene_of_trial = read("out/trial_4/summary.json");
  EXPECT_THAT(scene_of_trial, HasSubstr("\"status\": \"done\"")) << outcome.err;
  EXPECT_THAT(scene_of_trial, HasSubstr("water.table={\\\"elevation\\\": 0.4}")) << "that of the state at rest";
  EXPECT_THAT(scene_of_trial, HasSubstr("bodies=[{\\\"name\\\": bank, \\\"material\\\": clay, \\\"f_bar\\\": true}]"));
}

TEST_F(FosProgram, ATrialThatBreaksOffHasFailed)
{
  std::string scene = bank_scene(at_rest);
  scene.replace(scene.find("on_exit: delete\n"), 16, "watch: {speed: 0.5, on_speed: stop}\n");
  write("bank.yaml", scene);
  const Outcome outcome = fos("--from 1 --to 8 --width 7 --jobs 2");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("the run broke off: "));
  EXPECT_THAT(read("out/fos.csv"), HasSubstr("\n8,fails,,,,,0,,"));
  const Outcome again = fos("--from 1 --to 8 --width 7 --jobs 2");
  EXPECT_THAT(again.out, AllOf(HasSubstr("2 trials judged before"), Not(HasSubstr("begins"))));
}

}  // namespace

}  // namespace talus::fos_test
