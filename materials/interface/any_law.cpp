#include "materials/interface/any_law.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "materials/interface/law_variant.hpp"

namespace talus {

namespace {

/// Of a law whose library is not open.
template <class L>
const LawDescription& description_of_closed() noexcept
{
  static const LawDescription description{.name = L::name,
                                          .summary = L::summary,
                                          .variables = {},
                                          .history_width = 0,
                                          .starts_from_stress = false,
                                          .has_strength = false,
                                          .is_isochoric = false,
                                          .is_fluid = false};
  return description;
}

}  // namespace

AnyLaw::AnyLaw() : law_(std::make_shared<LawVariant>()) {}

const LawDescription& AnyLaw::description() const noexcept
{
  return std::visit(
      []<class L>(const L& law) -> const LawDescription& {
        if constexpr (is_in_library<L>)
          return law.opened ? law.opened->description() : description_of_closed<L>();
        else
          return law_description<L>();
      },
      law_->of);
}

bool AnyLaw::is_open() const noexcept
{
  return std::visit(
      []<class L>(const L& law) {
        if constexpr (is_in_library<L>)
          return law.opened != nullptr;
        else
          return true;
      },
      law_->of);
}

std::shared_ptr<const ConstitutiveLaw> AnyLaw::model() const
{
  return std::visit(
      []<class L>(const L& law) -> std::shared_ptr<const ConstitutiveLaw> {
        if constexpr (!is_in_library<L>)
          return constitutive_law(law);
        else if (law.opened)
          return law.opened;
        else
          throw Error(fmt::format("the library {} of a law has not been opened", law.library));
      },
      law_->of);
}

LawVariant& AnyLaw::edit_parameters()
{
  if (law_.use_count() > 1)
    law_ = std::make_shared<LawVariant>(*law_);
  return *law_;
}

std::vector<const LawDescription*> known_laws()
{
  std::vector<const LawDescription*> all;
  for_each_type(Laws{}, [&]<class L>() { all.push_back(&law_description<L>()); });
  return all;
}

std::vector<std::string> laws_that_start_from_stress()
{
  std::vector<std::string> names;
  for (const LawDescription* law : known_laws())
    if (law->starts_from_stress)
      names.emplace_back(law->name);
  return names;
}

}  // namespace talus
