#include "materials/laboratory/laboratory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "materials/interface/law_variant.hpp"

namespace talus {

namespace {

constexpr Real root3 = std::numbers::sqrt3;

Controls consolidation(const TestPlan& plan, bool fluid)
{
  const Control pressed{Controlled::stress, -plan.pressure};
  if (fluid)  // bears one pressure only: it need not be told thrice
    return {.yy = pressed};
  return {.xx = pressed, .yy = pressed, .zz = pressed};
}

Controls controls_of(const TestPlan& plan)
{
  const Control pressed{Controlled::stress, -plan.pressure};
  const auto axial = [](Real rate) { return Control{Controlled::strain_rate, rate}; };
  switch (plan.test) {
    case Laboratory::triaxial_compression: return {.xx = pressed, .yy = pressed, .zz = axial(-plan.rate)};
    case Laboratory::triaxial_extension:
    case Laboratory::uniaxial_strain_rate: return {.xx = pressed, .yy = pressed, .zz = axial(plan.rate)};
    case Laboratory::simple_shear: return {.yy = pressed, .xy = Control{Controlled::velocity_gradient, plan.rate}};
    case Laboratory::oedometer: return {.zz = axial(-plan.rate)};
  }
  return {};
}

/// Strengths of a frictional soil in the tests, by its parameters.
struct Soil {
  Real sine, cosine, cohesion, sin_psi;
  Real peak_stress(const TestPlan& plan) const noexcept
  {
    const Real P = plan.pressure, triaxial = 2 * (cohesion * cosine + P * sine);
    switch (plan.test) {
      case Laboratory::triaxial_compression: return triaxial / (1 - sine);
      case Laboratory::triaxial_extension:
      case Laboratory::uniaxial_strain_rate: return triaxial / (1 + sine);
      case Laboratory::simple_shear:  // coaxial flow without strain along x: Davis 1968, in Soil Mechanics: Selected Topics
        return (cohesion * cosine + P * sine) * std::sqrt(1 - sin_psi * sin_psi) / (1 - sine * sin_psi);
      case Laboratory::oedometer: break;
    }
    return 0;
  }
  /// Smallest lateral stress under a vertical stress [Pa], compression positive.
  Real active(Real vertical) const noexcept { return (vertical * (1 - sine) - 2 * cohesion * cosine) / (1 + sine); }
};

/// The same of a cone with flow q_psi: tau = k + q p on the stress paths of the tests.
Real peak_stress(const Cone& cone, Real q_psi, const TestPlan& plan) noexcept
{
  const Real start = cone.k + cone.q * plan.pressure;
  switch (plan.test) {
    case Laboratory::triaxial_compression: return root3 * start / (1 - cone.q / root3);
    case Laboratory::triaxial_extension:
    case Laboratory::uniaxial_strain_rate: return root3 * start / (1 + cone.q / root3);
    case Laboratory::simple_shear: return start * std::sqrt(1 - 4 * q_psi * q_psi / 3) / (1 - 4 * cone.q * q_psi / 3);
    case Laboratory::oedometer: break;
  }
  return 0;
}
Real active(const Cone& cone, Real vertical) noexcept
{
  return (vertical * (1 / root3 - cone.q / 3) - cone.k) / (1 / root3 + 2 * cone.q / 3);
}

/// s_xx / s_zz of an oedometer: elastic unless that is less than the strength allows.
Real earth_pressure(Real poisson_ratio, Real pressure, Real vertical, Real least_lateral)
{
  const Real elastic = pressure + (vertical - pressure) * poisson_ratio / (1 - poisson_ratio);
  return std::max(elastic, least_lateral) / vertical;
}

/// Largest deviator of an extension whose mean or axial stress is cut off; infinite without a limit of tension.
Real cut(const TestPlan& plan, const std::optional<Real>& tension_cutoff, Real by_pressure)
{
  const bool pulled = plan.test == Laboratory::triaxial_extension || plan.test == Laboratory::uniaxial_strain_rate;
  return pulled && tension_cutoff ? by_pressure * (plan.pressure + *tension_cutoff) : std::numeric_limits<Real>::infinity();
}

template <class Law>
std::vector<ClosedForm> forms_of_soil(const Law& law, const TestPlan& plan, Real vertical)
{
  const Real degree = std::numbers::pi / 180, phi = law.friction_angle * degree;
  const Soil soil{std::sin(phi), std::cos(phi), law.cohesion, std::sin(law.dilation_angle * degree)};
  const bool oedometer = plan.test == Laboratory::oedometer;
  const auto k0 = [&](Real least) { return earth_pressure(law.moduli().poisson, plan.pressure, vertical, least); };
  const auto of_cone = [&](const DruckerPrager& cone) {
    const Cone peak = cone.cone_of(law.friction_angle, law.cohesion);
    return oedometer ? k0(active(peak, vertical)) : peak_stress(peak, cone.dilation_slope(), plan);
  };
  const Real mohr_coulomb = oedometer ? k0(soil.active(vertical)) : soil.peak_stress(plan);

  std::vector<ClosedForm> forms;
  if constexpr (std::is_same_v<Law, DruckerPrager>)
    forms.push_back({std::string(Law::name), std::min(of_cone(law), cut(plan, law.tension_cutoff, 3))});
  else
    forms.push_back({std::string(Law::name), std::min(mohr_coulomb, cut(plan, law.tension_cutoff, 1))});
  forms.push_back({"Mohr-Coulomb", mohr_coulomb});
  for (const ConeMatch match : {ConeMatch::outer, ConeMatch::inner, ConeMatch::plane_strain}) {
    DruckerPrager cone;
    cone.match = match;
    cone.dilation_angle = law.dilation_angle;
    forms.push_back({fmt::format("Drucker-Prager {}", enum_names(match)[static_cast<std::size_t>(match)]), of_cone(cone)});
  }
  return forms;
}

std::vector<ClosedForm> forms(const DruckerPrager& law, const TestPlan& plan, Real vertical) { return forms_of_soil(law, plan, vertical); }
std::vector<ClosedForm> forms(const MohrCoulomb& law, const TestPlan& plan, Real vertical) { return forms_of_soil(law, plan, vertical); }

/// At critical state p is known from the stress path, and q is M p.
std::vector<ClosedForm> critical_state(std::string_view law, Real M, const TestPlan& plan)
{
  const Real P = plan.pressure;
  const auto form = [&](Real stress) { return std::vector<ClosedForm>{{fmt::format("{}, critical state", law), stress}}; };
  switch (plan.test) {
    case Laboratory::triaxial_compression: return form(3 * M * P / (3 - M));
    case Laboratory::triaxial_extension: return form(3 * M * P / (3 + M));
    case Laboratory::simple_shear: return form(M * P / root3);
    default: return {};
  }
}
std::vector<ClosedForm> forms(const ModifiedCamClay& law, const TestPlan& plan, Real)
{
  return critical_state(law.name, law.critical_state_slope, plan);
}
std::vector<ClosedForm> forms(const CohesiveCamClay& law, const TestPlan& plan, Real)
{
  const Real slope = law.critical_slope();
  return slope < 3 ? critical_state(law.name, slope, plan) : std::vector<ClosedForm>{};
}

/// Strain at the end is plastic but for stress over modulus; the rate is taken as plastic.
std::vector<ClosedForm> forms(const VonMises& law, const TestPlan& plan, Real)
{
  if (plan.test == Laboratory::oedometer)
    return {};
  const bool shear = plan.test == Laboratory::simple_shear;
  const Real ratio = shear ? 1 / root3 : 1, modulus = shear ? law.moduli().shear : law.moduli().youngs;
  Real stress = 0;
  constexpr int iterations = 100;  // a contraction by hardening over stiffness each
  for (int i = 0; i < iterations; ++i)
    stress = ratio * law.flow_stress(std::max(ratio * (plan.strain - stress / modulus), Real{0}), ratio * plan.rate);
  return {{fmt::format("{}, at the end", law.name), std::min(stress, modulus * plan.strain)}};
}

std::vector<ClosedForm> forms(const MuI& law, const TestPlan& plan, Real)
{
  if (plan.test != Laboratory::simple_shear || !(plan.pressure > 0))
    return {};
  const Real inertial = plan.rate * law.grain_diameter * std::sqrt(law.grain_density / plan.pressure);
  return {{"mu(I) p", law.friction(inertial) * plan.pressure}};
}

/// A viscosity by shear rate: s_xy = eta g, and q = 3 eta e with g = sqrt(3) e in the triaxial test.
template <class F>
std::vector<ClosedForm> forms_of_fluid(const TestPlan& plan, F&& viscosity)
{
  switch (plan.test) {
    case Laboratory::oedometer: return {};
    case Laboratory::simple_shear: return {{"viscosity times rate", viscosity(plan.rate) * plan.rate}};
    default: return {{"3 viscosity times rate", 3 * viscosity(root3 * plan.rate) * plan.rate}};
  }
}
std::vector<ClosedForm> forms(const Newtonian& law, const TestPlan& plan, Real)
{
  return forms_of_fluid(plan, [&](Real) { return law.viscosity; });
}
std::vector<ClosedForm> forms(const HerschelBulkley& law, const TestPlan& plan, Real)
{
  return forms_of_fluid(plan, [&](Real rate) { return law.viscosity(rate, law.constants()); });
}

template <class Law>
concept HasForms = requires(const Law law, const TestPlan& plan)
{
  forms(law, plan, Real{});
};

}  // namespace

TestPlan usual_plan(Laboratory test)
{
  TestPlan plan{.test = test, .pressure = 1e5, .strain = 0.2, .rate = 1e-3, .steps = 500};
  if (test == Laboratory::simple_shear)
    plan.strain = 0.5;
  if (test == Laboratory::oedometer)
    plan.strain = 0.05;
  if (test == Laboratory::oedometer || test == Laboratory::uniaxial_strain_rate)
    plan.pressure = 0;
  return plan;
}

Real measured_stress(Laboratory test, const Mat3& stress)
{
  switch (test) {
    case Laboratory::simple_shear: return std::abs(stress(0, 1));
    case Laboratory::oedometer: return -stress(2, 2);
    default: return std::abs(stress(2, 2) - stress(0, 0));
  }
}

TestResult perform(const Material& material, const TestPlan& plan)
{
  std::vector<PointPath> paths;
  Mat3 start = Mat3::Zero();
  Index before = 0;
  Material probe = material;
  if (const Mat3 pressed = -plan.pressure * Mat3::Identity(); plan.pressure > 0 && probe.prestress(0, pressed)) {
    start = pressed;
  } else if (plan.pressure > 0) {
    constexpr Real slowly = 1e6;  // s: no viscous stress is left
    paths.push_back({.time = slowly, .controls = consolidation(plan, material.law().description().is_fluid)});
    before = paths.front().steps;
  }
  paths.push_back({.steps = plan.steps, .time = plan.strain / plan.rate, .controls = controls_of(plan)});

  TestResult result;
  result.table = drive(material, paths, start);
  auto& rows = result.table.rows;
  rows.erase(rows.begin(), rows.begin() + before);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Real share = static_cast<Real>(i) / plan.steps;
    rows[i].time = share * plan.strain / plan.rate;
    result.strain.push_back(share * plan.strain);
    result.stress.push_back(measured_stress(plan.test, rows[i].stress));
  }
  result.peak = static_cast<std::size_t>(std::max_element(result.stress.begin(), result.stress.end()) - result.stress.begin());
  result.lateral_over_vertical = rows.back().stress(0, 0) / rows.back().stress(2, 2);
  return result;
}

std::vector<ClosedForm> closed_forms(const AnyLaw& law, const TestPlan& plan, const TestResult& result)
{
  return std::visit(
      [&]<class L>(const L& parameters) -> std::vector<ClosedForm> {
        if constexpr (HasForms<L>)
          return forms(parameters, plan, result.stress.back());
        else
          return {};
      },
      choices_of(law));
}

}  // namespace talus
