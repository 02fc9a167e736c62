#pragma once
// A constitutive law with its parameters, whichever law it is: everything that set-up, solver and output ask of it.
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "materials/interface/history_rows.hpp"
#include "materials/interface/stress_strip.hpp"
#include "materials/parts/law.hpp"

namespace talus {

class Material;

/// Conduction of heat under a law with temperature.
struct HeatConduction {
  Real conductivity;   ///< [W/(m K)]
  Real specific_heat;  ///< [J/(kg K)]
  int temperature;     ///< its number in the history of a particle
};

/// Averaging of a plastic strain, or of the damage that it does, over a length of the material: see softening_length.hpp and johnson_cook.hpp.
struct StrainAveraging {
  Real length;             ///< [m]
  Real band;               ///< width of a shear band, or of the layer that a crack stands for [m]
  Real largest;            ///< strain or damage that counts at most [-]
  int strain, mean, rate;  ///< their numbers in the history of a particle
};

/// What all bodies with a law have in common, whatever its parameters.
struct LawDescription {
  std::string_view name, summary;
  std::span<const HistoryVariable> variables;
  int history_width;        ///< numbers in the row of a particle
  bool starts_from_stress;  ///< see prestress()
  bool has_strength;        ///< see weakened()
  bool is_isochoric;        ///< its plastic flow keeps the volume, which locks simplices
  bool is_fluid;            ///< at rest it bears pressure alone

  /// Number of a scalar history variable in the row of a particle; nothing if the law does not have it.
  std::optional<int> scalar_variable(std::string_view key) const noexcept
  {
    for (const HistoryVariable& variable : variables)
      if (variable.key == key && variable.components == 1)
        return variable.first;
    return std::nullopt;
  }
};

/// Called once per step and strip of particles (update_stress) or outside the time step (everything else).  It does not change after it was made, so
/// that bodies share it.  `history` is the row of a particle, with the numbers that variables() describes.
class ConstitutiveLaw {
 public:
  explicit ConstitutiveLaw(const LawDescription& description) noexcept : description_(description) {}
  ConstitutiveLaw(const ConstitutiveLaw&) = delete;
  ConstitutiveLaw& operator=(const ConstitutiveLaw&) = delete;
  virtual ~ConstitutiveLaw() = default;

  const LawDescription& description() const noexcept { return description_; }
  std::string_view name() const noexcept { return description_.name; }
  std::span<const HistoryVariable> variables() const noexcept { return description_.variables; }
  virtual Real density() const noexcept = 0;  ///< at rest [kg/m^3]
  /// The row of a particle at rest.
  virtual void initial_history(Real* history) const noexcept = 0;

  /// Cauchy stress [Pa] of one particle at the end of the step; changes its history.
  virtual Mat3 update(const Increment& step, Real* history) const noexcept = 0;
  /// Deformation and stress of particles of `material`, whose law this is: see update_stress() of material.hpp.
  virtual StressSums update_stress(const Material& material, const StressStrip<2>& strip) const noexcept = 0;
  virtual StressSums update_stress(const Material& material, const StressStrip<3>& strip) const noexcept = 0;

  /// Upper bound of the speed of sound [m/s] under F, for any history.
  virtual Real wave_speed(const Mat3& F) const noexcept = 0;
  /// The same bound where the history is known.
  virtual Real wave_speed(const Mat3& F, const Real* history) const noexcept = 0;
  virtual std::optional<Real> diffusivity() const noexcept = 0;  ///< largest one, of momentum or heat [m^2/s]

  /// Makes `stress` [Pa] the stress at F = I.  False, and no change, if the law cannot start from a stress.
  virtual bool prestress(const Mat3& stress, Real* history) const noexcept = 0;
  /// This law, its shear strength divided by `factor` > 0; nothing for a law without strength.
  virtual std::shared_ptr<const ConstitutiveLaw> weakened(Real factor) const = 0;
  virtual std::optional<Real> shear_modulus() const noexcept = 0;  ///< elastic one at rest [Pa], of laws that have it
  virtual std::optional<HeatConduction> heat() const noexcept = 0;
  virtual std::optional<StrainAveraging> strain_averaging() const noexcept = 0;

  /// Of a law of the user: what it said of the particle `id` when it had no answer, once.
  virtual std::string complaint(std::int64_t /*id*/) const { return {}; }
  /// Of a law of the user: the digest of its library.
  virtual std::string library_digest() const { return {}; }

 private:
  const LawDescription& description_;  ///< constant, of the type of the law
};

/// The law with its parameters, of the kind that they ask for.  Defined in constitutive_law_of.hpp; each law of the list is compiled in a unit of
/// its own.
template <class L>
std::shared_ptr<const ConstitutiveLaw> constitutive_law(const L& law);
/// The law with all the history that it can have, whatever its parameters ask for.
template <class L>
const LawDescription& law_description() noexcept;

}  // namespace talus
