#pragma once
// Parameters of every law for tools that run over all laws: `talus bench`, contract tests, scenes of tests.  A law without an example does
// not compile.
#include "materials/laws.hpp"

namespace talus {

/// Young's modulus of every example, or the equivalent stiffness [Pa].
inline constexpr Real example_stiffness = 1e7;

/// A law with its required parameters only.  A block yields, if the law can, under strains of a per cent.
template <class L>
L law_example() = delete;

namespace detail {
template <class L>
L elastic_example(Real density = 2000)
{
  L law{};
  law.density = density;
  law.youngs_modulus = example_stiffness;
  law.poisson_ratio = 0.3;
  return law;
}
template <class L>
L soil_example()
{
  auto law = elastic_example<L>();
  law.friction_angle = 30;
  law.cohesion = 5e3;
  return law;
}
}  // namespace detail

template <>
inline LinearElastic law_example()
{
  return detail::elastic_example<LinearElastic>();
}
template <>
inline NeoHookean law_example()
{
  return detail::elastic_example<NeoHookean>();
}
template <>
inline Corotated law_example()
{
  return detail::elastic_example<Corotated>();
}
template <>
inline Hencky law_example()
{
  return detail::elastic_example<Hencky>();
}
template <>
inline Viscoelastic law_example()
{
  auto law = detail::elastic_example<Viscoelastic>();
  law.relaxing_share = 0.4;
  law.relaxation_time = 0.01;
  return law;
}
template <>
inline LinearFirstPiola law_example()
{
  return detail::elastic_example<LinearFirstPiola>();
}
template <>
inline DruckerPrager law_example()
{
  auto law = detail::soil_example<DruckerPrager>();
  law.match = ConeMatch::plane_strain;
  return law;
}
template <>
inline MohrCoulomb law_example()
{
  return detail::soil_example<MohrCoulomb>();
}
template <>
inline ModifiedCamClay law_example()
{
  ModifiedCamClay law;
  law.density = 1800;
  law.shear_modulus = 4e6;
  law.compression_index = 0.2;
  law.swelling_index = 0.05;
  law.critical_state_slope = 1.1;
  law.preconsolidation_pressure = 1e5;
  law.reference_pressure = 0.05 * example_stiffness;
  return law;
}
template <>
inline CohesiveCamClay law_example()
{
  auto law = detail::elastic_example<CohesiveCamClay>(250);
  law.critical_state_slope = 1.1;
  law.cohesion_ratio = 0.3;
  law.preconsolidation_pressure = 1e5;
  law.hardening_factor = 2;
  return law;
}
template <>
inline Snow law_example()
{
  auto law = detail::elastic_example<Snow>(400);
  law.critical_compression = 0.01;
  law.critical_stretch = 0.004;
  law.hardening = 5;
  return law;
}
template <>
inline MuI law_example()
{
  auto law = detail::elastic_example<MuI>(1500);
  law.static_friction = 0.5;
  law.limiting_friction = 0.7;
  law.inertial_number = 0.279;
  law.grain_diameter = 0.5e-3;
  law.grain_density = 2500;
  return law;
}
template <>
inline Newtonian law_example()
{
  Newtonian law;
  law.density = 1000;
  law.bulk_modulus = example_stiffness;
  law.viscosity = 5;
  return law;
}
template <>
inline HerschelBulkley law_example()
{
  HerschelBulkley law;
  law.density = 1600;
  law.bulk_modulus = example_stiffness;
  law.yield_stress = 50;
  law.consistency = 4;
  law.flow_index = 0.5;
  law.regularisation = 1;
  return law;
}
template <>
inline ElasticHerschelBulkley law_example()  // fresh concrete of low slump
{
  auto law = detail::elastic_example<ElasticHerschelBulkley>(2300);
  law.yield_stress = 2e3;
  law.consistency = 150;
  law.flow_index = 0.8;
  return law;
}
template <>
inline VonMises law_example()
{
  auto law = detail::elastic_example<VonMises>();
  law.yield_stress = 4e4;
  law.hardening_modulus = 1e4;
  return law;
}
template <>
inline JohnsonCook law_example()
{
  auto law = detail::elastic_example<JohnsonCook>();
  law.yield_stress = 4e4;
  law.hardening_coefficient = 1e4;
  law.hardening_exponent = 0.3;
  law.rate_coefficient = 0.02;
  law.thermal_exponent = 1.05;
  law.room_temperature = 294;
  law.melting_temperature = 1400;
  law.specific_heat = 0.02;  // heating of some kelvin per per cent of plastic strain, in spite of the low strength
  return law;
}

template <>
inline MechanicalThreshold law_example()
{
  auto law = detail::elastic_example<MechanicalThreshold>();
  law.athermal_stress = 2e4;
  law.shear_at_zero_kelvin = 4e6;
  law.shear_loss = 3e5;
  law.shear_temperature = 180;
  law.boltzmann_over_burgers_cubed = 70;
  law.activation_energy = 1.6;
  law.activation_rate = 1e7;
  law.activation_p = 2.0 / 3;
  law.activation_q = 1;
  law.hardening_modulus = 2e5;
  law.hardening_shape = 2;
  law.saturation_stress = 7e4;
  law.saturation_energy = 0.26;
  law.saturation_rate = 1e7;
  law.specific_heat = 0.02;
  law.initial_temperature = 294;
  return law;
}
template <>
inline PorousDuctile law_example()
{
  auto law = detail::elastic_example<PorousDuctile>();
  law.yield_stress = 4e4;
  law.initial_porosity = 0.01;
  return law;
}

template <class L>
concept HasExample = requires
{
  law_example<L>();
};
static_assert([]<class... L>(TypeList<L...>) { return (HasExample<L> && ...); }(Laws{}), "give each law of Laws its law_example()");

}  // namespace talus
