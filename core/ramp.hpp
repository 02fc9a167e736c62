#pragma once
// How loads grow from nothing over a time.
#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "core/types.hpp"

namespace talus {

/// `linear` starts and stops at once, which sets what is loaded swinging; `smooth` starts and stops with the rate zero.
enum class RampShape : std::uint8_t { linear, smooth };
constexpr std::array<std::string_view, 2> enum_names(RampShape) { return {"linear", "smooth"}; }

/// Share of the loads at a share s of the time: 0 before it, 1 after it, in between s or s^2 (3 - 2 s).
inline Real ramp_at(RampShape shape, Real s) noexcept
{
  const Real within = std::clamp(s, Real{0}, Real{1});
  return shape == RampShape::linear ? within : within * within * (3 - 2 * within);
}

}  // namespace talus
