// talus report: the page of a run, read back by a script as a browser reads it.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "app/commands/report/report.hpp"
#include "app/commands/report/report_particles.hpp"
#include "app/commands/report/report_plan.hpp"
#include "core/error.hpp"
#include "io/output/summary_json.hpp"
#include "io/output/vtk.hpp"
#include "tests/app/program.hpp"

namespace talus::report_test {

namespace {

using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(PagePlanning, EverythingIsInWhatIsSmall)
{
  const PagePlan plan = plan_page(1000, 30, {.once = 1, .place = 6, .fields = {2, 2}}, 1e6, {});
  EXPECT_EQ(plan.frames.size(), 30u);
  EXPECT_EQ(plan.fields, 2u);
  EXPECT_EQ(plan.share, 1);
}

TEST(PagePlanning, FramesGoFirstThenFieldsThenParticles)
{
  const ParticleCost cost{.once = 0, .place = 6, .fields = {2, 2, 2, 2, 2}};  // 16 B a frame, with three fields 12
  const PagePlan fewer_frames = plan_page(1000, 30, cost, 20 * 16e3, {});
  EXPECT_EQ(fewer_frames.frames.size(), 20u);
  EXPECT_EQ(fewer_frames.frames.front(), 0u);
  EXPECT_EQ(fewer_frames.frames.back(), 29u);
  EXPECT_EQ(fewer_frames.fields, 5u);
  const PagePlan fewer_fields = plan_page(1000, 30, cost, 12 * 14e3, {});
  EXPECT_EQ(fewer_fields.frames.size(), 12u);
  EXPECT_EQ(fewer_fields.fields, 4u);
  EXPECT_EQ(fewer_fields.share, 1);
  const PagePlan sample = plan_page(1000, 30, cost, 12 * 6e3, {});
  EXPECT_EQ(sample.frames.size(), 12u);
  EXPECT_EQ(sample.fields, 3u);
  EXPECT_NEAR(sample.share, 0.5, 1e-12);
  const PagePlan asked = plan_page(1000, 30, cost, 15 * 16e3, {.frames = true, .fields = true});
  EXPECT_EQ(asked.frames.size(), 30u) << "what was asked for is kept";
  EXPECT_EQ(asked.fields, 5u);
  EXPECT_NEAR(asked.share, 0.5, 1e-12);
  EXPECT_THROW(plan_page(1000, 30, cost, 100, {}), Error);
}

TEST(PagePlanning, FramesAreEvenlySpread)
{
  EXPECT_THAT(evenly_spread(3, 9), ElementsAre(0u, 4u, 8u));
  EXPECT_THAT(evenly_spread(4, 4), ElementsAre(0u, 1u, 2u, 3u));
  EXPECT_THAT(evenly_spread(1, 5), ElementsAre(4u));
}

TEST(PagePlanning, ASampleIsFairAndLargerOnesHoldSmallerOnes)
{
  int tenth = 0, half = 0;
  for (std::int64_t id = 0; id < 100'000; ++id) {
    tenth += is_sampled(id, 0.1) ? 1 : 0;
    half += is_sampled(id, 0.5) ? 1 : 0;
    EXPECT_TRUE(!is_sampled(id, 0.1) || is_sampled(id, 0.5));
  }
  EXPECT_NEAR(tenth, 10'000, 400);
  EXPECT_NEAR(half, 50'000, 700);
}

TEST(ReportWarning, ItsLineIsTheOneItNamesOrThatOfItsKey)
{
  const std::string scene = "title: x\nwatch:\n  # speed: 1\n  speed: 2\nbodies:\n  - {name: a}\n";
  EXPECT_EQ(line_of_warning("run/slope.yaml:12:5: bodies share cells", "elsewhere/slope.yaml", scene), 12);
  EXPECT_EQ(line_of_warning("moved at 3 m/s, beyond watch.speed = 2 m/s", "slope.yaml", scene), 4);
  EXPECT_EQ(line_of_warning("beyond watch.energy_gain = 2", "slope.yaml", scene), std::nullopt);
  EXPECT_EQ(line_of_warning("particles were set back 3 times", "", scene), std::nullopt);
}

/// A block that slides over the floor and a smaller one that flies: gravity, two bodies.
const std::string two_bodies = R"yaml(title: Two blocks
dimension: 2
mesh: {grid: {low: [0, 0], high: [3, 2], cells: [12, 8]}}
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]
bodies:
  - {name: large, material: rubber, shape: {type: box, low: [0.5, 0], high: [1.5, 1]}, particles_per_cell: 3, velocity: [1, 0]}
  - {name: small, material: rubber, shape: {type: box, low: [2, 1], high: [2.5, 1.5]}, particles_per_cell: 3, velocity: [2, 0]}
time: {end: 0.1}
loads: [{type: gravity, acceleration: [0, -10]}]
boundaries: [{type: friction, on: y_min, coefficient: 0}]
outputs:
  particles: {every: 0.02, fields: [velocity, stress]}
  history: {every: 0.01, fronts: [{name: toe, direction: +x, mass_share: 1}]}
  picture: {field: stress}
)yaml";

class Report : public Program {
 protected:
  void SetUp() override { write("page.html", "<html>\n<!--TALUS-RUN-->\n</html>\n"); }
  Outcome report(const std::string& words) const { return talus("report " + words + " --page page.html"); }
  /// What the script says that is in the page.
  std::string told(const std::string& words) const
  {
    const std::string script =
        std::string("/usr/bin/python3 " TALUS_SOURCE_DIR "/tests/app/read_page.py '") + folder_.path().string() + "/";
    const std::string command = script + words + " > '" + (folder_ / "told.txt").string() + "' 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << read("told.txt");
    return read("told.txt");
  }
  /// Rows of a frame of the page: id, body, x, y, z, fields.
  std::vector<std::vector<Real>> rows(const std::string& page, int frame) const
  {
    std::istringstream text(told(page + "' --frame " + std::to_string(frame)));
    std::vector<std::vector<Real>> all;
    for (std::string line; std::getline(text, line);) {
      std::istringstream cells(line);
      all.emplace_back();
      for (std::string cell; std::getline(cells, cell, ',');)
        all.back().push_back(std::stod(cell));
    }
    return all;
  }
};

TEST_F(Report, ParticlesOfThePageAreThoseOfTheRun)
{
  write("two.yaml", two_bodies);
  ASSERT_EQ(talus("run two.yaml --quiet --out out").code, 0);
  EXPECT_FALSE(exists("out/progress.json")) << "the run is over";
  const Outcome outcome = report("out --fields stress:xy,velocity,stress");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("^out/report.html  0.[0-9] MB\n$")) << "nothing is left out";

  const auto frames = read_pvd(folder_ / "out/particles.pvd");
  ASSERT_GE(frames.size(), 5u);
  const StoredParticles last = read_particles(frames.back().second);
  const auto shown = rows("out/report.html", static_cast<int>(frames.size()) - 1);
  ASSERT_EQ(shown.size(), last.ids.size());
  const std::vector<Real>& places = last.fields.front().values;
  const auto field = [&](const char* name) -> const std::vector<Real>& {
    return std::find_if(last.fields.begin(), last.fields.end(), [&](const StoredField& f) { return f.name == name; })->values;
  };
  Real largest_shear = 0;
  for (std::size_t p = 0; p < shown.size(); ++p)
    largest_shear = std::max(largest_shear, std::abs(field("stress")[6 * p + 3]));
  for (std::size_t p = 0; p < shown.size(); ++p) {
    EXPECT_EQ(shown[p][0], static_cast<Real>(last.ids[p]));
    EXPECT_EQ(shown[p][1], field("body")[p]);
    for (std::size_t d = 0; d < 3; ++d)
      EXPECT_NEAR(shown[p][2 + d], places[3 * p + d], 0.51 * 3 / 65534.0) << "half a step of an extent of less than 3 m";
    ASSERT_EQ(shown[p].size(), 8u);
    EXPECT_NEAR(shown[p][5], field("stress")[6 * p + 3], 1e-3 * largest_shear) << "stress:xy";
    EXPECT_NEAR(shown[p][6], std::hypot(field("velocity")[3 * p], field("velocity")[3 * p + 1]), 1e-4);
  }

  const std::string told_of_page = told("out/report.html'");
  EXPECT_THAT(told_of_page, HasSubstr("fields = ['stress:xy', 'velocity', 'stress']\n"));
  EXPECT_THAT(told_of_page, HasSubstr("status = done\n"));
  EXPECT_THAT(told_of_page, HasSubstr("live = None\n"));
  EXPECT_THAT(told_of_page, HasSubstr("up = [0.0, 1.0, 0.0]\n"));
  EXPECT_THAT(told_of_page, ContainsRegex("particles = 120 of 120\n"));
  EXPECT_THAT(told_of_page, ContainsRegex("mesh = 117 nodes, 40 outline, 308 edges\n"))
      << "13 x 9 nodes, 2 (12 + 8) edges around, and by Euler 117 + 192 - 1 in all";
  EXPECT_THAT(told_of_page, ContainsRegex("history.toe \\[m\\] = 2.4[0-9]+ to 2.6[0-9]+ in 11 rows\n"));
  EXPECT_THAT(told_of_page, ContainsRegex("run-out, small.advance along \\+x \\[m\\] = 0.19"));
  EXPECT_THAT(told_of_page, ContainsRegex("run-out, small.drop of the crest \\[m\\] = 0.0[45]")) << "10 m/s^2 over 0.1 s";
  EXPECT_THAT(told_of_page, ContainsRegex("run-out, all bodies.largest displacement \\[m\\] = 0.2"));
  EXPECT_THAT(told_of_page, ContainsRegex("fronts of the history.toe \\[m\\] = 2.6"));
  EXPECT_THAT(told_of_page, ContainsRegex("run_out.small: crest \\[m\\] = 1.[0-9]+ to 1.[0-9]+ in "));
}

/// A block that flies in a parabola.
std::string thrown_block(const std::string& runout)
{
  return "title: Thrown block\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [6, 4], cells: [24, 16]}}\n"
         "materials:\n  - {name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}\n"
         "  - {name: foam, law: neo_hookean, density: 100, youngs_modulus: 1.0e4, poisson_ratio: 0.3}\n"
         "bodies:\n  - {name: block, material: rubber, shape: {type: box, low: [0.5, 2.5], high: [1.5, 3.5]}, particles_per_cell: 12, "
         "velocity: [4, 0]}\n"
         "  - {name: chip, material: foam, shape: {type: box, low: [2.25, 3.25], high: [2.5, 3.5]}, particles_per_cell: 3, velocity: [6, "
         "0]}\n"
         "time: {end: 0.5}\nloads: [{type: gravity, acceleration: [0, -10]}]\n"
         "outputs:\n  particles: {every: 0.1, fields: [displacement]}\n" +
         runout;
}

Real number_in(const std::string& told, const std::string& key)
{
  const auto at = told.find(key + " = ");
  EXPECT_NE(at, std::string::npos) << key << " in\n" << told;
  return at == std::string::npos ? std::numeric_limits<Real>::quiet_NaN() : std::stod(told.substr(at + key.size() + 3));
}

TEST_F(Report, HeightOverLengthIsTheNumberOfTheRunAndNeedsNoRunOutInTheScene)
{
  write("looked.yaml", thrown_block("  runout: {every: 0.05}\n"));
  write("plain.yaml", thrown_block(""));
  ASSERT_EQ(talus("run looked.yaml --quiet --out looked").code, 0);
  ASSERT_EQ(talus("run plain.yaml --quiet --out plain").code, 0);
  ASSERT_EQ(report("looked").code, 0);
  ASSERT_EQ(report("plain").code, 0);
  const auto numbers = read_summary(folder_ / "looked/summary.json").numbers;
  const std::string looked = told("looked/report.html'"), plain = told("plain/report.html'");
  for (const auto& [of_run, of_page] : std::vector<std::pair<std::string, std::string>>{
           {"H", "height H [m]"}, {"L", "length L [m]"}, {"H/L", "H/L []"}, {"angle_of_reach", "angle of reach [deg]"}}) {
    const Real expected = find_number(numbers, "runout." + of_run)->value;
    EXPECT_NEAR(number_in(looked, "run-out, all bodies." + of_page), expected, 1e-5 * expected);
    EXPECT_NEAR(number_in(plain, "run-out, all bodies." + of_page), expected, 1e-4 * expected) << "by the same rule, from particle files";
  }
  const Real length = find_number(numbers, "runout.L")->value;
  EXPECT_LT(length, 3.2) << "the chip is two metres ahead, but less than a hundredth of the mass";
  EXPECT_GT(number_in(plain, "run-out, chip.length L [m]"), 2.9);
}

TEST_F(Report, DiscsAreLargerBesideGapsThatOpenWhileTheRunGoesOn)
{
  write("parts.yaml",
        "title: Parts\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [9, 3], cells: [18, 6]}}\n"
        "materials:\n  - {name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e3, poisson_ratio: 0}\n"
        "bodies:\n  - {name: sheet, material: rubber, shape: {type: box, low: [0, 1], high: [3, 2]}, particles_per_cell: 3, "
        "velocity: [\"x\", \"0\"]}\n"
        "time: {end: 1}\non_exit: delete\noutputs: {particles: {every: 1, fields: [velocity]}}\n");
  ASSERT_EQ(talus("run parts.yaml --quiet --out out").code, 0);
  ASSERT_EQ(report("out").code, 0);
  const std::string page = told("out/report.html'");
  const auto at = page.find("growth = [");
  ASSERT_NE(at, std::string::npos) << page;
  int first = -1, last = -1;
  ASSERT_EQ(std::sscanf(page.c_str() + at, "growth = [%d, %d]", &first, &last), 2) << page.substr(at, 100);
  EXPECT_GE(last, 20) << "hundredths: the sheet is about twice as long as at the start";
  EXPECT_LT(first, last);
}

/// Translation and quaternion of a rigid body in a frame of a page.
std::vector<Real> motion_in(const std::string& told, const std::string& body, const std::string& time)
{
  const std::string key = "rigid." + body + " at " + time + " s = ";
  const auto at = told.find(key);
  EXPECT_NE(at, std::string::npos) << key << " in\n" << told;
  if (at == std::string::npos)
    return {};
  std::istringstream numbers(told.substr(at + key.size(), told.find('\n', at) - at - key.size()));
  return {std::istream_iterator<Real>(numbers), {}};
}

/// Matches translation and quaternion.
auto moved_by(std::vector<Real> motion) { return testing::Pointwise(testing::DoubleNear(1e-5), std::move(motion)); }

TEST_F(Report, RigidBodiesOfThePageMoveAndTurnAsInTheRun)
{
  write("flat.yaml", block_scene(R"yaml(rigid:
  - {name: wheel, motion: given, velocity: [0.5, -1], angular_velocity: [10], shape: {type: sphere, centre: [0.3, 1.7], radius: 0.2}}
  - {name: ram, motion: given, angular_velocity: [-20], shape: {type: box, low: [1.4, 1.4], high: [1.8, 1.6]}}
time: {end: 0.1}
outputs: {particles: {every: 0.05, fields: [velocity]}}
)yaml"));
  ASSERT_EQ(talus("run flat.yaml --quiet --out flat").code, 0);
  ASSERT_EQ(report("flat").code, 0);
  const std::string flat = told("flat/report.html'");
  EXPECT_THAT(flat, HasSubstr("rigid.wheel = 49 nodes, 48 triangles, 0.1 to 0.5, 1.5 to 1.9 m\n"));
  EXPECT_THAT(flat, HasSubstr("rigid.ram = 4 nodes, 2 triangles, 1.4 to 1.8, 1.4 to 1.6 m\n"));
  EXPECT_THAT(motion_in(flat, "wheel", "0"), moved_by({0, 0, 0, 0, 0, 0, 1}));
  EXPECT_THAT(motion_in(flat, "wheel", "0.1"), moved_by({0.05, -0.1, 0, 0, 0, std::sin(0.5), std::cos(0.5)}));
  EXPECT_THAT(motion_in(flat, "ram", "0.1"), moved_by({0, 0, 0, 0, 0, -std::sin(1.0), std::cos(1.0)})) << "more than a right angle";
}

TEST_F(Report, RigidSurfacesAreOnceInThePageAndLeftOutWhereTheyCannotBeRead)
{
  write("solid.yaml", R"yaml(title: Brick
dimension: 3
mesh: {grid: {low: [0, 0, 0], high: [2, 2, 2], cells: [2, 2, 2]}}
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]
bodies: [{name: block, material: rubber, shape: {type: box, low: [0, 0, 0], high: [1, 1, 1]}, particles_per_cell: 4}]
rigid: [{name: brick, motion: given, velocity: [0, 1, 0], angular_velocity: [6, 0, 8], shape: {type: box, low: [1.4, 0.4, 1.4], high: [1.6, 0.6, 1.6]}}]
time: {end: 0.1}
outputs: {particles: {every: 0.05, fields: [velocity]}}
)yaml");
  ASSERT_EQ(talus("run solid.yaml --quiet --out solid").code, 0);
  ASSERT_EQ(report("solid").code, 0);
  const std::string solid = told("solid/report.html'");
  EXPECT_THAT(solid, HasSubstr("rigid.brick = 8 nodes, 12 triangles, 1.4 to 1.6, 0.4 to 0.6, 1.4 to 1.6 m\n"));
  EXPECT_THAT(motion_in(solid, "brick", "0.1"), moved_by({0, 0.1, 0, 0.6 * std::sin(0.5), 0, 0.8 * std::sin(0.5), std::cos(0.5)}));

  std::filesystem::resize_file(folder_ / "solid/rigid_0001.vtu", 300);
  const Outcome one_less = report("solid");
  ASSERT_EQ(one_less.code, 0) << one_less.err;
  EXPECT_THAT(one_less.out, HasSubstr("rigid bodies: their files of 1 of 3 times are missing or damaged"));
  EXPECT_THAT(told("solid/report.html'"), ContainsRegex("rigid.brick at 0.0[0-9]+ s = none\n"));
  std::filesystem::resize_file(folder_ / "solid/rigid_0000.vtu", 300);
  const Outcome none = report("solid");
  ASSERT_EQ(none.code, 0) << none.err;
  EXPECT_THAT(none.out, ContainsRegex("rigid bodies are not shown: .*solid/rigid_0000.vtu"));
  EXPECT_THAT(read("solid/report.html"), Not(HasSubstr("\"rigid\""))) << "as of a run without rigid bodies";
}

TEST_F(Report, ASmallPageHasFewerFramesOrASampleAndSaysSo)
{
  write("two.yaml", two_bodies);
  ASSERT_EQ(talus("run two.yaml --quiet --out out --set outputs.particles.every=0.002 --set bodies[0].particles_per_cell=12").code, 0);
  const Outcome outcome = report("out --out small.html --frames 3 --fields velocity:x --size 0.0245");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_LT(std::filesystem::file_size(folder_ / "small.html"), 24'500u);
  EXPECT_THAT(outcome.out, ContainsRegex("frames: 3 of [0-9]+ are shown"));
  EXPECT_THAT(outcome.out, ContainsRegex("particles: [0-9]+ of 408 are shown, a fair sample"));
  const std::string told_of_page = told("small.html'");
  EXPECT_THAT(told_of_page, HasSubstr("fields = ['velocity:x']\n"));
  const auto first = rows("small.html", 0), last = rows("small.html", 2);
  ASSERT_EQ(first.size(), last.size());
  EXPECT_GE(first.size(), 200u);
  for (std::size_t p = 0; p < first.size(); ++p)
    EXPECT_EQ(first[p][0], last[p][0]) << "the same particles in each frame";
  EXPECT_FALSE(exists("out/report.html"));
}

TEST_F(Report, RunsWithoutHistoryWithoutParticlesAndFailedOnesHavePagesToo)
{
  write("block.yaml", block_scene("time: {end: 0.02}\noutputs: {history: {every: 0.01}}\n"));
  ASSERT_EQ(talus("run block.yaml --quiet --out history").code, 0);
  ASSERT_EQ(report("history").code, 0);
  EXPECT_THAT(told("history/report.html'"), HasSubstr("particles = None\n"));
  EXPECT_THAT(report("history --fields velocity").err, HasSubstr("error: --fields: history has no particle files"));

  write("block.yaml", block_scene("time: {end: 0.02}\noutputs: {particles: {every: 0.01}}\nwatch: {speed: 1}\n", ", velocity: [2, 0]"));
  ASSERT_EQ(talus("run block.yaml --quiet --out failed").code, 1);
  const Outcome outcome = report("failed");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string told_of_page = told("failed/report.html'");
  EXPECT_THAT(told_of_page, HasSubstr("status = failed\n"));
  EXPECT_THAT(told_of_page, HasSubstr("history = None\n"));
  EXPECT_THAT(told_of_page, ContainsRegex("motion.largest speed \\[m/s\\] = 2")) << "no gravity: nothing runs out";

  std::filesystem::resize_file(folder_ / "failed/particles_0000.vtp", 500);
  const Outcome damaged = report("failed");
  ASSERT_EQ(damaged.code, 0) << damaged.err;
  EXPECT_THAT(damaged.out, HasSubstr("the frame at t = 0 s is left out: cannot read failed/particles_0000.vtp: it is damaged"));
  EXPECT_EQ(talus("run block.yaml --quiet --out failed --force --set watch.speed=10").code, 3)
      << "a damaged file is not one that the run wrote";
  std::filesystem::remove(folder_ / "failed/particles_0000.vtp");
  ASSERT_EQ(talus("run block.yaml --quiet --out failed --force --set watch.speed=10").code, 0);
  EXPECT_FALSE(exists("failed/report.html")) << "the page of the run before";
}

TEST_F(Report, WhatIsNotThereEndsWithTwo)
{
  EXPECT_EQ(report("nowhere").err, "error: nowhere holds no results of a run (no summary.json)\n");
  EXPECT_EQ(report(".").err, "error: . holds no results of a run (no summary.json)\n");
  write("block.yaml", block_scene("time: {end: 0.01}\noutputs: {particles: {every: 0.01, fields: [velocity]}}\n"));
  ASSERT_EQ(talus("run block.yaml --quiet --out out").code, 0);
  const Outcome field = report("out --fields velocty");
  EXPECT_EQ(field.code, 2);
  EXPECT_EQ(field.err, "error: --fields: the particles have no field \"velocty\" — did you mean \"velocity\"?\n");
  EXPECT_EQ(report("out --fields velocity:xy").err, "error: field \"velocity\" has no component \"xy\"; it has: x, y, z\n");
  EXPECT_THAT(report("out --size 0.001").err, HasSubstr("error: --size: too small"));
  EXPECT_EQ(report("out --size 0.001").code, 2);
  EXPECT_EQ(report("out --out page.txt").code, 2);
  write("page.html", "<html></html>");
  EXPECT_EQ(report("out").code, 3);
  EXPECT_FALSE(exists("out/report.html"));
}

TEST_F(Report, AProgramThatWasBuiltWithoutThePageSaysSo)
{
  write("block.yaml", block_scene("time: {end: 0.01}\n"));
  ASSERT_EQ(talus("run block.yaml --quiet --out out").code, 0);
  std::filesystem::copy_file(TALUS_BINARY, folder_ / "bare");  // no report.html beside it
  const Outcome outcome = talus("", "sh -c './bare report out'");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err,
              HasSubstr("error: the page was left out when this program was built, since npm could not fetch its libraries: "));
  EXPECT_THAT(outcome.err, HasSubstr("/report.html is not there; build again with the network within reach"));
  EXPECT_FALSE(exists("out/report.html"));
  const Outcome named = talus("", "sh -c './bare report out --page page.html'");
  EXPECT_EQ(named.code, 0) << named.err;
}

}  // namespace

}  // namespace talus::report_test
