// Standard tests of every law that has a strength or a viscosity in closed form: what is driven is what must be measured.
#include "materials/laboratory/laboratory.hpp"

#include <gtest/gtest.h>

#include "materials/interface/law_variant.hpp"
#include "tests/materials/soil.hpp"

namespace talus::laboratory_test {
namespace {

using testing::radians;
using testing::soft_soil;

template <class L>
Material one(const L& law)
{
  return make_material(law, 0, 1, "sample");
}
TestPlan plan_of(Laboratory test, Real strain, Index steps = 200)
{
  TestPlan plan = usual_plan(test);
  plan.strain = strain;
  plan.steps = steps;
  return plan;
}
Real value(const std::vector<ClosedForm>& forms, std::string_view name)
{
  for (const ClosedForm& form : forms)
    if (form.name == name)
      return form.value;
  ADD_FAILURE() << "there is no closed form " << name;
  return 0;
}
/// Peak stress driven over that of the law in closed form.
template <class L>
Real peak_ratio(const L& law, const TestPlan& plan)
{
  const TestResult result = perform(one(law), plan);
  const auto forms = closed_forms(AnyLaw(law), plan, result);
  if (forms.empty())
    return 0;
  EXPECT_EQ(result.stress[result.peak], *std::max_element(result.stress.begin(), result.stress.end()));
  return result.stress[result.peak] / forms.front().value;
}

MohrCoulomb planes(Real friction, Real cohesion, Real dilation)
{
  MohrCoulomb law;
  law.density = 2000;
  law.youngs_modulus = 1e7 * testing::stiffening;
  law.poisson_ratio = 0.3;
  law.friction_angle = friction;
  law.cohesion = cohesion;
  law.dilation_angle = dilation;
  return law;
}

TEST(Laboratory, StrengthOfSoilsIsThatOfTheFormulaInEveryTest)
{
  for (const Laboratory test : {Laboratory::triaxial_compression, Laboratory::triaxial_extension, Laboratory::uniaxial_strain_rate})
    for (const Real psi : {0.0, 8.0}) {
      const TestPlan plan = plan_of(test, 2e-11);
      for (const ConeMatch match : {ConeMatch::outer, ConeMatch::inner, ConeMatch::plane_strain})
        EXPECT_NEAR(peak_ratio(testing::soil(match, 30, 5e3, psi), plan), 1, 1e-8);
      EXPECT_NEAR(peak_ratio(planes(30, 5e3, psi), plan), 1, 1e-8);
    }
}

TEST(Laboratory, SimpleShearMobilisesTheStrengthOfCoaxialFlow)
{
  for (const Real psi : {0.0, 8.0}) {
    const TestPlan plan = plan_of(Laboratory::simple_shear, 3e-9, 1500);  // lateral stress follows slowly
    for (const ConeMatch match : {ConeMatch::outer, ConeMatch::inner, ConeMatch::plane_strain})
      EXPECT_NEAR(peak_ratio(testing::soil(match, 30, 5e3, psi), plan), 1, 1e-5);
    EXPECT_NEAR(peak_ratio(planes(30, 5e3, psi), plan), 1, 1e-5);
  }
}

TEST(Laboratory, ClosedFormsAreThePublishedNumbers)
{
  // phi 30, c 5 kPa under 100 kPa: 2 (c cos + p sin) / (1 -+ sin), and the cones' by hand.
  const auto soil = soft_soil(ConeMatch::inner, 30, 5e3);
  const auto forms = [&](Laboratory test) { return closed_forms(AnyLaw(soil), usual_plan(test), perform(one(soil), usual_plan(test))); };
  const auto compression = forms(Laboratory::triaxial_compression), extension = forms(Laboratory::triaxial_extension);
  EXPECT_EQ(compression.front().name, "drucker_prager");
  EXPECT_NEAR(compression.front().value, 130392.3, 0.05);
  EXPECT_NEAR(value(compression, "Mohr-Coulomb"), 217320.5, 0.05);
  EXPECT_NEAR(value(compression, "Drucker-Prager outer"), 217320.5, 0.05);
  EXPECT_NEAR(value(compression, "Drucker-Prager inner"), 130392.3, 0.05);
  EXPECT_NEAR(value(extension, "Mohr-Coulomb"), 72440.2, 0.05);
  EXPECT_NEAR(value(extension, "Drucker-Prager inner"), 72440.2, 0.05);
  const auto sand = soft_soil(ConeMatch::outer, 30, 0);
  const TestPlan plan = usual_plan(Laboratory::simple_shear);
  const auto shear = closed_forms(AnyLaw(sand), plan, perform(one(sand), plan));
  EXPECT_NEAR(std::atan(value(shear, "Drucker-Prager outer") / plan.pressure) / radians(1), 34.72, 0.005);
  EXPECT_NEAR(std::atan(value(shear, "Drucker-Prager inner") / plan.pressure) / radians(1), 26.33, 0.005);
  EXPECT_NEAR(value(shear, "Mohr-Coulomb") / plan.pressure, 0.5, 1e-12) << "sin(30): the planes slip under 45 degrees without dilation";
}

TEST(Laboratory, OedometerMeasuresElasticEarthPressureOrThatOfTheStrength)
{
  const auto check = [](const auto& law, const TestPlan& plan) {
    const TestResult result = perform(one(law), plan);
    const auto forms = closed_forms(AnyLaw(law), plan, result);
    EXPECT_NEAR(result.lateral_over_vertical, forms.front().value, 1e-8);
    return result.lateral_over_vertical;
  };
  const TestPlan plan = plan_of(Laboratory::oedometer, 2e-12);
  EXPECT_NEAR(check(testing::soil(ConeMatch::outer, 30, 0), plan), 0.3 / 0.7, 1e-8);
  EXPECT_NEAR(check(testing::soil(ConeMatch::inner, 30, 0), plan), 0.454545, 1e-6);
  EXPECT_NEAR(check(planes(15, 0, 0), plan), (1 - std::sin(radians(15))) / (1 + std::sin(radians(15))), 1e-8);
  TestPlan pressed = plan_of(Laboratory::oedometer, 2e-10);
  pressed.pressure = 5e4;
  check(testing::soil(ConeMatch::plane_strain, 20, 3e3, 5), pressed);
  check(planes(20, 3e3, 5), pressed);
}

TEST(Laboratory, TensionCutoffLimitsTheStrengthInExtension)
{
  const TestPlan plan = plan_of(Laboratory::uniaxial_strain_rate, 1e-9);
  DruckerPrager cone = testing::soil(ConeMatch::outer, 30, 5e3);
  cone.tension_cutoff = 1e3;
  MohrCoulomb law = planes(30, 5e3, 0);
  law.tension_cutoff = 1e3;
  EXPECT_NEAR(peak_ratio(cone, plan), 1, 1e-8);
  EXPECT_NEAR(peak_ratio(law, plan), 1, 1e-8);
  EXPECT_NEAR(closed_forms(AnyLaw(cone), plan, perform(one(cone), plan)).front().value, 3e3, 1e-9 * 3e3);
}

TEST(Laboratory, FluidsShowTheirViscosityInShearAndThreeTimesItInExtension)
{
  Newtonian oil;
  oil.density = 900;
  oil.bulk_modulus = 1e9;
  oil.viscosity = 30;
  HerschelBulkley mud;
  mud.density = 1600;
  mud.bulk_modulus = 1e9;
  mud.yield_stress = 40, mud.consistency = 7, mud.flow_index = 0.4, mud.regularisation = 10;
  for (const Laboratory test : {Laboratory::simple_shear, Laboratory::triaxial_compression}) {
    TestPlan plan = plan_of(test, 0.05, 200);
    plan.rate = 2;
    EXPECT_NEAR(peak_ratio(oil, plan), 1, 2e-4);  // half the strain of a step
    EXPECT_NEAR(peak_ratio(mud, plan), 1, 2e-4);
  }
}

TEST(Laboratory, GranularFlowShowsTheFrictionOfItsRate)
{
  MuI law = testing::sample<MuI>();
  *law.youngs_modulus = 1e10;
  TestPlan plan = plan_of(Laboratory::simple_shear, 0.01, 1000);
  plan.rate = 400;
  EXPECT_NEAR(peak_ratio(law, plan), 1, 1e-5);
}

TEST(Laboratory, CriticalStateOfCamClayIsReachedInCompressionAndShear)
{
  const ModifiedCamClay law = testing::sample<ModifiedCamClay>();
  for (const Laboratory test : {Laboratory::triaxial_compression, Laboratory::simple_shear}) {
    TestPlan plan = plan_of(test, 3, 2000);  // hardening leads there slowly
    EXPECT_NEAR(peak_ratio(law, plan), 1, 0.02);
  }
  CohesiveCamClay firn = testing::sample<CohesiveCamClay>();
  firn.bulk_modulus = 1e9;  // small strains: Kirchhoff and Cauchy stress are nearly equal
  firn.shear_modulus = 1e9;
  firn.youngs_modulus.reset(), firn.poisson_ratio.reset();
  TestPlan plan = plan_of(Laboratory::triaxial_compression, 0.03, 2000);
  EXPECT_NEAR(peak_ratio(firn, plan), 1, 0.02);
}

TEST(Laboratory, MetalHardensAlongItsCurve)
{
  VonMises steel;
  steel.density = 7800;
  steel.youngs_modulus = 210e12;  // a thousand times that of steel: elastic strains vanish
  steel.poisson_ratio = 0.3;
  steel.yield_stress = 250e6;
  steel.power = PowerHardening{.coefficient = 500e6, .exponent = 0.3};
  steel.rate = CowperSymonds{.reference_rate = 40, .exponent = 5};
  TestPlan plan = plan_of(Laboratory::uniaxial_strain_rate, 0.2, 1000);
  plan.rate = 10;
  EXPECT_NEAR(peak_ratio(steel, plan), 1, 1e-3);
  plan = plan_of(Laboratory::simple_shear, 0.3, 1000);
  plan.rate = 10;
  EXPECT_NEAR(peak_ratio(steel, plan), 1, 1e-3);
  steel.yield_stress = 1e15;
  plan = plan_of(Laboratory::uniaxial_strain_rate, 1e-6, 10);
  EXPECT_NEAR(closed_forms(AnyLaw(steel), plan, perform(one(steel), plan)).front().value, 210e6, 1) << "it stays elastic";
}

TEST(Laboratory, ElasticSolidsHaveNoStrengthButCanBeDriven)
{
  const auto rubber = testing::sample<NeoHookean>();
  const TestPlan plan = plan_of(Laboratory::triaxial_compression, 0.01, 20);
  const TestResult result = perform(one(rubber), plan);
  EXPECT_TRUE(closed_forms(AnyLaw(rubber), plan, result).empty());
  ASSERT_EQ(result.strain.size(), 21u);
  EXPECT_EQ(result.strain.front(), 0);
  EXPECT_NEAR(result.strain.back(), 0.01, 1e-12);
  EXPECT_NEAR(result.stress.front(), 0, 1e-6) << "consolidated under equal stresses";
  EXPECT_NEAR(result.table.rows.front().p, 1e5, 1e-3);
  EXPECT_NEAR(result.stress.back(), 1e5, 3e3);  // E times strain
}

}  // namespace
}  // namespace talus::laboratory_test
