#include <gmock/gmock.h>

#include <limits>

#include "app/commands/diff/differences.hpp"
#include "tests/app/program.hpp"

namespace talus::diff_test {

namespace {

using testing::ContainsRegex;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::Pair;

constexpr Real nan = std::numeric_limits<Real>::quiet_NaN(), infinity = std::numeric_limits<Real>::infinity();

TEST(Differences, TimesAreMatchedToTheirRoundOff)
{
  const std::vector<Real> a{0, 0.1, 0.2, 0.3}, b{0, 0.1 * (1 + 1e-13), 0.2 * (1 + 1e-11), 0.4};
  const Pairs pairs = match_times(a, b);
  EXPECT_THAT(pairs.both, ElementsAre(Pair(0u, 0u), Pair(1u, 1u)));
  EXPECT_THAT(pairs.only_a, ElementsAre(2u, 3u));
  EXPECT_THAT(pairs.only_b, ElementsAre(2u, 3u));
}

TEST(Differences, ParticlesAreMatchedByTheirIdsInAnyOrder)
{
  const std::vector<std::int64_t> a{7, 3, 5}, b{5, 9, 7};
  const Pairs pairs = match_ids(a, b);
  EXPECT_THAT(pairs.both, ElementsAre(Pair(2u, 0u), Pair(0u, 2u)));
  EXPECT_THAT(pairs.only_a, ElementsAre(1u));
  EXPECT_THAT(pairs.only_b, ElementsAre(1u));
}

TEST(Differences, TheLargestIsNamedAndThoseBeyondTheToleranceAreCounted)
{
  const std::vector<Real> a{1, 2, 3, 4, 5, 6}, b{1, 2.5, 3, 3, 5.25, 6};
  const std::vector<std::pair<std::size_t, std::size_t>> rows{{0, 0}, {1, 1}, {2, 2}};
  const Gap gap = compare(a, b, 2, rows, 0.25);
  EXPECT_EQ(gap.values, 6);
  EXPECT_EQ(gap.differing, 2) << "what is as far apart as allowed does not differ";
  EXPECT_EQ(gap.largest, 1);
  EXPECT_EQ(gap.pair, 1u);
  EXPECT_EQ(gap.component, 1);
  EXPECT_EQ(gap.a, 4);
  EXPECT_EQ(gap.b, 3);
}

TEST(Differences, WhatIsNoNumberIsTheSameAsItselfOnly)
{
  const std::vector<std::pair<std::size_t, std::size_t>> row{{0, 0}};
  const auto differing = [&](Real a, Real b, Real tolerance) {
    return compare(std::vector<Real>{a}, std::vector<Real>{b}, 1, row, tolerance).differing;
  };
  EXPECT_EQ(differing(nan, nan, 0), 0);
  EXPECT_EQ(differing(infinity, infinity, 0), 0);
  EXPECT_EQ(differing(0.0, -0.0, 0), 0);
  EXPECT_EQ(differing(nan, 1, 1e300), 1);
  EXPECT_EQ(differing(1, infinity, infinity), 1);
  EXPECT_EQ(differing(-infinity, infinity, 1), 1);
  EXPECT_EQ(largest_modulus(std::vector<Real>{1, -3, nan, infinity}), 3);
}

const std::string outputs = R"yaml(time: {end: 0.02}
loads: [{type: gravity, acceleration: [0.3, -9.81]}]
boundaries: [{type: friction, on: y_min, coefficient: 0.3}]
outputs:
  particles: {every: 0.01, fields: [velocity, stress]}
  mesh: {every: 0.01, fields: [mass, velocity]}
  history: {every: 0.01}
)yaml";

/// Results of a falling block in the folder "a", to compare others with.
class Diff : public Program {
 protected:
  void SetUp() override
  {
    write("block.yaml", block_scene(outputs));
    run("a");
  }
  void run(const std::string& name, const std::string& words = "") const
  {
    const Outcome outcome = talus("run block.yaml --quiet --out " + name + " " + words);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  /// A second folder of the same results, to be spoilt.
  void copy(const std::string& name) const
  {
    std::filesystem::copy(folder_ / "a", folder_ / name, std::filesystem::copy_options::recursive);
  }
  std::string last_particles(const std::string& run) const
  {
    std::string file;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / run))
      if (entry.path().extension() == ".vtp" && entry.path().filename().string() > file)
        file = entry.path().filename().string();
    return run + "/" + file;
  }
};

TEST_F(Diff, TheSameRunTwiceIsTheSame)
{
  run("b", "--threads 1");
  const Outcome outcome = talus("diff a b");
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, EndsWith("\nthe same\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("particles +unit +largest difference +over scale +where +values that differ"));
  EXPECT_THAT(outcome.out, ContainsRegex("  velocity +m/s +0 +0 +- +0 of [0-9]+\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("  reaction_y_min_y +N +0 +0 +- +0 of [0-9]+\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("made with the same scene.yaml, mesh.msh, .*version, commit"));
}

TEST_F(Diff, AnotherDensityDiffersAndTheTableSaysWhere)
{
  run("b", "--set materials[0].density=1100");
  const Outcome outcome = talus("diff a b");
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("  stress +Pa +[0-9.e+]+ +0\\.[0-9]+ +t = 0\\.02 s, particle [0-9]+, [xyz][xyz] +[1-9]"));
  EXPECT_THAT(outcome.out, ContainsRegex("  mass +kg +[0-9.]+ +0\\.09[01][0-9]* +t = 0\\.02 s, node [0-9]+ +[1-9]"));  // 1 of 11
  EXPECT_THAT(outcome.out, ContainsRegex("  mass +kg +100 +0\\.0909 +t = 0 s, row 1 +[1-9]"));
  EXPECT_THAT(outcome.out, ContainsRegex("only in a: [0-9]+ times?, the first t = 0\\.01[0-9]* s"))
      << "heavier: other steps, so another first step after 0.01 s";
  EXPECT_THAT(outcome.out, ContainsRegex("\n[0-9]+ of [0-9]+ fields differ; not all is in both runs\n$"));
}

TEST_F(Diff, WhatIsWithinTheToleranceIsTheSame)
{
  run("b", "--set materials[0].density=1001 --set time.cfl=0.3");
  EXPECT_EQ(talus("diff a b --last --field stress").code, 1);
  EXPECT_EQ(talus("diff a b --last --field stress --relative 1e-9").code, 1);
  const Outcome relative = talus("diff a b --last --field stress --relative 0.5");
  EXPECT_EQ(relative.code, 0) << relative.out;
  EXPECT_THAT(relative.out, EndsWith("\nthe same\n"));
  EXPECT_EQ(talus("diff a b --last --field stress --absolute 1e6").code, 0) << "[Pa]";
  EXPECT_EQ(talus("diff a b --field stress --relative 0.5").code, 1) << "times that only one run has differ at any tolerance";
}

TEST_F(Diff, ComparesTheFieldsThatAreAskedFor)
{
  copy("b");
  const Outcome outcome = talus("diff --field velocity kinetic a b");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("velocity"));
  EXPECT_THAT(outcome.out, HasSubstr("kinetic"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("stress")));
  const Outcome unknown = talus("diff a b --field velocty");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_EQ(unknown.err, "error: neither a nor b has a field \"velocty\" — did you mean \"velocity\"?\n");
}

TEST_F(Diff, NamesFilesTimesFieldsAndParticlesThatOnlyOneRunHas)
{
  copy("b");
  std::filesystem::remove(folder_ / "b/history.csv");
  const Outcome file = talus("diff a b");
  EXPECT_EQ(file.code, 1) << file.err;
  EXPECT_THAT(file.out, ContainsRegex("  kinetic +J +- +- +only in a +-\n"));

  run("fewer", "--set outputs.particles.fields=[stress]");
  const Outcome field = talus("diff fewer a");
  EXPECT_EQ(field.code, 1) << field.err;
  EXPECT_THAT(field.out, ContainsRegex("  velocity +m/s +- +- +only in a +-\n"));
  EXPECT_THAT(field.out, ContainsRegex("\n1 of [0-9]+ fields differ\n$"));

  run("longer", "--set time.end=0.03");
  const Outcome time = talus("diff a longer --field velocity");
  EXPECT_EQ(time.code, 1) << time.err;
  EXPECT_THAT(time.out, ContainsRegex("only in longer: [0-9] times?, the first t = 0\\.0[0-9]+ s"));

  run("finer", "--set bodies[0].particles_per_cell=6");
  const Outcome particles = talus("diff a finer --last --field stress");
  EXPECT_EQ(particles.code, 1) << particles.err;
  EXPECT_THAT(particles.out, ContainsRegex("only in finer: particles 96, 97, 98, 99, 100 and 91 more at t = 0\\.02 s"))
      << "32 triangles of 3 particles, and of 6";
}

TEST_F(Diff, OtherMeshesAreNotComparedNodeByNode)
{
  run("b", "--set 'mesh.grid.cells=[4, 4]'");
  const Outcome outcome = talus("diff a b");
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("  position +m +- +- +81 and 25 nodes +-\n"));
  EXPECT_THAT(outcome.out, HasSubstr("made with other scene.yaml, mesh.msh"));
}

TEST_F(Diff, WhatCannotBeReadEndsWithTwo)
{
  EXPECT_EQ(talus("diff a").code, 2);
  EXPECT_EQ(talus("diff a a --relative -1").code, 2);
  const Outcome nowhere = talus("diff a nowhere");
  EXPECT_EQ(nowhere.code, 2);
  EXPECT_EQ(nowhere.err, "error: nowhere holds no results of a run (no summary.json)\n");

  copy("b");
  const std::string file = last_particles("b"), whole = read(file);
  write(file, whole.substr(0, whole.size() - whole.size() / 4));  // as after a full disk
  const Outcome shortened = talus("diff a b");
  EXPECT_EQ(shortened.code, 2) << shortened.out;
  EXPECT_THAT(shortened.err, testing::StartsWith("error: cannot read " + file + ": it is damaged"));
  EXPECT_EQ(std::count(shortened.err.begin(), shortened.err.end(), '\n'), 1) << "nothing of VTK's own: " << shortened.err;
  EXPECT_EQ(shortened.out, "");

  write(file, "no XML");
  EXPECT_EQ(talus("diff a b").code, 2);
  std::filesystem::remove(folder_ / file);
  const Outcome gone = talus("diff a b");
  EXPECT_EQ(gone.code, 2);
  EXPECT_EQ(gone.err, "error: cannot read " + file + ": there is no such file\n");

  write(file, whole);
  EXPECT_EQ(talus("diff a b").code, 0);
  write("b/history.csv", "time [s],kinetic [J]\n0,1\n0,2\n");
  const Outcome backwards = talus("diff a b");
  EXPECT_EQ(backwards.code, 2);
  EXPECT_EQ(backwards.err, "error: b/history.csv: its times do not ascend: entry 2 is 0 s\n");
  write("b/history.csv", "time [s],kinetic [J],toe [m],kinetic [m]\n0,1,2,3\n");
  const Outcome twice = talus("diff a b");
  EXPECT_EQ(twice.code, 2);
  EXPECT_EQ(twice.err, "error: b/history.csv: columns 2 and 4 are both called \"kinetic\"\n");
  std::filesystem::copy_file(folder_ / "a/history.csv", folder_ / "b/history.csv", std::filesystem::copy_options::overwrite_existing);
  write("b/summary.json", "{}");
  EXPECT_THAT(talus("diff a b").err, HasSubstr("b/summary.json is not the summary of a run"));
}

}  // namespace

}  // namespace talus::diff_test
