#include "materials/interface/varied_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>
#include <mutex>
#include <utility>

#include "materials/interface/law_variant.hpp"
#include "materials/interface/varied_law_of.hpp"

namespace talus {

namespace {

/// A description and what it refers to.
struct KeptDescription {
  std::deque<std::string> names;
  std::vector<HistoryVariable> variables;
  LawDescription description;
};

/// Whether a whole body has one value of what depends on the number at `offset`.
template <class L>
bool is_of_body(const L& law, std::size_t offset)
{
  constexpr Real another = 1.25;
  L other = law;
  number_at(other, offset) *= another;
  const auto as_told = [](const L& one) {
    const auto model = constitutive_law(one);
    const auto heat = model->heat();
    const auto averaging = model->strain_averaging();
    std::vector<Real> at_rest(static_cast<std::size_t>(model->description().history_width));
    model->initial_history(at_rest.data());
    return std::tuple(at_rest, model->density(), model->diffusivity(), heat ? heat->conductivity : 0, heat ? heat->specific_heat : 0,
                      averaging ? averaging->length : 0, averaging ? averaging->largest : 0);
  };
  return as_told(law) != as_told(other);
}

}  // namespace

std::string name_of_factor(std::string_view parameter) { return fmt::format("{}_factor", parameter); }

std::vector<LawNumber> numbers_that_vary(const AnyLaw& law)
{
  return std::visit(
      []<class L>(const L& one) {
        std::vector<LawNumber> all;
        if constexpr (!is_in_library<L>)
          for (const PlaceOfNumber& place : numbers_of(one))
            if (place.number.value != 0 && !is_of_body(one, place.offset))
              all.push_back(place.number);
        return all;
      },
      law.parameters().of);
}

bool is_name_of_factor(std::string_view name) noexcept { return name.ends_with("_factor"); }

std::shared_ptr<const ConstitutiveLaw> varied_law(const AnyLaw& law, const std::vector<ParameterVariation>& variation)
{
  if (variation.empty())
    return law.model();
  return std::visit(
      [&]<class L>(const L& one) -> std::shared_ptr<const ConstitutiveLaw> {
        if constexpr (is_in_library<L>)
          throw Error("parameters of a law of the user do not vary in space");
        else
          return varied_law_of(one, variation);
      },
      law.parameters().of);
}

bool varies_alike(const ConstitutiveLaw& one, const ConstitutiveLaw& other) noexcept
{
  const auto variation_of = [](const ConstitutiveLaw& law) {
    const auto* const varied = dynamic_cast<const VariedLaw*>(&law);
    return varied != nullptr ? varied->variation() : std::span<const ParameterVariation>();
  };
  return std::ranges::equal(variation_of(one), variation_of(other));
}

std::optional<Real> shear_modulus_of(const Material& material, Index i) noexcept
{
  const auto* const varied = dynamic_cast<const VariedLaw*>(&material.law());
  return varied != nullptr ? varied->shear_modulus(material.history.row(i)) : material.law().shear_modulus();
}

const LawDescription& description_with_factors(const LawDescription& law, std::span<const LawNumber> varied)
{
  static std::mutex one_at_a_time;
  static std::map<std::pair<const LawDescription*, std::vector<std::string>>, std::unique_ptr<KeptDescription>> kept;
  std::vector<std::string> keys;
  for (const LawNumber& number : varied)
    keys.emplace_back(number.key);
  const std::lock_guard guard(one_at_a_time);
  std::unique_ptr<KeptDescription>& one = kept[{&law, keys}];
  if (!one) {
    one = std::make_unique<KeptDescription>(KeptDescription{{}, {law.variables.begin(), law.variables.end()}, law});
    for (const std::string& key : keys) {
      const std::string& name = one->names.emplace_back(name_of_factor(key));
      const std::string& meaning = one->names.emplace_back(fmt::format("{} of the particle over that of the material", key));
      one->variables.push_back({name, "-", meaning, one->description.history_width++, 1});
    }
    one->description.variables = one->variables;
  }
  return one->description;
}

}  // namespace talus
