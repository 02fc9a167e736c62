#pragma once
// Choices of the kernel `projected`, as a scene declares them.
#include "core/fields.hpp"
#include "core/types.hpp"

namespace talus {

enum class ValueStencil : std::uint8_t { maxent, l2, mls };
constexpr std::array<std::string_view, 3> enum_names(ValueStencil) { return {"maxent", "l2", "mls"}; }

/// What a scene may choose of the kernel `projected`.
struct ProjectedOptions {
  ValueStencil values = ValueStencil::maxent;
  Real alpha = 0.5;  ///< weight of neighbours beside that of the node itself, of maxent and mls [-]
  static constexpr auto fields()
  {
    return std::tuple{
        optional_choice("values", &ProjectedOptions::values,
                        "maxent (positive, exact for linear fields), l2 (positive, lumped projection) or mls (exact, not positive)"),
        optional("alpha", &ProjectedOptions::alpha, positive, "-", "weight of a node's neighbours beside its own, of maxent and mls")};
  }
};

}  // namespace talus
