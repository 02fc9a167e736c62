// A scene that begins as another run left it: the same state, what may differ, and what is refused.
#include "tests/app/setup/bank_that_begins_elsewhere.hpp"

namespace talus::initial_test {
namespace {

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
              HasSubstr("refused.yaml:5:10: error: bodies[0] \"bank\".material: the particles come from law \"drucker_prager\", and law "
                        "\"neo_hookean\" cannot start from their stress; of other laws linear_elastic, viscoelastic, drucker_prager, "
                        "mohr_coulomb, modified_cam_clay, cohesive_cam_clay, snow, mu_i, elastic_herschel_bulkley, von_mises, "
                        "johnson_cook, mechanical_threshold or porous_ductile can\n"));
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

}  // namespace
}  // namespace talus::initial_test
