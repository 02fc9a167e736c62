// talus verify and talus tradeoff, with a suite that only says what it was asked.
#include <gmock/gmock.h>

#include "tests/app/program.hpp"

namespace talus::suite_test {

namespace {

using testing::HasSubstr;

class Suite : public Program {
 protected:
  Suite()
  {
    for (const char* script : {"verify.py", "tradeoff.py"})
      write(script, "import sys\nprint(' '.join(sys.argv[1:]))\nsys.exit(7)\n");
  }
  /// With the suite in the scratch folder.
  Outcome suite(const std::string& words) const
  {
    ::setenv("TALUS_SUITE", folder_.path().c_str(), 1);
    Outcome outcome = talus(words);
    ::unsetenv("TALUS_SUITE");
    return outcome;
  }
};

TEST_F(Suite, IsGivenTheProgramAndTheOptionsAndItsStatusIsThatOfTheProgram)
{
  const Outcome outcome = suite("verify shock --level full --kernel linear --transfer apic --out 'a b' --jobs 2 --reuse");
  EXPECT_EQ(outcome.code, 7) << outcome.err;
  EXPECT_THAT(outcome.out, testing::EndsWith("talus --level full --kernel linear --transfer apic --out a b --jobs 2 --reuse shock\n"));
  EXPECT_THAT(outcome.out, testing::StartsWith("--program /"));
}

TEST_F(Suite, TakesAllCasesWhenNoneIsNamed)
{
  EXPECT_THAT(suite("verify").out, testing::EndsWith("talus\n"));
  EXPECT_THAT(suite("tradeoff cantilever").out, testing::EndsWith("talus cantilever\n"));
}

TEST_F(Suite, WrongWordsEndWithTwo)
{
  EXPECT_EQ(suite("tradeoff").code, 2);
  EXPECT_EQ(suite("tradeoff cantilever shock").code, 2);
  EXPECT_EQ(suite("verify --level medium").code, 2);
  EXPECT_EQ(suite("verify --jobs 0").code, 2);
}

TEST_F(Suite, SaysWhereItLookedForScriptsThatAreMissing)
{
  std::filesystem::remove(folder_ / "verify.py");
  const Outcome outcome = suite("verify");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.err, "error: TALUS_SUITE is " + folder_.path().string() + ", where there is no verify.py\n");
}

TEST_F(Suite, OfTheSourcesIsFoundWithoutBeingNamed)
{
  const Outcome outcome = talus("verify no_such_case");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("no case no_such_case; there are: "), HasSubstr("vibrating_bar")));
}

}  // namespace

}  // namespace talus::suite_test
