#include "materials/interface/any_law.hpp"

#include "materials/interface/law_variant.hpp"

namespace talus {

AnyLaw::AnyLaw() : law_(std::make_shared<LawVariant>()) {}

const LawDescription& AnyLaw::description() const noexcept
{
  return std::visit([]<class L>(const L&) -> const LawDescription& { return law_description<L>(); }, law_->of);
}

std::shared_ptr<const ConstitutiveLaw> AnyLaw::model() const
{
  return std::visit([](const auto& law) { return constitutive_law(law); }, law_->of);
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
