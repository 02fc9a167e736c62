#pragma once
// Options of the kernel `projected` in a scene.
#include "core/fields.hpp"
#include "core/types.hpp"

namespace talus {

/// The options of the kernel `projected`.
struct ProjectedOptions {
  Real alpha = 0.5;  ///< prior weight of neighbours relative to that of the node itself [-]
  static constexpr auto fields()
  {
    return std::tuple{optional("alpha", &ProjectedOptions::alpha, positive, "-", "weight of a node's neighbours beside its own")};
  }
};

}  // namespace talus
