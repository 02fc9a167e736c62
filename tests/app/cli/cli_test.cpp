#include <gmock/gmock.h>

#include "tests/app/program.hpp"

namespace talus::cli_test {

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

TEST_F(CommandLine, DriveTestsAMaterialOfASceneBesideItsClosedForms)
{
  write("block.yaml", block_scene("time: {end: 0.1}\n"));
  const std::string soil =
      " --set 'materials[0]={name: sand, law: drucker_prager, density: 2000, youngs_modulus: 1.0e8, poisson_ratio: 0.3, "
      "friction_angle: 30, cohesion: 0, match: outer}' --set bodies[0].material=sand";
  const Outcome outcome = talus("drive block.yaml --test triaxial_compression --pressure 2e5 --steps 100 --plot sand.png" + soil);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("triaxial_compression of \"sand\" (drucker_prager): pressure 200000 Pa, strain 0.2"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("closed form: Mohr-Coulomb +400 "));  // 2 p sin / (1 - sin)
  EXPECT_THAT(outcome.out,
              testing::ContainsRegex("closed form: Drucker-Prager inner +240 "));  // 3 (2 p sin) / (3 + sin), by slope 6 sin / (3 + sin)
  const HistoryTable table = read_history(folder_ / "sand.csv");
  EXPECT_EQ(table.rows(), 101u);
  EXPECT_NEAR(last(table, "stress_difference"), 4e5, 1e-3 * 4e5);
  EXPECT_EQ(read("sand.png").substr(1, 3), "PNG");
}

TEST_F(CommandLine, DriveNamesTheTestsAndMaterialsThereAre)
{
  write("block.yaml", block_scene("time: {end: 0.1}\n"));
  const Outcome test = talus("drive block.yaml --test oedometr");
  EXPECT_EQ(test.code, 2);
  EXPECT_THAT(test.err, HasSubstr("did you mean \"oedometer\"?"));
  const Outcome material = talus("drive block.yaml --test oedometer --material ruber");
  EXPECT_EQ(material.code, 2);
  EXPECT_THAT(material.err, HasSubstr("did you mean \"rubber\"?"));
  EXPECT_EQ(talus("drive block.yaml --strain 0.1").code, 2) << "--strain belongs to a test";
  const Outcome many = talus(
      "drive block.yaml --test oedometer --set 'materials=[{name: rubber, law: neo_hookean, density: 1000, "
      "youngs_modulus: 1.0e5, poisson_ratio: 0.3}, {name: water, law: newtonian, density: 1000, bulk_modulus: 1.0e6, viscosity: 1}]'");
  EXPECT_EQ(many.code, 2);
  EXPECT_THAT(many.err, HasSubstr("--material is needed where there are several: rubber or water"));
}

TEST_F(CommandLine, MoviesAndSurfacesComeFromTheResultsOfARun)
{
  write("block.yaml", block_scene("time: {end: 0.02}\noutputs: {particles: {every: 0.01, fields: [velocity]}}\n", ", velocity: [1, 0]"));
  ASSERT_EQ(talus("run block.yaml --out block --quiet").code, 0);
  const Outcome surface = talus("surface block --body block --out block.obj");
  EXPECT_EQ(surface.code, 0) << surface.err;
  EXPECT_THAT(surface.out, testing::ContainsRegex("^block.obj\n  block: .* segments, .* encloses .* particles have 1 m.2 "));
  const Outcome movie = talus("render block --movie block.gif --fps 5 --size 400x300");
  EXPECT_EQ(movie.code, 0) << movie.err;
  EXPECT_EQ(movie.out, "block.gif\n");
  EXPECT_EQ(read("block.gif").substr(0, 3), "GIF");
  EXPECT_FALSE(exists("block.gif.frames"));
  EXPECT_FALSE(exists("block/pictures"));

  const Outcome pictures = talus("render block --field velocty --view front --frames 9 --map virids");
  EXPECT_EQ(pictures.code, 2);
  EXPECT_THAT(pictures.err, testing::AllOf(HasSubstr("did you mean \"velocity\"?"), HasSubstr("--view: the run is 2-D"),
                                           HasSubstr("there is no frame 9"), HasSubstr("did you mean \"viridis\"?")));
  const Outcome both = talus("render block --movie block.avi --out frames");
  EXPECT_EQ(both.code, 2);
  EXPECT_THAT(both.err, testing::AllOf(HasSubstr("should end in .mp4 or .gif"), HasSubstr("--keep-frames")));
  const Outcome body = talus("surface block --body blok --out block.stl");
  EXPECT_EQ(body.code, 2);
  EXPECT_THAT(body.err, testing::AllOf(HasSubstr("did you mean \"block\"?"), HasSubstr(".stl knows no lines")));
}

TEST_F(CommandLine, RenderNeedsResults)
{
  const Outcome outcome = talus("render nowhere");
  EXPECT_EQ(outcome.code, 2) << "as report, watch and diff say it";
  EXPECT_EQ(outcome.err, "error: nowhere holds no results of a run (no summary.json)\n");
}

TEST_F(CommandLine, AMistypedCommandIsToldWhichWasMeant)
{
  const Outcome outcome = talus("rnder out");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "error: there is no command \"rnder\" — did you mean \"render\"?\n");
}

/// What was printed and has not arrived is an error; nothing else of the command is.
TEST_F(CommandLine, AFullStandardOutputIsSaid)
{
  write("block.yaml", block_scene("time: {end: 0.01}\n"));
  for (const std::string words :
       {"info", "check block.yaml", "manual", "--version", "--help", "run block.yaml --out out", "completion bash"}) {
    const int status =
        std::system(("cd '" + folder_.path().string() + "' && '" TALUS_BINARY "' " + words + " >/dev/full 2>err.txt").c_str());
    EXPECT_EQ(WEXITSTATUS(status), 3) << words;
    EXPECT_THAT(read("err.txt"), testing::HasSubstr("error: cannot write to ")) << words;
  }
  EXPECT_THAT(read("out/summary.json"), testing::HasSubstr("\"status\": \"done\"")) << "the run itself went well";
}

TEST_F(CommandLine, ClosedStreamsTakeNoFileForTheirs)
{
  write("block.yaml", block_scene("time: {end: 0.01}\noutputs: {history: {every: 0.001}}\n"));
  ASSERT_EQ(talus("run block.yaml --out open").code, 0);
  const int status =
      std::system(("cd '" + folder_.path().string() + "' && '" TALUS_BINARY "' run block.yaml --out closed <&- >&- 2>&-").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(read("closed/history.csv"), read("open/history.csv"));
}

TEST_F(CommandLine, NumbersThatAreNoneAreRefusedInShortWords)
{
  write("block.yaml", block_scene("time: {end: 0.01}\n"));
  for (const auto& [words, why] : std::map<std::string, std::string>{
           {"watch out --interval nan", "--interval: nan is no number that can be taken"},
           {"watch out --interval 0", "--interval: 0 is not between 0.1 and 3600"},
           {"run block.yaml --until 99999999999999999999", "--until: 99999999999999999999 is more than 1e18"},
           {"run block.yaml --until -1", "--until: -1 is below 0"},
           {"run block.yaml --until 1e999", "--until: 1e999 is no number that can be taken"},
           {"report out --size -5", "--size: -5 is not above 0"},
           {"run block.yaml --threads 0", "--threads: 0 is not between 1 and 1024"}}) {
    const Outcome outcome = talus(words);
    EXPECT_EQ(outcome.code, 2) << words;
    EXPECT_THAT(outcome.err, testing::HasSubstr(why)) << words;
    EXPECT_LT(outcome.err.size(), 250U) << words;
  }
  EXPECT_THAT(talus("mesh /dev/zero").err, testing::HasSubstr("\"/dev/zero\" is not an ordinary file"));
}

TEST_F(CommandLine, ThreadsAreBoundedByTheMachine)
{
  write("block.yaml", block_scene("time: {end: 0.002}\nthreads: 100000\n"));
  const Outcome scene = talus("run block.yaml --quiet --out a");
  EXPECT_EQ(scene.code, 0) << scene.err;
  EXPECT_THAT(scene.err, testing::HasSubstr("warning: threads in block.yaml asks for 100000 threads, of which "));
  const Outcome option = talus("run block.yaml --quiet --out b --threads 1024");
  EXPECT_EQ(option.code, 0) << option.err;
  EXPECT_THAT(option.err, testing::HasSubstr("warning: --threads asks for 1024 threads, of which "));
  const Outcome environment = talus("check block.yaml", "OMP_NUM_THREADS=100000");
  EXPECT_EQ(environment.code, 0) << environment.err;
  EXPECT_THAT(environment.err, testing::HasSubstr("OMP_NUM_THREADS asks for 100000 threads"));
}

TEST_F(CommandLine, CountsThatNoIntegerHoldsAreMoreThanAnyoneWaitsFor)
{
  write("block.yaml", block_scene("time: {end: 1.0e+18}\noutputs: {history: {every: 1.0e-20}}\n"));
  const Outcome outcome = talus("check block.yaml");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, testing::HasSubstr("so about more than 1e18 steps"));
  EXPECT_THAT(outcome.out, testing::Not(testing::HasSubstr(" -")));
}

/// A limit that batch systems set.
TEST_F(CommandLine, AFileThatGrowsTooLongIsAnErrorOfItsWrite)
{
  write("block.yaml", block_scene("time: {end: 0.01}\noutputs: {particles: {every: 0.001}}\n"));
  const Outcome outcome = talus("run block.yaml --quiet --out out", "ulimit -f 4; ");
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_THAT(outcome.err, testing::ContainsRegex("error: cannot write out/.*File too large"));
}

}  // namespace

}  // namespace talus::cli_test
