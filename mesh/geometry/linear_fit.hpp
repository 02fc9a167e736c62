#pragma once
// Interpolation between scattered points that is exact for linear functions, also beside the points: moving least squares of first order.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/types.hpp"

namespace talus {

/// The value at a position as a sum over points, f(x) = sum of value[i] f(point[i]), and the gradient of the fitted plane in the same way.
template <int D>
struct LinearFit {
  std::vector<Index> point;
  std::vector<Real> value;
  std::vector<Vec<D>> slope;  ///< [1/m]
  Index nearest = none;       ///< the nearest point, the lowest of equals
  Real distance = 0;          ///< of it [m]
  Real radius = 0;            ///< within which points are weighed [m]

  template <class F>
  auto at(F&& f) const
  {
    std::decay_t<decltype(f(point.front()))> sum = value.front() * f(point.front());
    for (std::size_t i = 1; i < point.size(); ++i)
      sum += value[i] * f(point[i]);
    return sum;
  }
  /// The same of numbers, but between the least and the largest of these points: a plane goes on beyond the last of them, where what cannot
  /// be negative would become so.
  template <class F>
  Real at_within(F&& f) const
  {
    Real low = f(point.front()), high = low;
    for (const Index i : point)
      low = std::min<Real>(low, f(i)), high = std::max<Real>(high, f(i));
    return std::clamp<Real>(at(f), low, high);
  }
};

/// Scattered points, sorted to find the nearest ones.  Results do not depend on the order of traversal: of equally distant points the one with
/// the lower number counts as nearer.
template <int D>
class PointCloud {
 public:
  explicit PointCloud(std::vector<Vec<D>> points);

  Index size() const noexcept { return static_cast<Index>(points_.size()); }
  const Vec<D>& operator[](Index i) const noexcept { return points_[static_cast<std::size_t>(i)]; }
  /// Squared distances and numbers of the `count` nearest points, the nearest first; all if there are fewer.
  std::vector<std::pair<Real, Index>> nearest(const Vec<D>& x, Index count) const;

  /// The plane (2-D: over x and y) that fits the points around x best, with weights (1 - q)^2 / (q + 1/100), q = r^2 / h^2, that end at the
  /// distance h of the 9th (2-D) or 16th (3-D) nearest point [Lancaster & Salkauskas 1981].  Where these lie on a line or in a plane, h grows
  /// until they do not.  Nothing if all points do.
  std::optional<LinearFit<D>> fit(const Vec<D>& x) const;

 private:
  void split(std::size_t begin, std::size_t end);

  std::vector<Vec<D>> points_;
  std::vector<Index> order_;       ///< a balanced tree: the middle of a range divides it along `axis_`
  std::vector<std::int8_t> axis_;  ///< by position in `order_`
};

}  // namespace talus
