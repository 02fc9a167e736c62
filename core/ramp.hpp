#pragma once
// Loads that increase from zero over a time.
#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "core/types.hpp"

namespace talus {

/// The shape of a ramp.  `linear` starts and stops abruptly, which excites oscillations; `smooth` starts and stops with zero rate.
enum class RampShape : std::uint8_t { linear, smooth };
constexpr std::array<std::string_view, 2> enum_names(RampShape) { return {"linear", "smooth"}; }

/// The factor of the loads at the fraction s of the ramp time: 0 before, 1 after, in between s or s^2 (3 - 2 s).
inline Real ramp_at(RampShape shape, Real s) noexcept
{
  const Real within = std::clamp(s, Real{0}, Real{1});
  return shape == RampShape::linear ? within : within * within * (3 - 2 * within);
}

}  // namespace talus
