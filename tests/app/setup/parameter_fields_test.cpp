// Parameters that vary in space: what particles get, what later stages and other runs make of it, and what is refused.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "io/output/vtk.hpp"
#include "materials/variation/parameter_variation.hpp"
#include "tests/app/program.hpp"

namespace talus::parameter_fields_test {
namespace {

using testing::HasSubstr;

const std::string usual = "{parameter: yield_stress, coefficient_of_variation: 0.5, correlation_length: [2, 0.5], seed: 7}";

struct GroundScene {
  std::string variation = usual;
  std::string law = "law: von_mises, density: 2000, youngs_modulus: 2.0e7, poisson_ratio: 0.3, yield_stress: 2.0e4";
  std::string materials = "";  ///< more of them
  std::string filling = "shape: {type: box, low: [0, 0], high: [4, 1]}, particles_per_cell: 3";
  std::string more = "";
  std::string stages = "time: {end: 0.1}\n";
  std::string cells = "[16, 6]";
  std::string text() const
  {
    return "title: Ground\ndimension: 2\nmesh: {grid: {low: [0, 0], high: [4, 1.5], cells: " + cells + "}}\nmaterials:\n  - {name: clay, " +
           law + (variation.empty() ? "" : ", variation: [" + variation + "]") + "}\n" + materials +
           "bodies: [{name: ground, material: clay" + (filling.empty() ? "" : ", ") + filling + "}]\n" + more +
           "loads: [{type: gravity, acceleration: [0, -9.81]}]\nboundaries: [{type: roller, on: x_min}, {type: fixed, on: y_min}]\n" +
           stages + "outputs: {particles: {every: 0.05, fields: [displacement" +
           (variation.find("{parameter: youngs_modulus") == std::string::npos ? "" : ", yield_stress_factor, youngs_modulus_factor") +
           "]}, history: {every: 0.05}, checkpoint: {at_end: true}}\n";
  }
};

const std::string stiff = ", {parameter: youngs_modulus, coefficient_of_variation: 0.1, correlation_length: [1]}";

class ParameterFields : public Program {
 protected:
  using Values = std::map<std::int64_t, Real>;

  Outcome run(const GroundScene& scene, const std::string& out = "out", const std::string& words = "")
  {
    write("scene.yaml", scene.text());
    return talus("run scene.yaml --quiet --out " + out + " " + words);
  }
  void run_well(const GroundScene& scene, const std::string& out = "out", const std::string& words = "")
  {
    const Outcome outcome = run(scene, out, words);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  StoredParticles frame(const std::string& out, bool last) const
  {
    const auto frames = read_pvd(folder_ / (out + "/particles.pvd"));
    return read_particles(last ? frames.back().second : frames.front().second);
  }
  Values factors(const std::string& out, bool last = false, const std::string& field = "yield_stress_factor") const
  {
    const StoredParticles stored = frame(out, last);
    Values values;
    for (std::size_t p = 0; p < stored.ids.size(); ++p)
      values[stored.ids[p]] = stored_field(stored, field)->values[p];
    return values;
  }
  std::string refusal(const GroundScene& scene)
  {
    write("scene.yaml", scene.text());
    const Outcome outcome = talus("check scene.yaml");
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    return outcome.err;
  }
};

TEST_F(ParameterFields, EveryParticleHasTheValueOfItsPlace)
{
  ParameterVariation entry;
  entry.parameter = "yield_stress";
  entry.coefficient_of_variation = 0.5;
  entry.correlation_length = {2, 0.5};
  entry.seed = 7;
  const VariationFields fields{std::array{entry}};
  for (const std::string cells : {"[16, 6]", "[9, 5]"}) {  // places of other particles
    run_well({.variation = usual + stiff, .cells = cells});
    const StoredParticles stored = frame("out", false);
    const std::vector<Real>&x = stored_field(stored, "position")->values, &factor = stored_field(stored, "yield_stress_factor")->values;
    ASSERT_GT(stored.ids.size(), 100U);
    Real least = HUGE_VAL, most = 0;
    for (std::size_t p = 0; p < stored.ids.size(); ++p) {
      Real expected = 0;
      fields(Vec3(x[3 * p], x[3 * p + 1], 0), std::span(&expected, 1));
      // A file has single precision, and waves of the exponential covariance are short.
      EXPECT_NEAR(factor[p], expected, 2e-3 * expected);
      least = std::min(least, expected), most = std::max(most, expected);
    }
    EXPECT_GT(most, 1.5 * least);
  }
}

TEST_F(ParameterFields, AreTheSameOnAnyThreadsAndOthersForAnotherSeed)
{
  run_well({.variation = usual + stiff}, "one", "--threads 1");
  run_well({.variation = usual + stiff}, "four", "--threads 4");
  run_well({.variation = usual + stiff}, "other", "--set materials[0].variation[0].seed=8");
  EXPECT_EQ(factors("one", true), factors("four", true));
  EXPECT_EQ(factors("one"), factors("one", true)) << "they do not change in a run";
  EXPECT_NE(factors("one"), factors("other"));
  EXPECT_EQ(factors("one", false, "youngs_modulus_factor"), factors("other", false, "youngs_modulus_factor"));
}

TEST_F(ParameterFields, FollowATrendBetweenLimits)
{
  run_well({.variation = "{parameter: yield_stress, coefficient_of_variation: 0, trend: \"1 + 2 * (1 - y)\", minimum: 3.0e4, maximum: "
                         "5.0e4}" +
                         stiff});
  const StoredParticles stored = frame("out", false);
  const std::vector<Real>&x = stored_field(stored, "position")->values, &factor = stored_field(stored, "yield_stress_factor")->values;
  for (std::size_t p = 0; p < stored.ids.size(); ++p)
    EXPECT_NEAR(factor[p], std::clamp(1 + 2 * (1 - x[3 * p + 1]), 1.5, 2.5), 1e-6);
}

/// Four times as stiff, steps are half as long: the time step knows the stiffest particle.
TEST_F(ParameterFields, TheTimeStepFollowsTheStiffestParticle)
{
  const auto steps = [&](const std::string& trend) {
    run_well({.variation = usual + ", {parameter: youngs_modulus, coefficient_of_variation: 0, trend: \"" + trend + "\"}"});
    return last(history("out"), "step");
  };
  const Real plain = steps("1 + 1e-9 * x"), stiffer = steps("x > 3.8 && y < 0.2 ? 4 : 1");
  EXPECT_NEAR(stiffer / plain, 2, 0.1);
}

TEST_F(ParameterFields, StayWhereTheStrengthIsDividedAndBeginAnewWithAnotherMaterial)
{
  const std::string other =
      "  - {name: gravel, law: von_mises, density: 2000, youngs_modulus: 2.0e7, poisson_ratio: 0.3, yield_stress: "
      "1.0e4, variation: [{parameter: yield_stress, coefficient_of_variation: 0.5, correlation_length: [2, 0.5], seed: "
      "8}, {parameter: youngs_modulus, coefficient_of_variation: 0.1, correlation_length: [1]}]}\n";
  const std::string stages = "stages: [{type: run, duration: 0.2}, {type: run, duration: 0.05, ";
  run_well({.variation = usual + stiff, .materials = other, .stages = stages + "weaken: [{factor: 1.5}]}]\n"}, "weaker");
  EXPECT_EQ(factors("weaker"), factors("weaker", true));
  run_well({.variation = usual + stiff, .materials = other, .stages = stages + "change: [{body: ground, material: gravel}]}]\n"},
           "changed");
  EXPECT_NE(factors("changed"), factors("changed", true));
}

TEST_F(ParameterFields, AreCarriedToAnotherRunUnlessThatAsksForOthers)
{
  run_well({.variation = usual + stiff, .stages = "time: {end: 0.3}\n"}, "first");
  GroundScene second{.variation = usual + stiff, .filling = "", .more = "initial: {from: first}\n"};
  run_well(second, "second");
  EXPECT_EQ(factors("first", true), factors("second", true));
  run_well(second, "other", "--set materials[0].variation[0].seed=8");
  EXPECT_NE(factors("first", true), factors("other", true));
}

TEST_F(ParameterFields, RefuseValuesThatTheLawDoesNotTake)
{
  EXPECT_THAT(
      refusal({.variation = "{parameter: poisson_ratio, distribution: normal, coefficient_of_variation: 0.5, correlation_length: [1]}",
               .filling = "shape: {type: box, low: [0, 0], high: [4, 1]}"}),
      testing::AllOf(HasSubstr("scene.yaml:5:"), HasSubstr("the law does not take the values at "), HasSubstr("poisson_ratio is "),
                     HasSubstr("but must be (-1, 0.5)")));
  EXPECT_THAT(refusal({.variation = "{parameter: yield_stress, coefficient_of_variation: 0, trend: \"1 + depth\"}"}),
              HasSubstr("variation[0].trend"));
}

}  // namespace
}  // namespace talus::parameter_fields_test
