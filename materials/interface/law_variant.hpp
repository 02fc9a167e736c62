#pragma once
// The parameters of all laws: for what reads, writes and describes them.  Everything else includes any_law.hpp.

#include "core/type_list.hpp"
#include "materials/interface/any_law.hpp"
#include "materials/interface/own_law.hpp"
#include "materials/laws.hpp"

namespace talus {

struct LawVariant {
  variant_of<decltype(joined(Laws{}, LawsInLibraries{})), std::type_identity_t> of;
};

template <class L>
AnyLaw::AnyLaw(const L& law) : law_(std::make_shared<LawVariant>(LawVariant{law}))
{}

/// The alternatives of a field `alternative`, see core/fields.hpp.
inline auto& choices_of(AnyLaw& law) { return law.edit_parameters().of; }
inline const auto& choices_of(const AnyLaw& law) noexcept { return law.parameters().of; }

}  // namespace talus
