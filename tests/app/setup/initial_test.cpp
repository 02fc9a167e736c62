// A scene that begins as another run left it: the same state, what may differ, and what is refused.
#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "io/checkpoint/array_file.hpp"
#include "io/output/vtk.hpp"
#include "tests/app/forged.hpp"
#include "tests/app/program.hpp"

namespace talus::initial_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string soil =
    "law: drucker_prager, density: 2000, youngs_modulus: 2.0e6, poisson_ratio: 0.3, friction_angle: 15, cohesion: 500, "
    "match: plane_strain, residual_cohesion: 100, softening_strain: 0.05";
const std::string strong =
    "law: drucker_prager, density: 2000, youngs_modulus: 2.0e6, poisson_ratio: 0.3, friction_angle: 35, cohesion: 2.0e4, match: "
    "plane_strain";
const std::string at_rest = "stages: [{type: geostatic, duration: 20, initial_stress: {k0: 0.43}}]\n";
const std::string filled = "shape: {type: box, low: [0, 0], high: [1, 1]}, particles_per_cell: 3";

/// A bank of soil 1 m high, and the room that it fails into.  Every part may be replaced.
struct Bank {
  std::string mesh = "{grid: {low: [0, 0], high: [3, 1.5], cells: [12, 6]}}";
  std::string more = "";  ///< precision, transfer, accuracy
  std::string material = soil;
  std::string bodies = "{name: bank, material: soil, " + filled + "}";
  std::string initial = "";
  std::string when = at_rest;
  std::string checkpoint = "";  ///< besides that at the end
  std::string text() const
  {
    return "title: Bank\ndimension: 2\nmesh: " + mesh + "\n" + more + "materials: [{name: soil, " + material + "}]\nbodies: [" + bodies +
           "]\n" + initial +
           "loads: [{type: gravity, acceleration: [0, -9.81]}]\n"
           "boundaries: [{type: fixed, on: y_min}, {type: roller, on: x_min}, {type: roller, on: x_max}]\n" +
           when + "outputs:\n  checkpoint: {at_end: true" + checkpoint + "}\n  particles: {every: 0.02}\n  history: {every: 0.004, " +
           "points: [{name: deep, at: [0.1, 0.1]}]}\n";
  }
};

/// Of the bank that began elsewhere.
Bank second(const std::string& more_of_initial = "", const std::string& from = "first")
{
  return {.bodies = "{name: bank, material: soil}",
          .initial = "initial: {from: " + from + more_of_initial + "}\n",
          .when = "time: {end: 0.05}\n"};
}

struct Row {
  Real deep_sxx, deep_syy, mass, kinetic, momentum_x, momentum_y, centre_x, centre_y;
};
Row row_of(const HistoryTable& table, std::size_t row)
{
  const auto value = [&](const char* column) { return (*table[column])[row]; };
  return {value("deep_sxx"),   value("deep_syy"),   value("mass"),     value("kinetic"),
          value("momentum_x"), value("momentum_y"), value("centre_x"), value("centre_y")};
}

class Initial : public Program {
 protected:
  Outcome run(const std::string& name, const Bank& bank, const std::string& words = "") const
  {
    write(name + ".yaml", bank.text());
    return talus("run " + name + ".yaml --quiet --out " + name + " " + words);
  }
  void run_well(const std::string& name, const Bank& bank, const std::string& words = "") const
  {
    const Outcome outcome = run(name, bank, words);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(without_losses(outcome.err), "");
  }
  Row first_row(const std::string& name) const { return row_of(history(name), 0); }
  Row last_row(const std::string& name) const
  {
    const HistoryTable table = history(name);
    return row_of(table, table.rows() - 1);
  }
  /// Of a summary, without blanks: from one word up to another.
  std::string part(const std::string& run, const std::string& from, const std::string& to) const
  {
    std::string text = read(run + "/summary.json");
    text.erase(std::remove_if(text.begin(), text.end(), [](char c) { return c == ' ' || c == '\n'; }), text.end());
    const auto begin = text.find(from);
    return begin == text.npos ? "" : text.substr(begin, text.find(to, begin) - begin);
  }
  std::string origin(const std::string& run) const { return part(run, "\"initial\":", ",\"stages\""); }
  /// Checkpoints of a run, the oldest first.
  std::vector<fs::path> checkpoints(const std::string& run) const
  {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder_ / (run + "/checkpoints")))
      files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
  }
  /// What `talus check` says against a bank that begins as `first` ended.
  std::string refusal(const Bank& bank) const
  {
    write("refused.yaml", bank.text());
    const Outcome outcome = talus("check refused.yaml");
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    return outcome.err;
  }
};

/// A column of the particles in the order of their ids.
std::vector<Real> by_id(const fs::path& checkpoint, const std::string& path, int columns)
{
  const ArrayReader file(checkpoint);
  const auto id = file.read<std::int64_t>("particles/id");
  const auto values = file.read<Real>(path, columns);
  const auto width = static_cast<std::size_t>(columns);
  std::vector<Real> sorted(values.size());
  for (std::size_t row = 0; row < id.size(); ++row)
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(row * width), width,
                sorted.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(id[row]) * width));
  return sorted;
}

/// A step of the same length makes the same bits; the last steps of a stage differ by the rounding of the time that is left.
TEST_F(Initial, GoesOnAsTheSameRunWouldHave)
{
  run_well("first", {});
  run_well("apart", second());
  run_well("whole", {.when = "stages: [{type: geostatic, duration: 20, initial_stress: {k0: 0.43}}, {type: run, duration: 0.05}]\n"});
  const fs::path apart = checkpoints("apart").back(), whole = checkpoints("whole").back();
  for (const auto& [path, columns] : std::vector<std::pair<std::string, int>>{{"particles/position", 2},
                                                                              {"particles/velocity", 2},
                                                                              {"particles/affine", 4},
                                                                              {"particles/deformation_gradient", 9},
                                                                              {"particles/stress", 6},
                                                                              {"particles/volume", 1},
                                                                              {"particles/mass", 1},
                                                                              {"laws/history/0/elastic_left", 6},
                                                                              {"laws/history/0/plastic_strain", 1}}) {
    const auto a = by_id(apart, path, columns), b = by_id(whole, path, columns);
    ASSERT_EQ(a.size(), b.size());
    Real largest = 0, difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      largest = std::max(largest, std::abs(b[i]));
      difference = std::max(difference, std::abs(a[i] - b[i]));
    }
    EXPECT_GT(largest, 0) << path;
    EXPECT_LE(difference, 1e-12 * largest) << path;
  }
  EXPECT_EQ(last(history("first"), "step") + last(history("apart"), "step"), last(history("whole"), "step"));
  EXPECT_GT(last(history("apart"), "plastic"), 0) << "a bank that stands proves little";
}

TEST_F(Initial, StressGoesOnAndRestStaysRest)
{
  run_well("first", {.material = strong});
  Bank bank = second();
  bank.material = strong;
  run_well("second", bank);
  const Row end = last_row("first"), start = first_row("second"), later = last_row("second");
  EXPECT_EQ(start.deep_syy, end.deep_syy);
  EXPECT_EQ(start.deep_sxx, end.deep_sxx);
  EXPECT_EQ(start.kinetic, 0);
  EXPECT_NEAR(later.deep_syy, end.deep_syy, 1e-3 * std::abs(end.deep_syy)) << "the residual of the first run";
  EXPECT_LE(later.kinetic, 1e-3 * std::abs(last(history("first"), "gravity_work")));
}

TEST_F(Initial, KeepsMassMomentumAndCentreOnAnyMesh)
{
  const std::string thrown = filled + ", velocity: [0.5, \"1 + 0.3 * x\"]";
  run_well("first", {.bodies = "{name: bank, material: soil, " + thrown + "}", .when = "time: {end: 0.03}\n"});
  const Row end = last_row("first");
  for (const std::string mesh :
       {"{grid: {low: [0, 0], high: [3, 1.5], cells: [12, 6]}}", "{grid: {low: [-0.5, 0], high: [4, 3], cells: [7, 5], jitter: 0.2}}"}) {
    Bank bank = second();
    bank.mesh = mesh;
    run_well("second", bank);
    const Row start = first_row("second");
    for (const auto& [is, was] : std::vector<std::pair<Real, Real>>{{start.mass, end.mass},
                                                                    {start.kinetic, end.kinetic},
                                                                    {start.momentum_x, end.momentum_x},
                                                                    {start.momentum_y, end.momentum_y},
                                                                    {start.centre_x, end.centre_x},
                                                                    {start.centre_y, end.centre_y}})
      EXPECT_NEAR(is, was, 1e-13 * std::abs(was)) << mesh;
    EXPECT_EQ(first(history("second"), "time"), 0);
    EXPECT_EQ(first(history("second"), "deep_ux"), 0) << "displacement counts from here";
  }
  run_well("held", second(", velocity: zero"));
  EXPECT_EQ(first_row("held").kinetic, 0);
  EXPECT_EQ(first_row("held").momentum_x, 0);
}

TEST_F(Initial, DisplacementGoesOnIfAskedTo)
{
  run_well("first", {.when = "stages: [{type: geostatic, duration: 20, reset_displacement: false}]\n"});
  run_well("second", second(", displacement: keep"));
  EXPECT_EQ(first(history("second"), "deep_uy"), last(history("first"), "deep_uy"));
  EXPECT_LT(last(history("first"), "deep_uy"), -1e-4);
}

TEST_F(Initial, TakesBodiesByNameOrByList)
{
  const std::string two =
      "{name: left, material: soil, shape: {type: box, low: [0, 0], high: [1, 1]}, particles_per_cell: 3}, {name: right, "
      "material: soil, shape: {type: box, low: [2, 0], high: [3, 0.5]}, particles_per_cell: 4}";
  run_well("first", {.bodies = two, .when = "time: {end: 0.01}\n"});
  Bank bank = second(", bodies: [{body: bank, from: right}, {body: left}]");
  bank.bodies =
      "{name: bank, material: soil}, {name: new, material: soil, shape: {type: box, low: [1.25, 0], high: [1.75, 1]}, "
      "particles_per_cell: 1}, {name: left, material: soil}";
  run_well("second", bank);
  EXPECT_THAT(origin("second"), HasSubstr("\"bodies\":[{\"body\":\"bank\",\"from\":\"right\",\"particles\":64},"
                                          "{\"body\":\"left\",\"from\":\"left\",\"particles\":96}]"));
  const Outcome check = talus("check second.yaml");
  EXPECT_THAT(check.out, HasSubstr("body \"bank\": 64 particles\n  body \"new\": 16 particles\n  body \"left\": 96 particles\n"));
  EXPECT_THAT(check.out, HasSubstr("of \"Bank\":\n    body \"bank\": the 64 particles of \"right\"\n    body \"left\": the 96 particles of "
                                   "\"left\"\n"));
  bank = second();
  bank.bodies = "{name: right, material: soil}, {name: new, material: soil, shape: {type: box, low: [0, 0], high: [1, 1]}}";
  run_well("by_name", bank);
  EXPECT_THAT(origin("by_name"), HasSubstr("\"bodies\":[{\"body\":\"right\",\"from\":\"right\",\"particles\":64}]"));
}

TEST_F(Initial, SaysInTheSummaryWhereItCameFrom)
{
  run_well("first", {});
  run_well("second", second());
  const std::string said = origin("second");
  EXPECT_THAT(said, HasSubstr("\"file\":\"" + checkpoints("first").back().string() + "\",\"step\":"));
  EXPECT_THAT(said, HasSubstr("\"title\":\"Bank\",\"scene\":\"" + (folder_ / "first.yaml").string() + "\""));
  const auto value = [&](const std::string& key, const std::string& next) { return part("first", key, next).substr(key.size()); };
  EXPECT_THAT(said,
              HasSubstr("\"step\":" + value("],\"steps\":", ",\"simul") + ",\"time[s]\":" + value("\"simulated_time[s]\":", ",\"cost")));
  EXPECT_THAT(said, HasSubstr("\"commit\":" + value("\"commit\":", ",\"compiler")));
  EXPECT_THAT(said, HasSubstr("\"mesh_digest\":" + value("\"digest\":", ",\"quality")));
  EXPECT_EQ(origin("first"), "");
}

TEST_F(Initial, AnotherLawStartsFromTheStress)
{
  run_well("first", {});
  for (const std::string law :
       {"law: mohr_coulomb, density: 2000, youngs_modulus: 5.0e6, poisson_ratio: 0.2, friction_angle: 40, cohesion: 1.0e4",
        "law: linear_elastic, density: 2000, youngs_modulus: 5.0e6, poisson_ratio: 0.2",
        "law: modified_cam_clay, density: 2000, shear_modulus: 4.0e5, compression_index: 0.2, swelling_index: 0.05, critical_state_slope: "
        "1.1, preconsolidation_pressure: 1.0e4, reference_pressure: 5.0e4"}) {
    Bank bank = second();
    bank.material = law;
    const Outcome outcome = run("second", bank);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("the stress of body") != std::string::npos, law.find("cam_clay") != std::string::npos)
        << "there is some tension at the top, and only clay cannot hold any: " << outcome.err;
    const Row end = last_row("first"), start = first_row("second");
    EXPECT_NEAR(start.deep_syy, end.deep_syy, 1e-9 * std::abs(end.deep_syy)) << law;
    EXPECT_NEAR(start.mass, end.mass, 1e-13 * end.mass);
    EXPECT_NEAR(row_of(history("second"), 1).deep_syy, end.deep_syy, 0.05 * std::abs(end.deep_syy))
        << "no jump in the first steps: " << law;
  }
  Bank refused = second();
  refused.material = "law: neo_hookean, density: 2000, youngs_modulus: 2.0e6, poisson_ratio: 0.3";
  EXPECT_THAT(refusal(refused),
              HasSubstr("refused.yaml:5:10: error: bodies[0] \"bank\".material: the particles come from law "
                        "\"drucker_prager\", and law \"neo_hookean\" cannot start from their stress; of other laws "
                        "linear_elastic, drucker_prager, mohr_coulomb, modified_cam_clay, mu_i, von_mises or johnson_cook "
                        "can\n"));
}

/// Stiffer soil keeps its stress; rubber has the stress of its deformation, and says so.
TEST_F(Initial, OtherConstantsKeepTheStressWhereTheLawCan)
{
  run_well("first", {.material = strong});
  Bank stiffer = second();
  stiffer.material = strong;
  stiffer.material.replace(stiffer.material.find("2.0e6"), 5, "8.0e6");
  run_well("second", stiffer);
  const Row end = last_row("first");
  EXPECT_NEAR(first_row("second").deep_syy, end.deep_syy, 1e-9 * std::abs(end.deep_syy));
  EXPECT_NEAR(row_of(history("second"), 1).deep_syy, end.deep_syy, 0.05 * std::abs(end.deep_syy));

  const std::string rubber = "law: neo_hookean, density: 2000, poisson_ratio: 0.3, youngs_modulus: ";
  run_well("first", {.material = rubber + "2.0e6", .when = "stages: [{type: geostatic, duration: 20}]\n"});
  Bank softer = second();
  softer.material = rubber + "1.0e6";
  const Outcome outcome = run("second", softer);
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.err,
              HasSubstr("warning: second.yaml:5:10: the stress of body \"bank\" changes at the start, by up to 50 % of the "
                        "largest there: law \"neo_hookean\" makes another of the same state, with the constants of this scene\n"));
  EXPECT_NEAR(first_row("second").deep_syy, 0.5 * last_row("first").deep_syy, 1e-6 * std::abs(end.deep_syy));
}

TEST_F(Initial, StrengthThatHasSoftenedStaysSo)
{
  const std::string each = ", steps: 10, keep: 1000";
  run_well("first", {.when = "time: {end: 0.05}\n"});
  Bank bank = second(", velocity: zero");
  bank.checkpoint = each;
  run_well("second", bank);
  bank.material.replace(bank.material.find("2.0e6"), 5, "8.0e6");
  run_well("stiffer", bank);
  const auto before = by_id(checkpoints("first").back(), "laws/history/0/plastic_strain", 1);
  EXPECT_GT(*std::max_element(before.begin(), before.end()), 0.001);
  for (const std::string run : {"second", "stiffer"}) {
    const auto after = by_id(checkpoints(run).front(), "laws/history/0/plastic_strain", 1);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i)
      EXPECT_GE(after[i], before[i]) << run;
  }
}

/// Fluids and rubber know their stress by deformation and rate.
TEST_F(Initial, NotABitOfTheStressChangesUnderTheSameLaw)
{
  for (const std::string law : {"law: newtonian, density: 1000, bulk_modulus: 1.0e5, viscosity: 10",
                                "law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3", soil.c_str()}) {
    run_well("first", {.material = law, .when = "time: {end: 0.05}\n"});
    Bank bank = second();
    bank.material = law;
    run_well("second", bank);
    const auto before = read_particles(read_pvd(folder_ / "first/particles.pvd").back().second);
    const auto after = read_particles(read_pvd(folder_ / "second/particles.pvd").front().second);
    EXPECT_EQ(after.ids, before.ids);
    for (std::size_t k = 0; k < before.fields.size(); ++k)
      if (const std::string& name = before.fields[k].name; name != "displacement") {
        EXPECT_EQ(after.fields[k].values, before.fields[k].values) << name << " of " << law;
      }
    EXPECT_GT(std::abs(before.fields[3].values.at(0)), 100) << before.fields[3].name;
  }
}

TEST_F(Initial, MassFollowsTheDensityOfTheMaterial)
{
  run_well("first", {});
  Bank heavier = second();
  heavier.material.replace(heavier.material.find("density: 2000"), 13, "density: 2100");
  run_well("second", heavier);
  EXPECT_NEAR(first_row("second").mass, 1.05 * last_row("first").mass, 1e-12 * last_row("first").mass);
}

TEST_F(Initial, PrecisionIsThatOfTheScene)
{
  const std::string single = "precision: single\n";
  for (const bool from_single : {false, true}) {
    run_well("first", {.more = from_single ? single : ""});
    Bank bank = second();
    bank.more = from_single ? "" : single;
    run_well("second", bank);
    const Row end = last_row("first"), start = first_row("second");
    EXPECT_NEAR(start.deep_syy, end.deep_syy, 1e-6 * std::abs(end.deep_syy));
    EXPECT_NEAR(start.centre_y, end.centre_y, 1e-7 * end.centre_y);
  }
}

/// A column of its own for affine fields, averaged volumes or viscous pressure may be on one side only.
TEST_F(Initial, OtherTransfersAveragesAndViscosityAreNoHindrance)
{
  const std::string averaged = "{name: bank, material: soil, f_bar: true";
  for (const bool there : {true, false}) {
    const std::string viscous = soil + ", bulk_viscosity: {}", flip = "transfer: {scheme: flip}\n";
    run_well("first", {.more = there ? "" : flip,
                       .material = there ? viscous : soil,
                       .bodies = (there ? averaged : "{name: bank, material: soil") + ", " + filled + "}",
                       .when = "time: {end: 0.03}\n"});
    Bank bank = second();
    bank.more = there ? flip : "";
    bank.material = there ? soil : viscous;
    bank.bodies = (there ? "{name: bank, material: soil" : averaged) + "}";
    run_well("second", bank);
    EXPECT_NEAR(first_row("second").kinetic, last_row("first").kinetic, 1e-13 * last_row("first").kinetic);
  }
}

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
