// Whose files are in a folder of results: those of runs are replaced, those of the user never.
#include <gmock/gmock.h>

#include <map>

#include "tests/app/program.hpp"
#include "tests/app/same_state.hpp"

namespace talus::own_files_test {

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Every file below a folder, and what is in it.  What Talus keeps for itself is left out.
std::map<std::string, std::string> tree(const fs::path& folder)
{
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (name.starts_with(".talus"))
      continue;
    files[name] = entry.is_symlink()        ? "link to " + fs::read_symlink(entry.path()).string()
                  : entry.is_regular_file() ? read_whole(entry.path())
                                            : "";
  }
  return files;
}

class OwnFiles : public Program {
 protected:
  void SetUp() override { write("scene.yaml", scene()); }
  static std::string scene(const std::string& more = "")
  {
    return block_scene(
        "loads: [{type: gravity, acceleration: [0, -9.81]}]\nboundaries: [{type: fixed, on: y_min}]\n"
        "time: {end: 0.02, max_step: 2.0e-3}\noutputs: {particles: {every: 0.01}, history: {every: 0.01}, checkpoint: {steps: 4}}\n" +
        more);
  }
  Outcome run(const std::string& words = "scene.yaml --out out") const { return talus("run --quiet --threads 1 " + words); }
  void run_to_its_end(const std::string& words = "scene.yaml --out out") const
  {
    const Outcome outcome = run(words);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  /// Refused, in these words, and nothing is touched.
  void expect_refused(const std::string& why, const std::string& words = "scene.yaml --out out") const
  {
    const auto before = tree(folder_ / "out");
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(why));
    EXPECT_EQ(tree(folder_ / "out"), before);
  }
  void shell(const std::string& command) const
  {
    ASSERT_EQ(std::system(("cd '" + folder_.path().string() + "' && " + command).c_str()), 0) << command;
  }
};

TEST_F(OwnFiles, ARepeatedRunReplacesItsOwnFilesAndNoOthers)
{
  run_to_its_end();
  shell("mkdir -p out/pictures out/maps out/sections out/analysis; touch out/runout_notes.csv");
  const std::map<std::string, std::string> mine{{"notes.txt", "a"},
                                                {"pictures/holiday.png", "b"},
                                                {"checkpoints/mine.h5", "c"},
                                                {"checkpoints/step_000000099.h5.bak", "d"},
                                                {"maps/x.qgz", "e"},
                                                {"sections/notes.txt", "f"},
                                                {"analysis/plot.py", "g"},
                                                {"report.html", "h"},
                                                {"particles_0003_edited.vtp", "i"},
                                                {"history_backup.csv", "j"},
                                                {"particles_0001.vtp.tmp.mine", "k"}};
  for (const auto& [name, text] : mine)
    write("out/" + name, text);
  run_to_its_end("scene.yaml --out out --set time.end=0.01");
  for (const auto& [name, text] : mine)
    EXPECT_EQ(read("out/" + name), text) << name;
  EXPECT_TRUE(exists("out/particles_0001.vtp"));
  EXPECT_FALSE(exists("out/particles_0002.vtp")) << "it was the earlier run's";
  EXPECT_THAT(read("out/scene.yaml"), HasSubstr("time.end=0.01"));
  EXPECT_FALSE(exists("out/.talus/new"));
}

TEST_F(OwnFiles, ASummaryOfAnotherHandIsNoLicence)
{
  shell(
      "mkdir -p out/pictures out/checkpoints out/maps; echo '{\"mine\": 1}' >out/summary.json; echo x >out/pictures/holiday.png; "
      "echo y >out/checkpoints/x.h5; echo z >out/maps/x.tif; echo page >out/report.html");
  expect_refused("out holds a summary.json but no list of what a run wrote there");
  shell("rm out/summary.json");
  expect_refused("out is not empty and holds no results of an earlier run");
}

TEST_F(OwnFiles, WhatARunWouldReplaceAndNoRunWroteIsNamed)
{
  run_to_its_end();
  const auto check = [&](const std::string& damage, const std::string& name) {
    SCOPED_TRACE(damage);
    shell("cp -a out kept; " + damage);
    expect_refused("out holds " + name + ", which no run wrote or which changed since: a run would replace it. Move it away");
    shell("rm -r out; mv kept out");
  };
  check("echo 'my note' >>out/history.csv", "history.csv");
  check("echo x >out/particles_0009.vtp", "particles_0009.vtp");
  check("echo x >>out/scene.yaml", "scene.yaml");
  check("mkdir -p mine; echo x >mine/mesh; ln -sf ../mine/mesh out/mesh.msh", "mesh.msh");
  check("echo x >out/checkpoints/step_000000099.h5", "checkpoints/step_000000099.h5");
  check("mkdir out/particles_0007.vtp", "particles_0007.vtp");
  check("echo x >out/maps", "maps");
  check("mkdir out/sections; echo x >out/sections/axis.csv", "sections/axis.csv");
  check("printf X | dd of=out/mesh.msh bs=1 seek=9 conv=notrunc 2>/dev/null", "mesh.msh");
  run_to_its_end();
}

TEST_F(OwnFiles, ACopyOfAFolderIsKnownByItsDigests)
{
  run_to_its_end();
  shell("cp -r out copy; touch -d '2020-01-01' copy/*");
  run_to_its_end("scene.yaml --out copy");
  shell("touch -d '2020-01-01' copy/mesh.vtu; sed -i 's/0/1/' copy/mesh.msh; touch -d '2020-01-01' copy/mesh.msh");
  EXPECT_EQ(run("scene.yaml --out copy").code, 3) << "of the same length and another time";
}

TEST_F(OwnFiles, ASceneIsRunInTheFolderOfItsOwnResults)
{
  run_to_its_end();
  std::string mine = scene("# mine\n");
  write("out/scene.yaml", mine);
  run_to_its_end("out/scene.yaml --out out");
  EXPECT_EQ(read("out/scene.yaml"), mine);
  run_to_its_end("out/scene.yaml --out out --set time.end=0.01");
  EXPECT_EQ(read("out/scene.yaml"), mine);
  EXPECT_THAT(read("out/summary.json"), HasSubstr("time.end=0.01"));
  expect_refused("out holds scene.yaml, which no run wrote");
  run_to_its_end("scene.yaml --out own");
  run_to_its_end("own/scene.yaml --out own");
  run_to_its_end("scene.yaml --out own --set time.end=0.01");
}

TEST_F(OwnFiles, ARunThatCouldGoOnIsReplacedOnlyByForce)
{
  ASSERT_EQ(run("scene.yaml --out out --until 5").code, 4);
  const std::string why =
      "out holds a run that did not come to its end and can go on from step_000000005.h5: talus run --resume out; to "
      "throw it away, --force";
  expect_refused(why);
  shell("cp -r out killed; sed -i 's/\"status\": \"stopped\"/\"status\": \"failed\"/' killed/summary.json; rm killed/summary.json");
  EXPECT_THAT(run("scene.yaml --out killed").err, HasSubstr("can go on from step_000000005.h5"));
  run_to_its_end("scene.yaml --out out --force");
  EXPECT_THAT(read("out/summary.json"), HasSubstr("\"status\": \"done\""));
  run_to_its_end();
}

TEST_F(OwnFiles, AFailedRunWithItsCheckpointToo)
{
  write("leaves.yaml", block_scene("time: {end: 2}\noutputs: {checkpoint: {steps: 5}}\n", ", velocity: [2, 0]"));
  ASSERT_EQ(run("leaves.yaml --out out").code, 1);
  expect_refused("can go on from", "leaves.yaml --out out");
}

TEST_F(OwnFiles, AnEditOfTheSceneIsIgnoredAloudWhenARunGoesOn)
{
  ASSERT_EQ(run("scene.yaml --out out --until 5").code, 4);
  const std::string edited = scene("# softer\n");
  write("scene.yaml", edited);
  write("out/scene.yaml", edited);
  const Outcome on = run("--resume out");
  ASSERT_EQ(on.code, 0) << on.err;
  EXPECT_THAT(on.err, HasSubstr("scene.yaml was edited since the run began: that is ignored"));
  EXPECT_THAT(on.err, HasSubstr("warning: out/scene.yaml was edited since the run began"));
  EXPECT_THAT(read("out/summary.json"), HasSubstr("out/scene.yaml was edited since the run began"));
  EXPECT_EQ(read("out/scene.yaml"), edited);
}

TEST_F(OwnFiles, AChangeByTheCommandLineIsNoEdit)
{
  ASSERT_EQ(run("scene.yaml --out out --until 5 --set time.cfl=0.3").code, 4);
  const Outcome on = run("--resume out --set time.end=0.015");
  ASSERT_EQ(on.code, 0) << on.err;
  EXPECT_EQ(on.err, "");
  EXPECT_THAT(read("out/scene.yaml"), testing::AllOf(HasSubstr("time.cfl=0.3"), HasSubstr("time.end=0.015")));
  run_to_its_end();
}

TEST_F(OwnFiles, WhatStandsInTheWayOfARunThatGoesOnIsSetAside)
{
  run_to_its_end("scene.yaml --out whole");
  ASSERT_EQ(run("scene.yaml --out out --until 5").code, 4);
  write("out/particles_0002.vtp", "mine");
  const Outcome on = run("--resume out");
  ASSERT_EQ(on.code, 0) << on.err;
  EXPECT_THAT(on.err, HasSubstr("out/particles_0002.vtp was there, and Talus did not write it or it was changed since: its name is now "
                                "particles_0002.vtp.aside"));
  EXPECT_EQ(read("out/particles_0002.vtp.aside"), "mine");
  EXPECT_TRUE(read("out/particles_0002.vtp") == read("whole/particles_0002.vtp"));
}

TEST_F(OwnFiles, AFolderOfAVersionThatKeptNoListGoesOn)
{
  run_to_its_end("scene.yaml --out whole");
  ASSERT_EQ(run("scene.yaml --out out --until 5").code, 4);
  fs::remove_all(folder_ / "out/.talus");
  const Outcome on = run("--resume out");
  ASSERT_EQ(on.code, 0) << on.err;
  EXPECT_EQ(on.err, "");
  EXPECT_EQ(files_in(folder_ / "out", ".aside").size(), 0U);
  expect_same_results(folder_ / "whole", folder_ / "out");
}

TEST_F(OwnFiles, PagesAndPicturesAreSetAsideAndDrawnAnew)
{
  run_to_its_end();
  write("out/report.html", "my page");
  write("page.html", "<html>\n<!--TALUS-RUN-->\n</html>\n");
  const Outcome page = talus("report out --page page.html");
  ASSERT_EQ(page.code, 0) << page.err;
  EXPECT_EQ(read("out/report.html.aside"), "my page");
  ASSERT_EQ(talus("report out --page page.html").code, 0);
  EXPECT_FALSE(exists("out/report.html.aside.2")) << "the page is Talus's own now";
  ASSERT_EQ(talus("render out --size 300x200").code, 0) << read("err.txt");
  const auto pictures = files_in(folder_ / "out/pictures", ".png");
  ASSERT_FALSE(pictures.empty());
  run_to_its_end();
  EXPECT_FALSE(exists("out/report.html")) << "of results that are not there any more";
  EXPECT_FALSE(exists("out/pictures"));
}

TEST_F(OwnFiles, NoRankReplacesThem)
{
  run_to_its_end();
  write("out/particles_0009.vtp", "mine");
  const std::string ranks = launcher_of(2);
  const Outcome refused = talus("run --quiet --threads 1 scene.yaml --out out", ranks);
  EXPECT_EQ(refused.code, 3);
  EXPECT_THAT(refused.err, HasSubstr("out holds particles_0009.vtp, which no run wrote"));
  EXPECT_EQ(read("out/particles_0009.vtp"), "mine");
  fs::remove(folder_ / "out/particles_0009.vtp");
  ASSERT_EQ(talus("run --quiet --threads 1 scene.yaml --out out", ranks).code, 0) << read("err.txt");
  run_to_its_end();
}

}  // namespace
}  // namespace talus::own_files_test
