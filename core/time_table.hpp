#pragma once
// Functions of time by which loads, prescribed velocities and tractions are multiplied: tables of points, and ramps from zero.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// A piecewise linear function of time, or of depth, between (time, value) points; constant before the first and after the last.  Times
/// increase strictly.  Without points the value is 1, so a load without a table acts in full from the start.
struct Table {
  std::vector<std::array<Real, 2>> points;  ///< {time [s], factor or value}
  Real operator()(Real time) const noexcept
  {
    if (points.empty())
      return 1;
    if (time <= points.front()[0])
      return points.front()[1];
    const auto right = std::lower_bound(points.begin(), points.end(), time, [](const auto& point, Real t) { return point[0] < t; });
    if (right == points.end())
      return points.back()[1];
    const auto& [t1, v1] = *right;
    const auto& [t0, v0] = *(right - 1);
    return v0 + (v1 - v0) * (time - t0) / (t1 - t0);
  }
  /// The largest absolute value at any time.
  Real largest_magnitude() const noexcept
  {
    Real largest = points.empty() ? 1 : 0;
    for (const auto& [time, value] : points)
      largest = std::max(largest, std::abs(value));
    return largest;
  }
};

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
