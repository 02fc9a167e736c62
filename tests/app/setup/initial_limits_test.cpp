// A scene that begins as another run left it: what is refused, what is warned of, and how it goes on.
#include "tests/app/setup/bank_that_begins_elsewhere.hpp"

namespace talus::initial_test {
namespace {

TEST_F(Initial, WhatCannotBeTakenIsRefusedWithItsPlace)
{
  run_well("first", {});
  const std::string file = checkpoints("first").back().filename().string();
  Bank bank = second();
  bank.mesh = "{grid: {low: [0, 0.3], high: [3, 1.5], cells: [12, 6]}}";
  EXPECT_THAT(refusal(bank),
              testing::ContainsRegex("refused.yaml:6:10: error: initial.from: [0-9]+ of the 96 particles of body \"bank\" there "
                                     "lie outside the mesh of this scene, the first at \\(0\\.[0-9, .]+\\)\n"));
  bank = second();
  bank.bodies = "{name: bamk, material: soil}";
  EXPECT_THAT(refusal(bank), HasSubstr("refused.yaml:5:10: error: bodies[0] \"bamk\": one of region or shape is needed, or a source in "
                                       "initial.bodies: there is no body \"bamk\" in first/checkpoints/" +
                                       file + " — did you mean \"bank\"?\n"));
  EXPECT_THAT(refusal(second(", bodies: [{body: bank, from: bamk}]")),
              HasSubstr("initial.bodies[0].from: there is no body \"bamk\" in first/checkpoints/" + file + " — did you mean \"bank\"?\n"));
  bank = second();
  bank.bodies = "{name: bank, material: soil, " + filled + "}";
  EXPECT_THAT(refusal(bank), HasSubstr("bodies[0] \"bank\".shape: body \"bank\" takes its particles from the one of its name in "
                                       "first/checkpoints/" +
                                       file + ": leave this out, or list in initial.bodies those that do\n"));
  bank.bodies = "{name: dam, material: soil, " + filled + "}";
  EXPECT_THAT(refusal(bank), HasSubstr("initial.from: no body of this scene has the name of one in first/checkpoints/" + file +
                                       ", which has bank; say in initial.bodies which takes which\n"));
  write("refused.yaml",
        "title: In space\ndimension: 3\nmesh: {grid: {low: [0, 0, 0], high: [1, 1, 1], cells: [1, 1, 1]}}\n"
        "materials: [{name: soil, " +
            soil +
            "}]\nbodies: [{name: bank, material: soil}]\ninitial: {from: first}\n"
            "time: {end: 1}\n");
  EXPECT_THAT(talus("check refused.yaml").err, HasSubstr("initial.from: the bodies there are of 2 dimensions, this scene has 3\n"));
  EXPECT_THAT(refusal(second("", "nowhere")), HasSubstr("refused.yaml:6:10: error: initial.from: nowhere is not there\n"));
  EXPECT_THAT(refusal(second("", "first.yaml")),
              HasSubstr("error: initial.from: first.yaml is not an HDF5 file, or its beginning is damaged\n"));
  fs::create_directory(folder_ / "empty");
  EXPECT_THAT(refusal(second("", "empty")), HasSubstr("empty has no checkpoints: the run is over, or was stopped before one was due; with "
                                                      "outputs.checkpoint.at_end it leaves one\n"));
  const Outcome outcome = run("first", second());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("first.yaml:6:10: error: initial"));
  EXPECT_THAT(outcome.err, HasSubstr(file + " is among the results in first, which this run replaces: choose another folder with --out\n"));
  EXPECT_FALSE(checkpoints("first").empty());
}

TEST_F(Initial, CheckpointsThatNoSoundRunHasWrittenAreRefused)
{
  run_well("first", {});
  const fs::path good = checkpoints("first").back(), file = folder_ / "forged.h5";
  const auto refused_as = [&](auto&& change) {
    fs::copy_file(good, file, fs::copy_options::overwrite_existing);
    change();
    return refusal(second("", "forged.h5"));
  };
  constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();
  for (const std::string column :
       {"all", "particles/id", "particles/position", "particles/velocity", "particles/velocity_gradient", "particles/deformation_gradient",
        "particles/stress", "particles/mass", "particles/volume0", "particles/volume"})
    EXPECT_THAT(refused_as([&] { forge_empty(file, column); }),
                testing::ContainsRegex("refused.yaml:6:10: error: initial.from: forged.h5: its (bodies|columns) do not fit the scene\n"))
        << column;
  EXPECT_THAT(refused_as([&] { forge_value(file, "bodies/count", 0, 0); }), HasSubstr("forged.h5: its bodies do not fit the scene\n"));
  const std::string who = "refused.yaml:6:10: error: initial.from: forged.h5: particle [0-9]+ of \"bank\" .*at \\(.*\\): ";
  for (const auto& [path, value, fault] :
       std::vector<std::tuple<std::string, Real, std::string>>{{"particles/velocity", nan, "velocity is not finite"},
                                                               {"particles/stress", nan, "stress is not finite"},
                                                               {"particles/mass", -1, "mass is -1 kg, not above 0"},
                                                               {"particles/volume", 0, "volume is 0 m\\^2, not above 0"},
                                                               {"particles/deformation_gradient", -1, "det F is -[0-9.e-]+, not above 0"},
                                                               {"laws/history/0/plastic_strain", nan, "plastic_strain is not finite"}}) {
    const std::string& at = path;
    const Real forged = value;
    EXPECT_THAT(refused_as([&] { forge_value(file, at, 0, forged); }), testing::ContainsRegex(who + fault)) << path;
  }
  EXPECT_THAT(refused_as([&] { forge_value(file, "clock/time", 0, nan); }), HasSubstr("forged.h5: clock/time is nan s"));
}

TEST_F(Initial, DisplacementMustHaveBeenKept)
{
  write("first.yaml", block_scene("time: {end: 0.01}\noutputs: {checkpoint: {at_end: true}}\n"));
  ASSERT_EQ(talus("run first.yaml --quiet --out first").code, 0);
  std::string scene = block_scene("time: {end: 0.01}\ninitial: {from: first, displacement: keep}\n");
  const auto from = scene.find(", shape"), to = scene.find("per_cell: 3") + 11;
  scene.erase(from, to - from);
  write("second.yaml", scene);
  EXPECT_THAT(
      talus("check second.yaml").err,
      HasSubstr("second.yaml:8:10: error: initial.displacement: the run there kept none: it wrote neither displacements nor points\n"));
}

TEST_F(Initial, GravityThatGrowsUnderStressIsWarnedOf)
{
  run_well("first", {});
  Bank bank = second();
  bank.when = "stages: [{type: geostatic, duration: 20, ramp: 0.1}]\n";
  write("second.yaml", bank.text());
  EXPECT_THAT(talus("check second.yaml").err,
              HasSubstr("warning: second.yaml:9:10: gravity grows from nothing (ramp) under bodies that carry "
                        "their stress already; without ramp they stay at rest\n"));
}

TEST_F(Initial, ADamagedStateGivesWayToTheOneBefore)
{
  run_well("first", {.when = "time: {end: 0.05}\n", .checkpoint = ", steps: 10"});
  const auto saved = checkpoints("first");
  ASSERT_GE(saved.size(), 2U);
  fs::resize_file(saved.back(), fs::file_size(saved.back()) / 2);
  const Outcome outcome = run("second", second());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("warning: second.yaml:6:10: first/checkpoints/" + saved.back().filename().string()));
  EXPECT_THAT(outcome.err, HasSubstr("; taking first/checkpoints/" + saved[saved.size() - 2].filename().string() + "\n"));
  EXPECT_THAT(origin("second"), HasSubstr("\"file\":\"" + saved[saved.size() - 2].string() + "\""));
  for (const auto& file : saved)
    fs::resize_file(file, 100);
  EXPECT_THAT(refusal(second()), HasSubstr("error: initial.from: first/checkpoints/"));
}

TEST_F(Initial, AStateOnTheWayIsWarnedOf)
{
  const std::string midst =
      ", before its stage was over: of a run on its way, stopped or failed, or one that did not keep its end; with "
      "outputs.checkpoint.at_end a run keeps it\n";
  run_well("first", {.when = "time: {end: 0.05}\n", .checkpoint = ", steps: 10, keep: 9"});
  auto saved = checkpoints("first");
  ASSERT_GE(saved.size(), 2U);
  fs::remove(saved.back());
  saved.pop_back();
  const Outcome outcome = run("second", second());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, testing::StartsWith("warning: second.yaml:6:10: first/checkpoints/" + saved.back().filename().string() +
                                               " is the state after step " + std::to_string(10 * saved.size()) + ", t = 0.0"));
  EXPECT_THAT(outcome.err, HasSubstr(midst));

  EXPECT_EQ(run("failed", {.more = "watch: {speed: 1.0e-4}\n", .when = "time: {end: 0.05}\n"}).code, 1);
  const Outcome of_failed = run("second", second("", "failed"));
  EXPECT_EQ(of_failed.code, 0) << of_failed.err;
  EXPECT_THAT(of_failed.err, HasSubstr(midst));
}

TEST_F(Initial, TheEndOfAStageThatIsNotTheLastIsAnEndToo)
{
  run_well("short", {.when = "stages: [{type: run, duration: 0.02}]\n"});
  const std::string steps = checkpoints("short").back().stem().string().substr(5);
  write("first.yaml", Bank{.when = "stages: [{type: run, duration: 0.02}, {type: run, duration: 0.02}]\n"}.text());
  ASSERT_EQ(talus("run first.yaml --quiet --out first --until " + std::to_string(std::stoi(steps))).code, 4);
  run_well("second", second());
}

TEST_F(Initial, QuickRunsOfSuchScenesRun)
{
  run_well("first", {}, "--quick");
  const Outcome outcome = run("second", second(), "--quick");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("was left by a quick run, coarse and short\n"));
}

/// The run keeps what it began with, so that the run it came from may go.
TEST_F(Initial, SuchARunGoesOnWithTheSameBitsWithoutTheOther)
{
  run_well("first", {});
  Bank bank = second();
  bank.checkpoint = ", steps: 10, keep: 1000";
  run_well("second", bank);
  fs::rename(folder_ / "second", folder_ / "whole");
  run_well("second", bank);
  fs::remove_all(folder_ / "first");
  const auto saved = checkpoints("second");
  ASSERT_GE(saved.size(), 3U);
  for (std::size_t i = saved.size() / 2; i < saved.size(); ++i)
    fs::remove(saved[i]);
  const Outcome outcome = talus("run --quiet --resume second");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(without_losses(outcome.err), "");
  for (const auto& entry : fs::directory_iterator(folder_ / "whole"))
    if (const fs::path name = entry.path().filename(); entry.is_regular_file() && name != "summary.json") {
      EXPECT_TRUE(read_whole(entry.path()) == read_whole(folder_ / "second" / name)) << name;
    }
  for (const auto& file : checkpoints("whole"))
    for (const auto& [path, columns] : std::vector<std::pair<std::string, int>>{{"particles/position", 2}, {"particles/stress", 6}})
      EXPECT_EQ(by_id(file, path, columns), by_id(folder_ / "second/checkpoints" / file.filename(), path, columns));
  EXPECT_EQ(origin("second"), origin("whole"));
  EXPECT_NE(origin("whole"), "");
  fs::remove(folder_ / "second/initial.h5");
  const Outcome lost = talus("run --quiet --resume second");
  EXPECT_EQ(lost.code, 3);
  EXPECT_THAT(lost.err, HasSubstr("initial.h5 is not there: the state that the run began with, which it needs to go on"));
}

TEST_F(Initial, ARunThatIsOverHasNothingLeftToDo)
{
  Bank bank;
  bank.when = "stages: [{type: run, duration: 0.02}, {type: geostatic, duration: 20, damping: 0.8}]\n";
  run_well("first", bank);
  fs::copy(folder_ / "first", folder_ / "again", fs::copy_options::recursive);
  const Outcome outcome = talus("run --resume again");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("nothing is left to do: the run was over after step "));
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "first"))
    if (const fs::path name = entry.path().lexically_relative(folder_ / "first");
        entry.is_regular_file() && name != "summary.json" && *name.begin() != ".talus") {
      EXPECT_TRUE(read_whole(entry.path()) == read_whole(folder_ / "again" / name)) << name;
    }
  const std::string begin = "{", cost = "\"cost\":", balances = "\"balances\":", file = "\"scene\":{\"file\"";
  EXPECT_EQ(part("first", begin, cost), part("again", begin, cost));
  EXPECT_EQ(part("first", balances, file), part("again", balances, file));
}

}  // namespace
}  // namespace talus::initial_test
