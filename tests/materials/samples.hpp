#pragma once
// For the tests of laws: one sample of every law, random deformations, and steps with a consistent velocity gradient.
#include <Eigen/Geometry>
#include <random>

#include "materials/batch.hpp"

namespace talus::testing {

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
    stress = law.update({F, L_step, stress, dt, 0, elastic}, state, constants);
  }
  /// Deforms by the displacement gradient `H` of the step: exact for the smallest strains.
  void strain(const Mat3& H)
  {
    F = F + H * F;
    stress = law.update({F, H, stress, 1.0, 0, false}, state, constants);
  }
  void prestress(const Mat3& start)
  {
    stress = start;
    law.prestress(start, state);
  }
};

}  // namespace talus::testing
