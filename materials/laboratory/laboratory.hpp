#pragma once
// Standard laboratory tests on one point of a law, and what they must measure where that is known in closed form.
#include <string>
#include <vector>

#include "materials/interface/any_law.hpp"
#include "materials/laboratory/point_path.hpp"

namespace talus {

enum class Laboratory : std::uint8_t { triaxial_compression, triaxial_extension, simple_shear, oedometer, uniaxial_strain_rate };
constexpr auto enum_names(Laboratory)
{
  return std::array<std::string_view, 5>{"triaxial_compression", "triaxial_extension", "simple_shear", "oedometer", "uniaxial_strain_rate"};
}

/// How a test is run.  All are drained and begin under an isotropic pressure.
struct TestPlan {
  Laboratory test{};
  Real pressure;  ///< Pa
  Real strain;    ///< logarithmic axial strain, or shear strain, at the end [-]
  Real rate;      ///< of this strain [1/s]
  Index steps;
};
/// Soil tests under 100 kPa to 20 % (shear 50 %), the oedometer to 5 % and the tension test to 20 % from no stress; 0.001/s, 500 steps.
TestPlan usual_plan(Laboratory test);

/// What is measured: the difference of axial and lateral stress |s_zz - s_xx| of triaxial and uniaxial tests, the shear stress |s_xy|,
/// or the vertical stress -s_zz of the oedometer.
Real measured_stress(Laboratory test, const Mat3& stress);

struct TestResult {
  PointTable table;              ///< from the end of the consolidation on, where time begins
  std::vector<Real> strain;      ///< of the plan, one per row [-]
  std::vector<Real> stress;      ///< measured_stress [Pa], one per row
  std::size_t peak{};            ///< row of the largest stress
  Real lateral_over_vertical{};  ///< s_xx / s_zz at the end: K0 of an oedometer
};
/// Runs a test on the law of `batch` (which must have one particle).  RunError as drive(): a law may be unable to bear the test.
///     triaxial      s_xx = s_yy = -pressure, z is compressed or extended
///     simple shear  s_yy = -pressure, no strain along x and z, L_xy = rate
///     oedometer     z is compressed, no strain along x and y
///     uniaxial      as extension, from no pressure: the tension test of a metal
TestResult perform(const Material& material, const TestPlan& plan);

/// A number the test must measure, for small elastic strains.
struct ClosedForm {
  std::string name;
  Real value;  ///< Pa; of the oedometer s_xx / s_zz at the vertical stress that was reached [-]
};
/// Of the law itself first, then for soils with an angle of friction those of Mohr-Coulomb and of the three Drucker-Prager cones that may
/// stand for it.  Empty where there is none.  Strengths are those before softening; of modified Cam clay at critical state.
std::vector<ClosedForm> closed_forms(const AnyLaw& law, const TestPlan& plan, const TestResult& result);

}  // namespace talus
