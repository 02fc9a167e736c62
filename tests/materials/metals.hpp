#pragma once
// Metals for the tests of plasticity and impact.
#include "tests/materials/samples.hpp"

namespace talus::testing {

/// OFHC copper.       [Johnson & Cook 1983, 7th Int. Symp. Ballistics; 1985, Eng. Fract. Mech. 21, 31]
inline JohnsonCook copper()
{
  JohnsonCook law;
  law.density = 8960;
  law.bulk_modulus = 129e9;
  law.shear_modulus = 46e9;
  law.yield_stress = 90e6;
  law.hardening_coefficient = 292e6;
  law.hardening_exponent = 0.31;
  law.rate_coefficient = 0.025;
  law.thermal_exponent = 1.09;
  law.room_temperature = 294;
  law.melting_temperature = 1356;
  law.specific_heat = 383;
  return law;
}
inline constexpr JohnsonCookDamage copper_damage{.d1 = 0.54, .d2 = 4.89, .d3 = -3.03, .d4 = 0.014, .d5 = 1.12};
inline constexpr MieGruneisen copper_shock{.c0 = 3940, .s = 1.489, .gamma = 2.02};

/// Steel 4340, of the same sources.
inline JohnsonCook steel()
{
  JohnsonCook law;
  law.density = 7830;
  law.bulk_modulus = 173.33e9;
  law.shear_modulus = 80e9;
  law.yield_stress = 792e6;
  law.hardening_coefficient = 510e6;
  law.hardening_exponent = 0.26;
  law.rate_coefficient = 0.014;
  law.thermal_exponent = 1.03;
  law.room_temperature = 294;
  law.melting_temperature = 1793;
  law.specific_heat = 477;
  return law;
}
inline constexpr JohnsonCookDamage steel_damage{.d1 = 0.05, .d2 = 3.44, .d3 = -2.12, .d4 = 0.002, .d5 = 0.61};
inline constexpr MieGruneisen steel_shock{.c0 = 3574, .s = 1.92, .gamma = 1.69};

/// Annealed copper and its threshold (Follansbee & Kocks 1988, Acta Metall. 36, 81), in the form with the root of the rate in which codes
/// for impact use it (Maudlin, Davidson & Henninger 1990, LA-11895-MS; the material files of Uintah).
inline MechanicalThreshold annealed_copper()
{
  MechanicalThreshold law;
  law.density = 8960;
  law.bulk_modulus = 129e9;
  law.shear_modulus = 46e9;
  law.athermal_stress = 40e6;
  law.shear_at_zero_kelvin = 45.78e9;
  law.shear_loss = 3.0e9;
  law.shear_temperature = 180;
  law.boltzmann_over_burgers_cubed = 0.823e6;
  law.activation_energy = 1.6;
  law.activation_rate = 1e7;
  law.activation_p = 2.0 / 3;
  law.activation_q = 1;
  law.hardening_modulus = 2390e6;
  law.hardening_by_log_rate = 12e6;
  law.hardening_by_root_rate = 1.696e6;
  law.hardening_shape = 2;
  law.saturation_stress = 770e6;
  law.saturation_energy = 0.2625;
  law.saturation_rate = 1e7;
  law.specific_heat = 383;
  law.initial_temperature = 298;
  return law;
}

/// So stiff that elastic strain is 1e-6 of what it is: plastic strain is then the strain.
template <class L>
L stiffened(L law)
{
  *law.bulk_modulus *= 1e6;
  *law.shear_modulus *= 1e6;
  return law;
}

/// A stretch along x that keeps the volume; `strain` is the equivalent strain.
inline Mat3 stretch(Real strain) { return Vec3(std::exp(strain), std::exp(-strain / 2), std::exp(-strain / 2)).asDiagonal(); }

/// Small and large, fast and slow: the strain of a random step from 1e-6 to 0.1.
inline Mat3 random_step(Dice& dice) { return Mat3::Identity() + dice.matrix(std::pow(10.0, dice.real(-6, -1))); }

}  // namespace talus::testing
