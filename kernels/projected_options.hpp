#pragma once
// Choices of the kernel `projected`, as a scene declares them.
#include "core/fields.hpp"
#include "core/types.hpp"

namespace talus {

/// What a scene may choose of the kernel `projected`.
struct ProjectedOptions {
  Real alpha = 0.5;  ///< weight of neighbours beside that of the node itself [-]
  static constexpr auto fields()
  {
    return std::tuple{optional("alpha", &ProjectedOptions::alpha, positive, "-", "weight of a node's neighbours beside its own")};
  }
};

}  // namespace talus
