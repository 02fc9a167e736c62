#include <gmock/gmock.h>

#include "tests/app/program.hpp"

namespace talus {

namespace {

using testing::HasSubstr;

class CommandLine : public Program {};

TEST_F(CommandLine, WrongWordsEndWithTwo)
{
  EXPECT_EQ(talus("").code, 2);
  EXPECT_EQ(talus("rum scene.yaml").code, 2);
  EXPECT_EQ(talus("run").code, 2);
  EXPECT_EQ(talus("run scene.yaml --threads 0").code, 2);
  EXPECT_EQ(talus("run missing.yaml").code, 2);
}

TEST_F(CommandLine, HelpAndVersionEndWithZero)
{
  EXPECT_EQ(talus("--help").code, 0);
  EXPECT_THAT(talus("run --help").out, HasSubstr("--quick"));
  EXPECT_THAT(talus("--version").out, testing::StartsWith("talus "));
}

TEST_F(CommandLine, InfoNamesLawsKernelsAndLicence)
{
  const Outcome outcome = talus("info");
  EXPECT_EQ(outcome.code, 0);
  for (const char* word : {"neo_hookean", "umls", "GNU General Public", "Apache"})
    EXPECT_THAT(outcome.out, HasSubstr(word));
}

TEST_F(CommandLine, ManualDescribesEveryBlock)
{
  const Outcome outcome = talus("manual");
  EXPECT_EQ(outcome.code, 0);
  for (const char* word : {"particles_per_cell", "geostatic", "mass_share", "drucker_prager"})
    EXPECT_THAT(outcome.out, HasSubstr(word));
}

TEST_F(CommandLine, MeshShowsGroupsAndWritesAMeshThatReadsBack)
{
  write("block.yaml", block_scene("time: {end: 0.1}\n"));
  const Outcome made = talus("mesh block.yaml --out block.msh");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.out, testing::ContainsRegex("x_max +8 facets"));
  EXPECT_THAT(made.out, testing::ContainsRegex("all +128 cells"));
  const Outcome read_back = talus("mesh block.msh");
  ASSERT_EQ(read_back.code, 0) << read_back.err;
  EXPECT_THAT(read_back.out, testing::ContainsRegex("x_max +8 facets"));
}

TEST_F(CommandLine, DriveStretchesAPointAsTheLawSays)
{
  write("test.yaml", R"yaml(material: {law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0}
path:
  - {steps: 10, time: 1, controls: {xx: {quantity: strain_rate, value: 0.1}}}
)yaml");
  const Outcome outcome = talus("drive test.yaml --out table.csv");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const HistoryTable table = read_history(folder_ / "table.csv");
  EXPECT_EQ(table.rows(), 11u);
  const Real F = last(table, "F_xx");
  EXPECT_GT(F, 1.1);
  // J sigma = mu (F F^T - I) with lambda = 0
  EXPECT_NEAR(last(table, "stress_xx"), 0.5e5 * (F * F - 1) / F, 1e-6 * 1e5);
}

TEST_F(CommandLine, RenderNeedsResults)
{
  const Outcome outcome = talus("render nowhere");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.err, "error: nowhere holds no results of a run (no summary.json)\n");
}

}  // namespace

}  // namespace talus
