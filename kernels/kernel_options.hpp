#pragma once
// Options of the kernels in a scene.
#include "core/fields.hpp"
#include "core/types.hpp"

namespace talus {

enum class UmlsGradient : std::uint8_t { estimate, exact_force };
constexpr std::array<std::string_view, 2> enum_names(UmlsGradient) { return {"estimate", "exact_force"}; }

/// The options of the kernel `umls`.
struct UmlsOptions {
  UmlsGradient gradient = UmlsGradient::estimate;
  static constexpr auto fields()
  {
    return std::tuple{
        optional_choice("gradient", &UmlsOptions::gradient,
                        "estimate (of least squares, for forces and strains alike, as published) or exact_force (forces from the "
                        "exact slopes of the values, strains from the estimate)")};
  }
};

/// The options of the kernel `projected`.
struct ProjectedOptions {
  Real alpha = 0.5;  ///< prior weight of neighbours relative to that of the node itself [-]
  static constexpr auto fields()
  {
    return std::tuple{optional("alpha", &ProjectedOptions::alpha, positive, "-", "weight of a node's neighbours beside its own")};
  }
};

}  // namespace talus
