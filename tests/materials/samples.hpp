#pragma once
// For the tests of laws: one sample of every law, random deformations, and steps with a consistent velocity gradient.
#include <Eigen/Geometry>
#include <random>

#include "materials/interface/material.hpp"
#include "materials/law_examples.hpp"

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
inline constexpr Real sample_stiffness = example_stiffness;

/// What a soil, a fluid or a metal can have beyond what it must have: dilation, softening, a cut-off; hardening, damage.
template <class L>
void add_options(L&)
{}
inline void add_options(SoilStrength& law)
{
  law.dilation_angle = 8;
  law.residual_friction_angle = 20;
  law.residual_cohesion = 1e3;
  law.softening_strain = 0.05;
  law.tension_cutoff = 4e3;
}
inline void add_options(Viscoelastic& law)
{
  law.second = PronyTerm{.share = 0.2, .time = 0.1};
  law.third = PronyTerm{.share = 0.1, .time = 2};
}
inline void add_options(ElasticHerschelBulkley& law) { law.yield_stress = 2e4; }  // strains of a per cent come near it
inline void add_options(Snow& law) { law.hardening_limit = 20; }
inline void add_options(Newtonian& law) { law.volume_viscosity = 2; }
inline void add_options(VonMises& law)  // without `rate`: yield() is that of slow loading
{
  law.voce = VoceHardening{.saturation = 1e4, .exponent = 20};
  law.power = PowerHardening{.coefficient = 2e4, .exponent = 0.3};
}
inline void add_options(JohnsonCook& law)
{
  law.reference_rate = 1e6;  // slower than it: yield() is that of slow loading
  law.damage = JohnsonCookDamage{.d1 = 0.54, .d2 = 4.89, .d3 = -3.03, .d4 = 0.014, .d5 = 1.12};
  law.mie_gruneisen = MieGruneisen{.c0 = 64, .s = 0.9, .gamma = 1.6};  // 2 s - gamma / 2 = 1: smooth between compression and tension
}
inline void add_options(MechanicalThreshold& law)
{
  law.intrinsic =
      IntrinsicBarrier{.threshold = 2e4, .activation_energy = 1.2, .activation_rate = 1e13, .activation_p = 0.5, .activation_q = 1.5};
  law.hardening_by_log_rate = 1e3;
  law.hardening_by_root_rate = 1e2;
  law.hardening_by_temperature = 20;
  law.initial_threshold = 1e4;
  law.mie_gruneisen = MieGruneisen{.c0 = 64, .s = 0.9, .gamma = 1.6};  // as for Johnson & Cook
}
inline void add_options(PorousDuctile& law)
{
  law.hardening_coefficient = 1e4;
  law.hardening_exponent = 0.3;
  law.nucleation = VoidNucleation{.porosity = 0.04, .mean_strain = 0.3, .deviation = 0.1};
  law.coalescence = VoidCoalescence{.porosity = 0.15, .failure_porosity = 0.25};
}

/// Parameters under which a law shows all it has.
template <class L>
L sample()
{
  L law = law_example<L>();
  if constexpr (std::is_base_of_v<SoilStrength, L>)
    add_options(static_cast<SoilStrength&>(law));
  else
    add_options(law);
  return law;
}

/// Cohesive Cam clay without cohesion that is the given clay.
inline CohesiveCamClay as_cohesive(const ModifiedCamClay& clay)
{
  CohesiveCamClay law;
  law.density = clay.density;
  law.shear_modulus = clay.shear_modulus;
  law.critical_state_slope = clay.critical_state_slope;
  law.preconsolidation_pressure = clay.preconsolidation_pressure;
  law.compression_index = clay.compression_index;
  law.swelling_index = clay.swelling_index;
  law.reference_pressure = clay.reference_pressure;
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
