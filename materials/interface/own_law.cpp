#include "materials/interface/own_law.hpp"

#include <fmt/format.h>

#include "materials/interface/own_law_code.hpp"

namespace talus {

void LawBySymbol::divide_strength(Real factor)
{
  if (!code || code->law().weaken == nullptr)
    return;
  std::vector<Real> values;
  for (const NamedNumber& one : parameters.all)
    values.push_back(one.value);
  values = weakened_values(*code, std::move(values), factor);
  for (std::size_t i = 0; i < values.size(); ++i)
    parameters.all[i].value = values[i];
}

void UmatLaw::check(std::vector<std::string>& problems) const
{
  if (bulk_modulus.has_value() != shear_modulus.has_value())
    problems.emplace_back("bulk_modulus and shear_modulus are given both or not at all");
  if (!initial_statev.empty() && std::cmp_not_equal(initial_statev.size(), depvar))
    problems.push_back(fmt::format("initial_statev has {} numbers, and depvar is {}", initial_statev.size(), depvar));
}

}  // namespace talus
