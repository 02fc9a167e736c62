#pragma once
// A law whose particles have a factor of their own for some of its parameters.
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "materials/interface/any_law.hpp"
#include "materials/interface/material.hpp"
#include "materials/variation/parameter_variation.hpp"

namespace talus {

/// A number among the parameters of a law.
struct LawNumber {
  std::string_view key, unit;
  Real value;
};
/// Those that may vary in space: given, not 0, and such that density, history at rest, time step of diffusion, conduction of heat and averaging
/// of strain, which are those of the whole body, do not depend on them.  None for laws of the user.
std::vector<LawNumber> numbers_that_vary(const AnyLaw& law);

/// The history has, behind that of the law, one number for each varied parameter, by which it is multiplied: `<parameter>_factor`, 1 at rest.
/// The strength is divided after that (ConstitutiveLaw::weakened).
class VariedLaw : public ConstitutiveLaw {
 public:
  VariedLaw(const LawDescription& description, std::vector<LawNumber> varied, std::vector<ParameterVariation> variation)
      : ConstitutiveLaw(description), varied_(std::move(varied)), variation_(std::move(variation))
  {}
  /// The parameters, with their values in the law, and how they vary.
  std::span<const LawNumber> varied() const noexcept { return varied_; }
  std::span<const ParameterVariation> variation() const noexcept { return variation_; }
  /// The place of the first factor in the history; the others follow.
  int first_factor() const noexcept { return description().history_width - static_cast<int>(varied_.size()); }
  /// What is wrong with the parameters of a particle, in words; empty if nothing is.
  virtual std::string problem(const Real* history) const = 0;
  using ConstitutiveLaw::shear_modulus;
  virtual std::optional<Real> shear_modulus(const Real* history) const noexcept = 0;  ///< of a particle

 private:
  std::vector<LawNumber> varied_;
  std::vector<ParameterVariation> variation_;
};

/// The name of the history variable of a varied parameter.
std::string name_of_factor(std::string_view parameter);
bool is_name_of_factor(std::string_view name) noexcept;
/// The law with its parameters, of the kind that they ask for: a VariedLaw if some of them vary, which must be among numbers_that_vary().
std::shared_ptr<const ConstitutiveLaw> varied_law(const AnyLaw& law, const std::vector<ParameterVariation>& variation);
/// Whether the same parameters vary in the same way, or none.
bool varies_alike(const ConstitutiveLaw& one, const ConstitutiveLaw& other) noexcept;
/// Elastic shear modulus at rest of particle i [Pa], of laws that have it.
std::optional<Real> shear_modulus_of(const Material& material, Index i) noexcept;

/// The same for a law of the list.  Defined in varied_law_of.hpp; each law is compiled in a unit of its own.
template <class L>
std::shared_ptr<const VariedLaw> varied_law_of(const L& law, const std::vector<ParameterVariation>& variation);

/// The description of a law with factors behind its history.  It is kept until the program ends.
const LawDescription& description_with_factors(const LawDescription& law, std::span<const LawNumber> varied);

}  // namespace talus
