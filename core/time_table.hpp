#pragma once
// A function of time given by points, for ramps of gravity, prescribed velocities and tractions.
#include <algorithm>
#include <cmath>
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

}  // namespace talus
