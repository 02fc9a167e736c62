// Bodies that start with the state of a table: the stress of a column at rest, what follows from it, and what is refused.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "io/output/summary_json.hpp"
#include "io/output/vtk.hpp"
#include "tests/app/program.hpp"

namespace talus::start_states_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr Real weight = 2000 * 9.81, k0 = 0.5, top = 4;  // N/m^3, -, m

/// Points of a column under its weight, beside particles, x and y (z) from below 0 to above the top.
std::string column_table(int dimension, Real sign = 1, Real per_unit = 1, const std::string& stress = "stress", Real beyond = 0.13)
{
  std::string text = dimension == 2 ? "x,y" : "x,y,z";
  for (const std::string ending : {"xx", "yy", "zz", "xy", "yz", "xz"})
    if (dimension == 3 || (ending != "yz" && ending != "xz"))
      text += "," + stress + "_" + ending;
  text += "\n";
  const auto row = [&](Real x, Real y, Real z) {
    const Real height = dimension == 2 ? y : z, s = -sign * weight * (top - height) / per_unit;
    text += dimension == 2 ? fmt::format("{},{},{},{},{},0\n", x, y, k0 * s, s, k0 * s)
                           : fmt::format("{},{},{},{},{},{},0,0,0\n", x, y, z, k0 * s, k0 * s, s);
  };
  for (Real x = -0.03; x < 1.3; x += 0.37)
    for (Real h = -0.05; h < top + beyond; h += 0.29)
      for (Real y = -0.02; y < (dimension == 2 ? 0 : 1.3); y += 0.41)
        dimension == 2 ? row(x, h, 0) : row(x, y, h);
  return text;
}

const std::string soil =
    "law: drucker_prager, density: 2000, youngs_modulus: 2.0e7, poisson_ratio: 0.3, friction_angle: 30, cohesion: 1.0e4, match: outer";

struct ColumnScene {
  int dimension = 2;
  std::string initial = ", initial: {table: state.csv}";
  std::string stages = "time: {end: 0.2}\n";
  std::string material = soil;
  std::string more = "";
  std::string outputs = "outputs: {particles: {every: 0.2, fields: [stress, velocity, displacement]}, history: {every: 0.01}}\n";
  std::string text() const
  {
    const bool flat = dimension == 2;
    return "title: Column\ndimension: " + std::to_string(dimension) + "\nmesh: {grid: {low: [0, 0" + (flat ? "" : ", 0") + "], high: [1, " +
           (flat ? "4.5" : "1, 4.5") + "], cells: [4, " + (flat ? "18" : "4, 18") + "]}}\nmaterials: [{name: soil, " + material +
           "}]\nbodies: [{name: column, material: soil, shape: {type: box, low: [0, 0" + (flat ? "" : ", 0") + "], high: [1, " +
           (flat ? "4" : "1, 4") + "]}" + initial + "}]\n" + more + "loads: [{type: gravity, acceleration: [0, " +
           (flat ? "-9.81" : "0, -9.81") + "]}]\nboundaries: [{type: roller, on: x_min}, {type: roller, on: x_max}, " +
           (flat ? "{type: fixed, on: y_min}" : "{type: roller, on: y_min}, {type: roller, on: y_max}, {type: fixed, on: z_min}") + "]\n" +
           stages + outputs;
  }
};

class StartStates : public Program {
 protected:
  Outcome run(const ColumnScene& scene, const std::string& out = "out", const std::string& words = "",
              const std::string& launcher = "") const
  {
    write("scene.yaml", scene.text());
    return talus("run scene.yaml --out " + out + " " + words, launcher);
  }
  std::string refusal(const ColumnScene& scene) const
  {
    write("scene.yaml", scene.text());
    const Outcome outcome = talus("check scene.yaml");
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    return outcome.err;
  }
  StoredParticles first_frame(const std::string& run) const
  {
    return read_particles(read_pvd(folder_ / (run + "/particles.pvd")).front().second);
  }
  /// Largest error of the stress at the start, over the largest stress.
  void expect_column(const std::string& run, int dimension) const
  {
    const StoredParticles frame = first_frame(run);
    const std::vector<Real>&x = stored_field(frame, "position")->values, &s = stored_field(frame, "stress")->values;
    ASSERT_GT(frame.ids.size(), 100U);
    for (std::size_t p = 0; p < frame.ids.size(); ++p) {
      const auto up = static_cast<std::size_t>(dimension - 1);
      const Real along = -weight * (top - x[3 * p + up]);
      for (std::size_t c = 0; c < 6; ++c)
        EXPECT_NEAR(s[6 * p + c], c == up ? along : c < 3 ? k0 * along : 0, 1e-6 * weight * top) << "component " << c;
    }
  }
  Real number(const std::string& run, const std::string& name) const
  {
    const SummaryBack summary = read_summary(folder_ / (run + "/summary.json"));
    const NamedValue* found = find_number(summary.numbers, name);
    return found == nullptr ? std::numeric_limits<Real>::quiet_NaN() : found->value;
  }
};

TEST_F(StartStates, AColumnHasTheStressOfItsTable)
{
  for (const int dimension : {2, 3}) {
    write("state.csv", column_table(dimension));
    const Outcome outcome = run({.dimension = dimension, .stages = "time: {end: 1.0e-4}\n"}, "out" + std::to_string(dimension));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    expect_column("out" + std::to_string(dimension), dimension);
    EXPECT_THAT(outcome.out, HasSubstr("body \"column\": total stress of state.csv, "));
    EXPECT_THAT(outcome.out, HasSubstr("stage run: unbalanced force 0."));
    EXPECT_THAT(outcome.err, Not(HasSubstr("yield")));
  }
}

TEST_F(StartStates, SignsAndUnitsAreTurned)
{
  write("state.csv", column_table(2, -1, 1000, "sigma"));
  const Outcome outcome =
      run({.initial = ", initial: {table: state.csv, sign: compression_positive, unit: kPa}", .stages = "time: {end: 1.0e-4}\n"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_column("out", 2);
  const Outcome other = run(
      {.initial = ", initial: {table: state.csv, unit: kPa}", .stages = "time: {end: 1.0e-4}\n", .material = soil + ", tension_cutoff: 0"},
      "other");
  EXPECT_THAT(other.err,
              HasSubstr("of body \"column\" are under tension: if the table has compression positive, give sign: compression_positive"));
}

/// As well as from K0: neither is in equilibrium with the weights of the kernel.
TEST_F(StartStates, StaysAtRestAsWellAsFromK0)
{
  write("state.csv", column_table(2));
  const std::string stage = "stages: [{type: geostatic, duration: 10}, {type: run, duration: 0.2}]\n";
  ASSERT_EQ(run({.stages = stage}, "table").code, 0);
  std::string with_k0 = stage;
  with_k0.replace(with_k0.find("10}"), 3, "10, initial_stress: {k0: 0.5}}");
  ASSERT_EQ(run({.initial = "", .stages = with_k0}, "k0").code, 0);
  EXPECT_NEAR(number("table", "stages[0].residual_at_begin"), number("k0", "stages[0].residual_at_begin"), 0.01);
  EXPECT_EQ(number("table", "stages[0].steps"), number("k0", "stages[0].steps"));
  const Real moved = last(history("table"), "kinetic"), reference = last(history("k0"), "kinetic");
  EXPECT_LT(moved, 1.1 * reference + 1e-12);
  EXPECT_LT(moved, 2e-3) << "J, of 40 kJ that the weight could do";
}

TEST_F(StartStates, AStaticStageBeginsUnderTheWholeWeight)
{
  write("state.csv", column_table(2));
  const Outcome outcome = run({.stages = "stages: [{type: static, increments: 2}]\n"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const StoredParticles end = read_particles(read_pvd(folder_ / "out/particles.pvd").back().second);
  Real lowest = 0;
  for (const Real u : stored_field(end, "displacement")->values)
    lowest = std::min(lowest, u);
  EXPECT_GT(lowest, -2e-4) << "m; under a weight that grows from zero it would settle by 6 mm";
}

TEST_F(StartStates, RanksChangeNothing)
{
  write("state.csv", column_table(2));
  ASSERT_EQ(run({}, "one").code, 0);
  const Outcome outcome = run({}, "three", "", launcher_of(3));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(talus("diff one three").code, 0);
  EXPECT_EQ(read("one/history.csv"), read("three/history.csv"));
  ASSERT_EQ(run({}, "far", "", launcher_of(3)).code, 0);
  write("state.csv", column_table(2, 1, 1, "stress", -1.9));
  const std::string alone = refusal({}), shared = [&] { return talus("check scene.yaml", launcher_of(3)).err; }();
  EXPECT_THAT(shared, StartsWith(alone)) << "the launcher adds words of its own";
}

TEST_F(StartStates, ARestartIsBitwiseIdentical)
{
  write("state.csv", column_table(2));
  const std::string outputs = "outputs: {checkpoint: {steps: 40, keep: 100}, history: {every: 0.01}}\n";
  ASSERT_EQ(run({.outputs = outputs}, "whole").code, 0);
  ASSERT_EQ(run({.outputs = outputs}, "parts", "--until 40").code, 4);
  ASSERT_EQ(talus("run --resume parts").code, 0);
  EXPECT_EQ(read("whole/history.csv"), read("parts/history.csv"));
  ASSERT_EQ(run({.outputs = outputs}, "other", "--until 40").code, 4);
  write("state.csv", column_table(2, 1.01));
  EXPECT_THAT(talus("run --resume other").err,
              HasSubstr("the table of a body, or the surface of a rigid body is not the one that the checkpoint was made with"));
}

TEST_F(StartStates, EffectiveStressAndPorePressureBecomeTotalStress)
{
  std::string table = "x,y,effective_stress_xx,effective_stress_yy,effective_stress_zz,effective_stress_xy,pore_pressure\n";
  std::string dry = "x,y,sxx,syy,szz,sxy\n";
  for (const Real x : {0., 0.5, 1.})
    for (const Real y : {0., 1., 2., 3., 4.}) {
      const Real s = -1e4 * (top - y);
      table += fmt::format("{},{},{},{},{},0,{}\n", x, y, k0 * s, s, k0 * s, 9810 * (top - y));
      dry += fmt::format("{},{},{},{},{},0\n", x, y, k0 * s, s, k0 * s);
    }
  write("state.csv", table);
  const std::string water = "water: {table: {elevation: 4}}\n", brief = "time: {end: 1.0e-4}\n";
  const std::string outputs = "outputs: {particles: {every: 1, fields: [stress, effective_stress]}}\n";
  Outcome outcome = run({.stages = brief, .more = water, .outputs = outputs}, "wet");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, Not(HasSubstr("pore pressure of the table differs")));
  const auto lowest = [&](const std::string& run, const std::string& field) {
    const std::vector<Real> values = stored_field(first_frame(run), field)->values;
    Real least = 0;
    for (std::size_t i = 1; i < values.size(); i += 6)
      least = std::min(least, values[i]);
    return least;
  };
  EXPECT_NEAR(lowest("wet", "stress") / lowest("wet", "effective_stress"), 1.981, 1e-5);
  ASSERT_EQ(run({.stages = brief, .more = "water: {table: {elevation: 4}, undrained: [column]}\n", .outputs = outputs}, "undrained").code,
            0);
  EXPECT_NEAR(lowest("undrained", "stress"), lowest("wet", "stress"), 1);
  outcome = run({.stages = brief, .more = "water: {table: {elevation: 2}}\n", .outputs = outputs}, "lower");
  EXPECT_THAT(outcome.err, HasSubstr("the pore pressure of the table differs from that below the water table of the scene by up to 1.96"));
  EXPECT_NEAR(lowest("lower", "effective_stress"), lowest("wet", "effective_stress"), 1);
  write("state.csv", dry);
  EXPECT_THAT(refusal({.more = water}),
              HasSubstr("is total, and the law of body \"column\" takes effective stress: a column pore_pressure is needed"));
  EXPECT_EQ(
      run({.initial = ", initial: {table: state.csv, stress: effective}", .stages = brief, .more = water, .outputs = outputs}, "said").code,
      0);
  EXPECT_NEAR(lowest("said", "effective_stress"), lowest("wet", "effective_stress"), 1);
}

TEST_F(StartStates, MotionAndHistoryComeAlong)
{
  std::string table = "x,y,sxx,syy,szz,sxy,vx,vy,ux,uy,plastic_strain\n";
  for (const Real x : {0., 0.5, 1.})
    for (const Real y : {0., 1., 2., 3., 4.})
      table += fmt::format("{},{},0,0,0,0,{},{},0.25,{},{}\n", x, y, 2 * y, -x, 0.1 * y, 0.01 * y);
  write("state.csv", table);
  const std::string outputs = "outputs: {particles: {every: 1, fields: [velocity, displacement, plastic_strain]}}\n";
  const Outcome outcome =
      run({.initial = ", initial: {table: state.csv, displacement: keep}", .stages = "time: {end: 1.0e-5}\n", .outputs = outputs});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const StoredParticles frame = first_frame("out");
  const auto at = [&](const char* field, std::size_t i) { return stored_field(frame, field)->values[i]; };
  for (std::size_t p = 0; p < frame.ids.size(); ++p) {
    const Real x = at("position", 3 * p), y = at("position", 3 * p + 1);
    EXPECT_NEAR(at("velocity", 3 * p), 2 * y, 1e-6);
    EXPECT_NEAR(at("velocity", 3 * p + 1), -x, 1e-6);
    EXPECT_NEAR(at("displacement", 3 * p), 0.25, 1e-6);
    EXPECT_NEAR(at("displacement", 3 * p + 1), 0.1 * y, 1e-6);
    EXPECT_NEAR(at("plastic_strain", p), 0.01 * y, 1e-7);
  }
}

/// The plane through the points above y = 2 would go below zero between them and the others.
TEST_F(StartStates, AHistoryStaysWithinItsTable)
{
  std::string table = "x,y,sxx,syy,szz,sxy,plastic_strain [%]\n";
  for (const Real x : {0., 0.5, 1.})
    for (const Real y : {0.5, 1., 1.5, 2., 2.5, 3., 3.5})
      table += fmt::format("{},{},0,0,0,0,{}\n", x, y, y > 2.2 ? 20 * (y - 2) : 0);
  write("state.csv", table);
  const std::string outputs = "outputs: {particles: {every: 1, fields: [plastic_strain]}}\n";
  const Outcome outcome = run({.stages = "time: {end: 1.0e-5}\n", .outputs = outputs});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::vector<Real> strain = stored_field(first_frame("out"), "plastic_strain")->values;
  EXPECT_EQ(*std::min_element(strain.begin(), strain.end()), 0);
  EXPECT_NEAR(*std::max_element(strain.begin(), strain.end()), 0.3, 1e-7) << "of its last points, beyond which it does not grow";
}

/// A law of the user, which says at every particle whether it takes the stress.
TEST_F(StartStates, StressThatTheLawDoesNotTakeIsRefused)
{
  write("shy.c", R"(static int begin(talus_law_setup* setup) { setup->bulk = 1e7; setup->shear = 5e6; return 0; }
static int update(talus_law_block* block) { (void)block; return 0; }
static int prestress(void* context, const double* parameters, const double* constants, const double* stress, double* history)
{
  (void)context, (void)parameters, (void)constants, (void)history;
  return stress[1] < -3e4;
}
static const talus_law law = {.version = TALUS_LAW_VERSION, .measure = TALUS_LAW_STRAIN, .name = "shy", .summary = "Takes little.",
                              .begin = begin, .update = update, .prestress = prestress};
const talus_law* shy(void) { return &law; }
)");
  ASSERT_EQ(std::system(("cd '" + folder_.path().string() +
                         "' && cc -shared -fPIC -include '" TALUS_SOURCE_DIR "/materials/interface/talus_law.h' shy.c -o libshy.so")
                            .c_str()),
            0);
  write("state.csv", column_table(2));
  const ColumnScene scene{.material = "law: own, library: libshy.so, symbol: shy, density: 2000"};
  const std::string wrong = refusal(scene);
  EXPECT_THAT(wrong, HasSubstr("scene.yaml:5:"));
  EXPECT_THAT(wrong, HasSubstr("bodies[0] \"column\".initial: law \"shy of libshy.so\" does not take the stress of the table at "));
  EXPECT_THAT(wrong, HasSubstr(" particles of body \"column\", the first at (0."));
  EXPECT_THAT(talus("check scene.yaml", launcher_of(2)).err, StartsWith(wrong)) << "the launcher adds words of its own";
}

/// The table has axes of its own, thousands of kilometres from those of the scene, where no plane fits.
TEST_F(StartStates, ATableFarFromItsBodyIsRefusedInWords)
{
  std::string table = "x,y,sxx,syy,szz,sxy\n";
  for (const Real x : {0., 0.5, 1.})
    for (const Real y : {0., 1., 2.})
      table += fmt::format("{},{},0,0,0,0\n", x, y - 5e6);
  write("state.csv", table);
  const std::string wrong = refusal({});
  EXPECT_THAT(wrong, HasSubstr("scene.yaml:5:"));
  EXPECT_THAT(wrong, HasSubstr("lie beyond the points of state.csv, the worst at ("));
  EXPECT_THAT(wrong, HasSubstr("5e+06 m from its nearest point, allowed "));
  EXPECT_THAT(wrong, HasSubstr("; the points lie between (0, -5e+06) and (1, -5e+06): give them in the axes and the unit of the scene"));
  EXPECT_THAT(refusal({.initial = ", initial: {table: state.csv, reach: 1.0e7}"}),
              HasSubstr("particles of body \"column\" lie so far beside the points of state.csv that these seem to lie on one line"));
}

TEST_F(StartStates, StressBeyondTheYieldSurfaceIsCounted)
{
  write("state.csv", column_table(2));
  const Outcome outcome =
      run({.stages = "time: {end: 0.01}\n",
           .material = "law: von_mises, density: 2000, youngs_modulus: 2.0e7, poisson_ratio: 0.3, yield_stress: 2.0e4"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("lies beyond the yield surface of law \"von_mises\", by up to "));
  EXPECT_GT(number("out", "start_states[0].beyond_yield"), 100);
  EXPECT_LT(number("out", "start_states[0].beyond_yield"), number("out", "start_states[0].particles"));
}

TEST_F(StartStates, WhatCannotBeIsRefusedWithItsPlace)
{
  EXPECT_THAT(refusal({}), HasSubstr("scene.yaml:5:"));
  EXPECT_THAT(refusal({}), HasSubstr("there is no file state.csv"));
  write("state.csv", "x,y,sxx,syy,szz,sxy\n0,0,0,0,0,0\n1,1,0,0,a,0\n2,2,0,0,0,0\n3,3,0,0,0,0\n");
  EXPECT_THAT(refusal({}), HasSubstr("state.csv:3:1: error: szz is \"a\", which is no finite number"));
  write("state.csv", "x,y,sxx,syy,szz,sxy\n0,0,0,0,0,0\n1,1,0,0,0,0\n2,2,0,0,0,0\n3,3,0,0,0,0\n");
  EXPECT_THAT(refusal({}), HasSubstr("all 4 points of state.csv lie on one line: values beside it are not known"));
  write("state.csv", column_table(2, 1, 1, "stress", -1.9));
  const std::string beyond = refusal({});
  EXPECT_THAT(beyond, HasSubstr("lie beyond the points of state.csv, the worst at ("));
  EXPECT_THAT(beyond, HasSubstr(" m from its nearest point, allowed 0."));
  write("scene.yaml", ColumnScene{.initial = ", initial: {table: state.csv, reach: 3}"}.text());
  EXPECT_EQ(talus("check scene.yaml").code, 0);
  EXPECT_THAT(refusal({.material = "law: neo_hookean, density: 2000, youngs_modulus: 2.0e6, poisson_ratio: 0.3"}),
              HasSubstr("law \"neo_hookean\" cannot start from a stress; linear_elastic, "));
  EXPECT_THAT(refusal({.stages = "stages: [{type: geostatic, duration: 1, initial_stress: {k0: 0.5}}]\n"}),
              HasSubstr("the stress of all bodies comes from their tables (initial): leave this out"));
}

}  // namespace
}  // namespace talus::start_states_test
