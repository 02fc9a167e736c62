#pragma once
// The parameters of one law of the list, whichever it is, as a scene gives them.
#include <memory>
#include <vector>

#include "materials/constitutive_law.hpp"

namespace talus {

struct LawVariant;  // law_variant.hpp

/// A value.  What the parameters mean is asked of the ConstitutiveLaw that is made from them; the parameters themselves are the business of
/// law_variant.hpp, which includes every law.
class AnyLaw {
 public:
  AnyLaw();  ///< the first law of the list, its parameters not given yet
  template <class L>
  explicit AnyLaw(const L& law);  // law_variant.hpp

  std::string_view name() const noexcept;
  /// Of the kind that the parameters ask for.
  std::shared_ptr<const ConstitutiveLaw> model() const;
  /// With all the history that the law can have.
  std::shared_ptr<const ConstitutiveLaw> model_of_all_kinds() const;

  const LawVariant& parameters() const noexcept { return *law_; }
  LawVariant& edit_parameters();

 private:
  std::shared_ptr<LawVariant> law_;  ///< shared by copies until one of them is edited
};

/// Every law of the list, in its order and with all its history; parameters are not given.
const std::vector<std::shared_ptr<const ConstitutiveLaw>>& known_laws();
/// Names of those that can start from a stress.
std::vector<std::string> laws_that_start_from_stress();

}  // namespace talus
