#pragma once
// For the tests of laws: one sample of every law, random deformations, and steps with a consistent velocity gradient.
#include <Eigen/Geometry>
#include <random>

#include "materials/batch.hpp"

namespace talus::testing {

using Problems = std::vector<std::string>;

/// What the rules between the parameters of `law` say after `change(law)`.
template <class L, class F>
Problems problems_of(L law, F&& change)
{
  change(law);
  Problems found;
  law.check(found);
  return found;
}

/// Young's modulus of every sample, or the stiffness that stands for it [Pa].
inline constexpr Real sample_stiffness = 1e7;

/// Parameters under which a law shows all it has: for soil dilation, cohesion, softening and a cut-off.
template <class L>
L sample()
{
  L law{};
  law.density = 2000;
  if constexpr (requires { law.youngs_modulus; }) {
    law.youngs_modulus = sample_stiffness;
    law.poisson_ratio = 0.3;
  }
  if constexpr (requires { law.match; }) {
    law.friction_angle = 30;
    law.cohesion = 5e3;
    law.match = ConeMatch::plane_strain;
    law.dilation_angle = 8;
    law.residual_friction_angle = 20;
    law.residual_cohesion = 1e3;
    law.softening_strain = 0.05;
    law.tension_cutoff = 4e3;
  }
  return law;
}

template <>
inline ModifiedCamClay sample<ModifiedCamClay>()
{
  ModifiedCamClay law;
  law.density = 1800;
  law.shear_modulus = 4e6;
  law.compression_index = 0.2;
  law.swelling_index = 0.05;
  law.critical_state_slope = 1.1;
  law.preconsolidation_pressure = 1e5;
  law.reference_pressure = 0.05 * sample_stiffness;
  return law;
}
template <>
inline MohrCoulomb sample<MohrCoulomb>()
{
  MohrCoulomb law;
  law.density = 2000;
  law.youngs_modulus = sample_stiffness;
  law.poisson_ratio = 0.3;
  law.friction_angle = 30;
  law.cohesion = 5e3;
  law.dilation_angle = 8;
  law.tension_cutoff = 4e3;
  law.residual_friction_angle = 20;
  law.residual_cohesion = 1e3;
  law.softening_strain = 0.05;
  return law;
}
template <>
inline MuI sample<MuI>()
{
  MuI law;
  law.density = 1500;
  law.youngs_modulus = sample_stiffness;
  law.poisson_ratio = 0.3;
  law.static_friction = 0.5;
  law.limiting_friction = 0.7;
  law.inertial_number = 0.279;
  law.grain_diameter = 0.5e-3;
  law.grain_density = 2500;
  return law;
}
template <>
inline Newtonian sample<Newtonian>()
{
  Newtonian law;
  law.density = 1000;
  law.bulk_modulus = sample_stiffness;
  law.viscosity = 5;
  law.volume_viscosity = 2;
  return law;
}
template <>
inline HerschelBulkley sample<HerschelBulkley>()
{
  HerschelBulkley law;
  law.density = 1600;
  law.bulk_modulus = sample_stiffness;
  law.yield_stress = 50;
  law.consistency = 4;
  law.flow_index = 0.5;
  law.regularisation = 1;
  return law;
}
template <>
inline VonMises sample<VonMises>()  // without `rate`: yield() is that of slow loading
{
  VonMises law;
  law.density = 2000;
  law.youngs_modulus = sample_stiffness;
  law.poisson_ratio = 0.3;
  law.yield_stress = 4e4;
  law.hardening_modulus = 1e4;
  law.voce = VoceHardening{.saturation = 1e4, .exponent = 20};
  law.power = PowerHardening{.coefficient = 2e4, .exponent = 0.3};
  return law;
}
template <>
inline JohnsonCook sample<JohnsonCook>()  // slower than the reference rate: yield() is that of slow loading
{
  JohnsonCook law;
  law.density = 2000;
  law.youngs_modulus = sample_stiffness;
  law.poisson_ratio = 0.3;
  law.yield_stress = 4e4;
  law.hardening_coefficient = 1e4;
  law.hardening_exponent = 0.3;
  law.rate_coefficient = 0.02;
  law.reference_rate = 1e6;
  law.thermal_exponent = 1.05;
  law.room_temperature = 294;
  law.melting_temperature = 1400;
  law.specific_heat = 0.02;
  law.damage = JohnsonCookDamage{.d1 = 0.54, .d2 = 4.89, .d3 = -3.03, .d4 = 0.014, .d5 = 1.12};
  law.mie_gruneisen = MieGruneisen{.c0 = 64, .s = 0.9, .gamma = 1.6};  // 2 s - gamma / 2 = 1: smooth between compression and tension
  return law;
}

/// Repeatable random tensors.
class Dice {
 public:
  explicit Dice(unsigned seed) : bits_(seed) {}
  Real real(Real low, Real high) { return std::uniform_real_distribution<Real>(low, high)(bits_); }
  Mat3 matrix(Real size)
  {
    return Mat3::NullaryExpr([&] { return real(-size, size); });
  }
  Mat3 symmetric(Real size) { return sym(matrix(size)); }
  Mat3 rotation()
  {
    Eigen::Quaterniond q(real(-1, 1), real(-1, 1), real(-1, 1), real(-1, 1));
    return q.normalized().toRotationMatrix();
  }
  Vec3 direction() { return rotation().col(0); }

 private:
  std::mt19937 bits_;
};

inline Mat3 rotation_about(const Vec3& axis, Real angle)
{
  return Eigen::AngleAxisd(angle, Eigen::Vector3d(axis.normalized())).toRotationMatrix();
}

/// One material point.
template <class L>
struct Point {
  L law;
  typename L::Constants constants = law.constants();
  Mat3 F = Mat3::Identity(), stress = Mat3::Zero();
  typename L::State state{};

  /// Deforms by `f` from where it is.
  void step(const Mat3& f, bool elastic = false, Real dt = 1e-3)
  {
    const Mat3 L_step = (f - Mat3::Identity()) / dt;
    F = f * F;
    stress = law.update(Increment{F, L_step, stress, dt, 0, elastic}, state, constants);
  }
  /// Deforms by the displacement gradient `H` of the step: exact for the smallest strains.
  void strain(const Mat3& H)
  {
    F = F + H * F;
    stress = law.update(Increment{F, H, stress, 1.0, 0, false}, state, constants);
  }
  void prestress(const Mat3& start)
  {
    stress = start;
    law.prestress(start, state);
  }
};

}  // namespace talus::testing
