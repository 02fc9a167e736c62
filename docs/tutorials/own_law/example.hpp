#pragma once
// Goes into materials/law_examples.hpp: the parameters of the contract tests and of `talus bench`.
#include "materials/law_examples.hpp"

namespace talus {

template <>
inline Maxwell law_example()
{
  auto law = detail::elastic_example<Maxwell>();
  law.relaxation_time = 0.5;
  return law;
}

}  // namespace talus
