#include "materials/interface/own_law.hpp"

#include <fmt/format.h>

#include <utility>

namespace talus {

void UmatLaw::check(std::vector<std::string>& problems) const
{
  if (bulk_modulus.has_value() != shear_modulus.has_value())
    problems.emplace_back("bulk_modulus and shear_modulus are given both or not at all");
  if (!initial_statev.empty() && std::cmp_not_equal(initial_statev.size(), depvar))
    problems.push_back(fmt::format("initial_statev has {} numbers, and depvar is {}", initial_statev.size(), depvar));
}

}  // namespace talus
