// Files that are none, folders that lead elsewhere, and scenes that ask for more than there is.
#include <gmock/gmock.h>

#include <unistd.h>

#include "tests/app/program.hpp"

namespace talus::hostile_test {
namespace {

using testing::HasSubstr;

class Hostile : public Program {
 protected:
  Hostile()
  {
    write("scene.yaml", block_scene("time: {end: 0.01}\noutputs: {checkpoint: {steps: 1}}\n"));
    shell("mkfifo pipe.msh; ln -s loop.msh other.msh; ln -s other.msh loop.msh; ln -s /dev/zero zeros.msh; mkdir folder.msh");
  }
  void shell(const std::string& command) const
  {
    ASSERT_EQ(std::system(("cd '" + folder_.path().string() + "' && " + command).c_str()), 0);
  }
  void expect_refused(const std::string& words, int code, const std::string& message) const
  {
    const Outcome outcome = talus(words);
    EXPECT_EQ(outcome.code, code) << words << "\n" << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(message)) << words;
  }
  /// Of a block whose body moves like this.
  void expect_refused_velocity(const std::string& formula, const std::string& message) const
  {
    write("moving.yaml", block_scene("time: {end: 1}\n", ", velocity: [\"" + formula + "\", \"0\"]"));
    expect_refused("check moving.yaml", 2, "bodies[0] \"block\".velocity[0]: " + message);
    EXPECT_LT(read("err.txt").size(), 1000U) << "a message is to be read";
  }
};

TEST_F(Hostile, FilesThatAreNoneAreRefused)
{
  for (const auto& [file, why] : std::map<std::string, std::string>{{"pipe.msh", "is not an ordinary file"},
                                                                    {"zeros.msh", "is not an ordinary file"},
                                                                    {"folder.msh", "is a folder"},
                                                                    {"loop.msh", "cannot be read: Too many levels of symbolic links"}}) {
    expect_refused("mesh " + file, 2, "mesh file \"" + file + "\" " + why);
    shell("ln -sf " + file + " shape.geo");
    write("shape.yaml",
          "title: a\ndimension: 2\nmesh: {geometry: shape.geo, size: 1}\ntime: {end: 1}\n"
          "materials: [{name: a, law: neo_hookean, density: 1, youngs_modulus: 1, poisson_ratio: 0}]\n"
          "bodies: [{name: a, material: a, region: all}]\n");
    expect_refused("check shape.yaml", 2, "shape.yaml:3:7: error: mesh: geometry \"shape.geo\" " + why);
    shell("rm -rf shape.geo");
  }
  for (const std::string file : {"pipe.msh", "zeros.msh"}) {
    expect_refused("check " + file, 2, file + ": error: this is not an ordinary file");
    expect_refused("run --resume " + file, 3, "cannot read " + file + ": it is not an ordinary file");
  }
  expect_refused("run --resume loop.msh", 3, "loop.msh is not there");
}

TEST_F(Hostile, FoldersThatCannotBeMadeAreNamed)
{
  expect_refused("run scene.yaml --out loop.msh", 3, "loop.msh cannot be made: Too many levels of symbolic links");
  expect_refused("run scene.yaml --out scene.yaml", 3, "scene.yaml cannot be made: Not a directory");
  expect_refused("run scene.yaml --out scene.yaml/in", 3, "scene.yaml/in cannot be made: Not a directory");
}

TEST_F(Hostile, ResultsAreNotPutWhereAnotherRunRemovesThem)
{
  ASSERT_EQ(talus("run scene.yaml --quiet --out out").code, 0);
  for (const std::string inside : {"out/checkpoints/again", "out/pictures/a/b", "out/../out/pictures"})
    expect_refused("run scene.yaml --quiet --out " + inside, 3, "where another run has its own files: choose another folder");
  EXPECT_EQ(talus("run scene.yaml --quiet --out checkpoints/mine").code, 0) << "no run has this folder";
}

TEST_F(Hostile, FormulasThatMeanSomethingElseAreRefused)
{
  expect_refused_velocity("0,5", "\"0,5\" is no formula of x, y, z and t: it has 2 values; decimals are written with a point");
  expect_refused_velocity("x = 5", "\"x = 5\" is no formula of x, y, z and t: it cannot assign; == compares");
  std::string deep(10001, 'x');
  deep.replace(0, 5000, 5000, '(').replace(5001, 5000, 5000, ')');
  expect_refused_velocity(deep, "this long text is no formula of x, y, z and t: it has more than");
  write("compares.yaml", block_scene("time: {end: 1}\n", ", velocity: [\"(x == 1) + (x <= 1) + (x >= 1) + (x != 1)\", \"0\"]"));
  EXPECT_EQ(talus("check compares.yaml").code, 0);
}

TEST_F(Hostile, MoreThanTheMemoryHoldsIsRefusedBeforeItIsTaken)
{
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "its shadow takes more addresses than the limit leaves";
#endif
  const auto with = [](const std::string& cells, const std::string& particles) {
    std::string text = block_scene("time: {end: 1}\n");
    text.replace(text.find("8, 8"), 4, cells);
    text.replace(text.find("per_cell: 3"), 11, "per_cell: " + particles);
    return text;
  };
  write("cells.yaml", with("5000, 5000", "3"));
  write("particles.yaml", with("400, 400", "100"));
  for (const auto& [file, message] : std::map<std::string, std::string>{
           {"cells.yaml", "cells.yaml:3:7: error: mesh: grid.cells asks for 5e+07 cells, which need at least 5.6 GB of memory; "},
           {"particles.yaml",
            "particles.yaml:6:5: error: bodies[0] \"block\".particles_per_cell: asks for 8e+06 particles, which need "}}) {
    shell("(ulimit -v 1400000; '" TALUS_BINARY "' check " + file + " 2>limited.txt; [ $? = 2 ])");
    EXPECT_THAT(read("limited.txt"), HasSubstr(message));
  }
}

}  // namespace
}  // namespace talus::hostile_test
