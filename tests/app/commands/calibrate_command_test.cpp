// talus calibrate, with a package that only says what it was asked.
#include <gmock/gmock.h>

#include "tests/app/program.hpp"

namespace talus::calibrate_test {

namespace {

using testing::HasSubstr;

class Calibrate : public Program {
 protected:
  Calibrate()
  {
    std::filesystem::create_directories(folder_ / "talus");
    write("talus/__init__.py", "");
    write("talus/__main__.py", "import sys\nprint(' '.join(sys.argv[1:]))\nsys.exit(7)\n");
  }
  /// With the package in the scratch folder.
  Outcome calibrate(const std::string& words) const
  {
    ::setenv("TALUS_PACKAGE", folder_.path().c_str(), 1);
    Outcome outcome = talus("calibrate " + words);
    ::unsetenv("TALUS_PACKAGE");
    return outcome;
  }
};

TEST_F(Calibrate, IsGivenTheProgramAndTheOptionsAndItsStatusIsThatOfTheProgram)
{
  const Outcome outcome = calibrate("'a b.yaml' --out c --jobs 2 --threads 3 --no-pictures --quiet");
  EXPECT_EQ(outcome.code, 7) << outcome.err;
  EXPECT_THAT(outcome.out, testing::StartsWith("calibrate --program /"));
  EXPECT_THAT(outcome.out, testing::EndsWith("talus a b.yaml --out=c --jobs=2 --threads=3 --no-pictures --quiet\n"));
}

TEST_F(Calibrate, LeavesOutOptionsThatAreNotGiven) { EXPECT_THAT(calibrate("a.yaml").out, testing::EndsWith("talus a.yaml\n")); }

TEST_F(Calibrate, WrongWordsEndWithTwo)
{
  EXPECT_EQ(calibrate("").code, 2);
  EXPECT_EQ(calibrate("a.yaml --jobs 0").code, 2);
}

TEST_F(Calibrate, SaysWhereItLookedForAPackageThatIsMissing)
{
  std::filesystem::remove(folder_ / "talus/__main__.py");
  const Outcome outcome = calibrate("a.yaml");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.err, "error: TALUS_PACKAGE is " + folder_.path().string() + ", where there is no talus/__main__.py\n");
}

TEST_F(Calibrate, OfTheSourcesIsFoundWithoutBeingNamed)
{
  const Outcome outcome = talus("calibrate no_such_file.yaml");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("no_such_file.yaml"));
}

}  // namespace

}  // namespace talus::calibrate_test
