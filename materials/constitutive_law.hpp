#pragma once
// A constitutive law with its parameters, whichever law it is: everything that set-up, solver and output ask of it.
#include <memory>
#include <optional>
#include <span>

#include "materials/history_rows.hpp"
#include "materials/law.hpp"
#include "materials/stress_block.hpp"

namespace talus {

class Material;

/// Conduction of heat under a law with temperature.
struct HeatConduction {
  Real conductivity;   ///< [W/(m K)]
  Real specific_heat;  ///< [J/(kg K)]
  int temperature;     ///< its number in the history of a particle
};

/// Called once per step and block (update_stress) or outside the time step (everything else).  It does not change after it was made, so
/// that bodies share it.  `history` is the row of a particle, with the numbers that variables() describes.
class ConstitutiveLaw {
 public:
  ConstitutiveLaw() = default;
  ConstitutiveLaw(const ConstitutiveLaw&) = delete;
  ConstitutiveLaw& operator=(const ConstitutiveLaw&) = delete;
  virtual ~ConstitutiveLaw() = default;

  virtual std::string_view name() const noexcept = 0;
  virtual std::string_view summary() const noexcept = 0;
  virtual Real density() const noexcept = 0;  ///< at rest [kg/m^3]
  virtual std::span<const HistoryVariable> variables() const noexcept = 0;
  virtual int history_width() const noexcept = 0;  ///< numbers of a row
  /// The row of a particle at rest.
  virtual void initial_history(Real* history) const noexcept = 0;

  /// Cauchy stress [Pa] of one particle at the end of the step; changes its history.
  virtual Mat3 update(const Increment& step, Real* history) const noexcept = 0;
  /// Deformation and stress of the particles of `material`, whose law this is, in a block: see update_stress() of material.hpp.
  virtual StressSums update_stress(Material& material, const StressBlock<2>& block) const noexcept = 0;
  virtual StressSums update_stress(Material& material, const StressBlock<3>& block) const noexcept = 0;

  /// Upper bound of the speed of sound [m/s] under F, for any history.
  virtual Real wave_speed(const Mat3& F) const noexcept = 0;
  /// The same bound where the history is known.
  virtual Real wave_speed(const Mat3& F, const Real* history) const noexcept = 0;
  virtual std::optional<Real> diffusivity() const noexcept = 0;  ///< largest one, of momentum or heat [m^2/s]

  virtual bool starts_from_stress() const noexcept = 0;
  /// Makes `stress` [Pa] the stress at F = I.  False, and no change, if the law cannot start from a stress.
  virtual bool prestress(const Mat3& stress, Real* history) const noexcept = 0;
  virtual bool has_strength() const noexcept = 0;
  /// This law, its shear strength divided by `factor` > 0; nothing for a law without strength.
  virtual std::shared_ptr<const ConstitutiveLaw> weakened(Real factor) const = 0;
  virtual std::optional<Real> shear_modulus() const noexcept = 0;  ///< elastic one at rest [Pa], of laws that have it
  virtual std::optional<HeatConduction> heat() const noexcept = 0;
  virtual bool is_isochoric() const noexcept = 0;  ///< its plastic flow keeps the volume, which locks simplices
  virtual bool is_fluid() const noexcept = 0;      ///< at rest it bears pressure alone
};

/// The law with its parameters, of the kind that they ask for.  Defined in constitutive_law_of.hpp; each law of the list is compiled in a unit of
/// its own.
template <class L>
std::shared_ptr<const ConstitutiveLaw> constitutive_law(const L& law);
/// The law with all the history that it can have, whatever its parameters ask for.
template <class L>
std::shared_ptr<const ConstitutiveLaw> constitutive_law_of_all_kinds(const L& law);

/// Number of a scalar history variable in the row of a particle; nothing if the law does not have it.
inline std::optional<int> scalar_variable(const ConstitutiveLaw& law, std::string_view key) noexcept
{
  for (const HistoryVariable& variable : law.variables())
    if (variable.key == key && variable.components == 1)
      return variable.first;
  return std::nullopt;
}

}  // namespace talus
