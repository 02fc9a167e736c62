#pragma once
// Numbers under names that are not known when the program is compiled, such as the parameters of a law of the user.
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace talus {

struct NamedNumber {
  std::string name;
  Real value{};
};

/// In the order in which they were given; no name occurs twice.
struct NamedNumbers {
  std::vector<NamedNumber> all;

  /// nullptr if there is none of this name.
  const Real* find(std::string_view name) const noexcept
  {
    for (const NamedNumber& one : all)
      if (one.name == name)
        return &one.value;
    return nullptr;
  }
};

}  // namespace talus
