#include "materials/any_law.hpp"

#include "materials/law_variant.hpp"

namespace talus {

AnyLaw::AnyLaw() : law_(std::make_shared<LawVariant>()) {}

std::string_view AnyLaw::name() const noexcept
{
  return std::visit([]<class L>(const L&) { return std::string_view(L::name); }, law_->of);
}

std::shared_ptr<const ConstitutiveLaw> AnyLaw::model() const
{
  return std::visit([](const auto& law) { return constitutive_law(law); }, law_->of);
}

std::shared_ptr<const ConstitutiveLaw> AnyLaw::model_of_all_kinds() const
{
  return std::visit([](const auto& law) { return constitutive_law_of_all_kinds(law); }, law_->of);
}

LawVariant& AnyLaw::edit_parameters()
{
  if (law_.use_count() > 1)
    law_ = std::make_shared<LawVariant>(*law_);
  return *law_;
}

const std::vector<std::shared_ptr<const ConstitutiveLaw>>& known_laws()
{
  static const auto all = [] {
    std::vector<std::shared_ptr<const ConstitutiveLaw>> laws;
    for_each_type(Laws{}, [&]<class L>() { laws.push_back(constitutive_law_of_all_kinds(L{})); });
    return laws;
  }();
  return all;
}

std::vector<std::string> laws_that_start_from_stress()
{
  std::vector<std::string> names;
  for (const auto& law : known_laws())
    if (law->starts_from_stress())
      names.emplace_back(law->name());
  return names;
}

}  // namespace talus
