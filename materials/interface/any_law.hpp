#pragma once
// The parameters of one law of the list, whichever it is, as a scene gives them.
#include <memory>
#include <string>
#include <vector>

#include "materials/interface/constitutive_law.hpp"

namespace talus {

struct LawVariant;  // law_variant.hpp

/// A value.  model() makes the ConstitutiveLaw of the parameters.  The parameters themselves can be read through law_variant.hpp, which includes
/// every law.
class AnyLaw {
 public:
  AnyLaw();  ///< the first law of the list, its parameters not given yet
  template <class L>
  explicit AnyLaw(const L& law);  // law_variant.hpp

  /// With all the history that the law can have, whatever the parameters.
  const LawDescription& description() const noexcept;
  std::string_view name() const noexcept { return description().name; }
  /// False for a law of the user whose library has not been opened: nothing is known of it, and it has no model.
  bool is_open() const noexcept;
  /// Of the kind that the parameters ask for.  Throws Error for a law that is not open.
  std::shared_ptr<const ConstitutiveLaw> model() const;

  const LawVariant& parameters() const noexcept { return *law_; }
  LawVariant& edit_parameters();

 private:
  std::shared_ptr<LawVariant> law_;  ///< shared by copies until one of them is edited
};

/// Every law of the list, in its order.
std::vector<const LawDescription*> known_laws();
/// Names of those that can start from a stress.
std::vector<std::string> laws_that_start_from_stress();

}  // namespace talus
