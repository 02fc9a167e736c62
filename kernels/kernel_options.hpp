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

enum class AtSurfaces : std::uint8_t { plain, extended };
constexpr std::array<std::string_view, 2> enum_names(AtSurfaces) { return {"plain", "extended"}; }

/// The options of the kernel `projected`.
struct ProjectedOptions {
  AtSurfaces surfaces = AtSurfaces::plain;
  static constexpr auto fields()
  {
    return std::tuple{optional_choice(
        "surfaces", &ProjectedOptions::surfaces,
        "plain or extended (gradients beside a free surface continue the motion inside along the surface: bodies that bend are "
        "stiffer and lose a half to a fifth of the energy, in 2.5 times the time; not for ground under its weight, whose free "
        "surfaces then creep)")};
  }
};

}  // namespace talus
