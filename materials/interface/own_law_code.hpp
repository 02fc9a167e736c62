#pragma once
// A law behind the C interface talus_law.h, and what is known of it before it has parameters.
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/named_numbers.hpp"
#include "materials/interface/constitutive_law.hpp"
#include "materials/interface/talus_law.h"

namespace talus {

/// Where a law came from.
struct OwnLawOrigin {
  std::string library;                   ///< as the scene names it
  std::string digest;                    ///< of the file
  std::shared_ptr<const void> keeper{};  ///< what has to exist as long as the law does
};

/// The description of a law, copied and checked.  It does not change, so that all materials with the law share it.
class OwnLawCode {
 public:
  /// Throws Error, with what the author of the law has to change, for a description that is wrong.
  OwnLawCode(const talus_law& law, OwnLawOrigin origin);
  OwnLawCode(const OwnLawCode&) = delete;
  OwnLawCode& operator=(const OwnLawCode&) = delete;

  const talus_law& law() const noexcept { return law_; }
  const OwnLawOrigin& origin() const noexcept { return origin_; }
  /// With the name "my_law of libmylaw.so".
  const LawDescription& description() const noexcept { return description_; }
  std::span<const talus_law_parameter> parameters() const noexcept
  {
    return {law_.parameters, static_cast<std::size_t>(law_.n_parameters)};
  }
  /// The first number of each symmetric tensor of the history that turns with the material.
  std::span<const int> turning() const noexcept { return turning_; }

 private:
  talus_law law_;
  OwnLawOrigin origin_;
  std::string name_, summary_;
  std::vector<HistoryVariable> variables_;
  std::vector<int> turning_;
  LawDescription description_{};
};

/// A value of a parameter that is wrong; `name` is empty where several do not fit together.
struct OwnLawProblem {
  std::string name, message;
};

/// Which values the parameters of a law have, by their order in it.
struct OwnLawValues {
  std::vector<Real> values;
  std::vector<OwnLawProblem> problems;  ///< unknown and missing ones, values beyond the limits
};
OwnLawValues values_of(const OwnLawCode& code, const NamedNumbers& given);

/// The law with its parameters.  `serial`: its functions are called by one thread at a time.  Throws Error with the message of the law if it does
/// not accept them.
std::shared_ptr<const ConstitutiveLaw> own_law(std::shared_ptr<const OwnLawCode> code, std::vector<Real> parameters, Real density,
                                               bool serial);

/// What is wrong with the first of `values`, all parameters of the law, that is beyond its limits.
std::optional<std::string> beyond_limits(const OwnLawCode& code, std::span<const Real> values);

/// What a function of a library returns; `name` is that of the function.  Throws Error if it fails or returns nothing.
const talus_law& described_law(const talus_law* (*describe)(), const std::string& name);

/// The parameters of a law with weaken(), its strength divided by a factor > 0.  Throws Error if the law refuses or leaves the limits.
std::vector<Real> weakened_values(const OwnLawCode& code, std::vector<Real> values, Real factor);

/// A call of a law of the user that has not returned.
struct LawCall {
  const char* law = nullptr;           ///< "my_law of libmylaw.so"
  std::int64_t first = -1, last = -1;  ///< ids of the first and the last particle
  Real time = 0;                       ///< [s]
};
/// That of this thread; law is nullptr if there is none.  For handlers of signals.
const LawCall& law_call_of_thread() noexcept;
/// The same, or if this thread calls none, that of another thread.
const LawCall& law_call_of_any_thread() noexcept;

}  // namespace talus
