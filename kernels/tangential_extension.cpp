#include "kernels/tangential_extension.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "kernels/symmetric.hpp"

namespace talus {

namespace {

/// 0 below `low`, 1 above `high`, smooth between.
Real smooth_step(Real x, Real low, Real high) noexcept
{
  const Real t = std::clamp((x - low) / (high - low), Real{0}, Real{1});
  return t * t * (3 - 2 * t);
}

/// Sums over sources with weights.
template <int D>
struct SourceMoments {
  Real sum = 0;
  Vec<D> first = Vec<D>::Zero();
  Symmetric<D> second{};
  void add(Real w, const Vec<D>& arm) noexcept
  {
    sum += w;
    for (int i = 0; i < D; ++i) {
      first[i] += w * arm[i];
      for (int j = i; j < D; ++j)
        second.entry[Symmetric<D>::place(i, j)] += w * arm[i] * arm[j];
    }
  }
  /// The mean arm, and the second moments about it.
  std::pair<Vec<D>, Mat<D>> about_mean() const noexcept
  {
    const Vec<D> mean = first / sum;
    Mat<D> moments;
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j)
        moments(i, j) = second.entry[Symmetric<D>::place(std::min(i, j), std::max(i, j))] - first[i] * mean[j];
    return {mean, moments};
  }
};

/// Nodes that are filled less are extended wholly.
constexpr Real poorly_filled = 0.2;
/// The least second moment of the sources, weighted by their filling squared, over h^2 and all nodes within three rings: below `low`, as
/// around a single particle and in a film, there is no row; above `high` it counts wholly.  From a plane prototype with 37 nodes around, where
/// the limits of the sum were 0.2 and 0.8.
constexpr Real spread_low = 0.0054, spread_high = 0.0216;

}  // namespace

Real extension_fill(Real filled)
{
  constexpr Real full = 0.875, levels = 256;
  return std::floor(std::clamp(filled / full, Real{0}, Real{1}) * levels) / levels;
}

template <int D>
ExtensionRow<D> extension_row(Real fill, Real size, std::span<const ExtensionSource<D>> sources, std::size_t around, const Vec<D>& outwards)
{
  ExtensionRow<D> row;
  row.size = size;
  const Real by_fill = smooth_step(fill, poorly_filled, well_filled), length = outwards.norm();
  if (by_fill >= 1 || !(length > 0))
    return row;
  SourceMoments<D> weights, fills;
  for (const ExtensionSource<D>& source : sources) {
    const Real f = source.fill * source.fill;
    weights.add(row.weight(source), source.arm);
    if (!source.arm.isZero(0))
      fills.add(f, source.arm);
  }
  if (!(fills.sum > 0))
    return row;
  const auto [mean, moment] = weights.about_mean();
  Eigen::SelfAdjointEigenSolver<Mat<D>> solver;
  const Real spread =
      solver.computeDirect(fills.about_mean().second, Eigen::EigenvaluesOnly).eigenvalues()[0] / (size * size * static_cast<Real>(around));
  const Real share = (1 - by_fill) * smooth_step(spread, spread_low, spread_high);
  if (!(share > 0))
    return row;
  row.normal = outwards / length;
  row.own = 1 - share;
  row.slope = -share * moment.inverse() * mean;
  row.value = share / weights.sum - row.slope.dot(mean);
  return row;
}

template ExtensionRow<2> extension_row(Real, Real, std::span<const ExtensionSource<2>>, std::size_t, const Vec<2>&);
template ExtensionRow<3> extension_row(Real, Real, std::span<const ExtensionSource<3>>, std::size_t, const Vec<3>&);

}  // namespace talus
