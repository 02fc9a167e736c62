#pragma once
// Soils of Mohr and Coulomb, and the laboratory tests that they go through.
#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "materials/laboratory/point_path.hpp"
#include "materials/mohr_coulomb.hpp"
#include "tests/materials/soil.hpp"

namespace talus::mohr_coulomb_test {

using testing::Dice;
using testing::Point;
using testing::radians;
using testing::stiffening;

inline constexpr Real machine = 1e-10;  // relative: what the closed forms claim
inline constexpr Real p0 = 1e5;
inline const Real root3 = std::sqrt(3.0);

/// E = 10 MPa, nu = 0.3.
inline MohrCoulomb soft_soil(Real friction, Real cohesion, Real dilation = 0)
{
  MohrCoulomb law;
  law.density = 2000;
  law.youngs_modulus = 1e7;
  law.poisson_ratio = 0.3;
  law.friction_angle = friction;
  law.cohesion = cohesion;
  law.dilation_angle = dilation;
  return law;
}
/// The same, stiffened.
inline MohrCoulomb soil(Real friction, Real cohesion, Real dilation = 0)
{
  MohrCoulomb law = soft_soil(friction, cohesion, dilation);
  *law.youngs_modulus *= stiffening;
  return law;
}
inline MohrCoulomb softening(MohrCoulomb law, Real friction, Real cohesion, Real strain)
{
  law.residual_friction_angle = friction;
  law.residual_cohesion = cohesion;
  law.softening_strain = strain;
  return law;
}
inline MohrCoulomb with_cutoff(MohrCoulomb law, Real cutoff)
{
  law.tension_cutoff = cutoff;
  return law;
}

/// In falling order.
inline Vec3 principal(const Mat3& stress) { return Eigen::SelfAdjointEigenSolver<Mat3>(stress).eigenvalues().reverse(); }
inline Real mean(const Mat3& stress) { return stress.trace() / 3; }

constexpr Control rate(Real value) { return {Controlled::strain_rate, value}; }
constexpr Control gradient(Real value) { return {Controlled::velocity_gradient, value}; }
constexpr Control held(Real value) { return {Controlled::stress, value}; }

inline std::vector<PointRow> test_of(const MohrCoulomb& law, const Controls& controls, Index steps,
                                     const Mat3& start = -p0 * Mat3::Identity())
{
  const PointPath path{.steps = steps, .controls = controls};
  return drive(make_material(law, 0, 1, "sample"), {&path, 1}, start).rows;
}
/// Axial (zz) strain in units of soil strains under constant cell pressure p0.
inline std::vector<PointRow> triaxial(const MohrCoulomb& law, Real axial_strain)
{
  return test_of(law, {.xx = held(-p0), .yy = held(-p0), .zz = rate(axial_strain / stiffening)}, 50);
}
inline Vec3 log_strain(const PointRow& row) { return row.F.diagonal().array().log(); }

}  // namespace talus::mohr_coulomb_test
