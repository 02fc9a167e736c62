#include "mesh/geometry/linear_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace talus {

namespace {

using Neighbour = std::pair<Real, Index>;  // squared distance, number

/// Weighted points around x, if they spread in every direction by more than the share `spread` of the radius.
template <int D>
std::optional<LinearFit<D>> fit_plane(const PointCloud<D>& cloud, const Vec<D>& x, std::span<const Neighbour> near, Real h2, Real spread)
{
  constexpr Real softness = 0.01;  // smaller: closer to the value of a point beside it
  LinearFit<D> fit;
  Vec<D> mean = Vec<D>::Zero();  // relative to x
  Real total = 0;
  for (const auto& [r2, i] : near) {
    const Real q = r2 / h2;
    if (!(q < 1))
      break;
    const Real weight = (1 - q) * (1 - q) / (q + softness);
    fit.point.push_back(i);
    fit.value.push_back(weight);
    mean += weight * (cloud[i] - x);
    total += weight;
  }
  if (fit.point.size() <= D)
    return std::nullopt;
  mean /= total;
  Mat<D> moments = Mat<D>::Zero();
  for (std::size_t k = 0; k < fit.point.size(); ++k) {
    const Vec<D> off = cloud[fit.point[k]] - x - mean;
    moments += fit.value[k] / total * off * off.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<Real, D, D>> solver(Eigen::Matrix<Real, D, D>(moments), Eigen::EigenvaluesOnly);
  if (!(solver.eigenvalues()[0] > spread * spread * h2))
    return std::nullopt;
  const Mat<D> inverse = moments.inverse();
  for (std::size_t k = 0; k < fit.point.size(); ++k) {
    const Vec<D> slope = fit.value[k] / total * (inverse * (cloud[fit.point[k]] - x - mean));
    fit.value[k] = fit.value[k] / total - mean.dot(slope);
    fit.slope.push_back(slope);
  }
  fit.nearest = near.front().second;
  fit.distance = std::sqrt(near.front().first);
  fit.radius = std::sqrt(h2);
  return fit;
}

}  // namespace

template <int D>
PointCloud<D>::PointCloud(std::vector<Vec<D>> points) : points_(std::move(points)), order_(points_.size()), axis_(points_.size(), 0)
{
  std::iota(order_.begin(), order_.end(), 0);
  split(0, order_.size());
}

template <int D>
void PointCloud<D>::split(std::size_t begin, std::size_t end)
{
  if (end - begin < 2)
    return;
  Vec<D> low = (*this)[order_[begin]], high = low;
  for (std::size_t i = begin; i < end; ++i) {
    low = low.cwiseMin((*this)[order_[i]]);
    high = high.cwiseMax((*this)[order_[i]]);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [this](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](Index a, Index b) {
    const Real xa = (*this)[a][axis], xb = (*this)[b][axis];
    return xa < xb || (xa == xb && a < b);
  });
  axis_[middle] = static_cast<std::int8_t>(axis);
  split(begin, middle);
  split(middle + 1, end);
}

template <int D>
std::vector<std::pair<Real, Index>> PointCloud<D>::nearest(const Vec<D>& x, Index count) const
{
  const auto wanted = static_cast<std::size_t>(std::min(count, size()));
  std::vector<Neighbour> heap;  // the farthest first
  struct OpenRange {
    std::size_t begin, end;
    Real squared;  ///< no point in it is nearer
  };
  std::vector<OpenRange> open{{0, points_.size(), 0}};
  while (wanted > 0 && !open.empty()) {
    const auto [begin, end, squared] = open.back();
    open.pop_back();
    if (begin >= end || (heap.size() == wanted && squared > heap.front().first))
      continue;
    const std::size_t middle = begin + (end - begin) / 2;
    const Index i = order_[middle];
    const Neighbour one{((*this)[i] - x).squaredNorm(), i};
    if (heap.size() < wanted) {
      heap.push_back(one);
      std::ranges::push_heap(heap);
    } else if (one < heap.front()) {
      std::ranges::pop_heap(heap);
      heap.back() = one;
      std::ranges::push_heap(heap);
    }
    const int axis = axis_[middle];
    const Real off = x[axis] - (*this)[i][axis];
    const OpenRange below{begin, middle, off > 0 ? std::max(squared, off * off) : squared};
    const OpenRange above{middle + 1, end, off < 0 ? std::max(squared, off * off) : squared};
    open.push_back(off < 0 ? above : below);
    open.push_back(off < 0 ? below : above);
  }
  std::ranges::sort_heap(heap);
  return heap;
}

template <int D>
std::optional<LinearFit<D>> PointCloud<D>::fit(const Vec<D>& x) const
{
  constexpr Index start = D == 2 ? 9 : 16;
  constexpr Real well_spread = 0.03, at_all = 1e-5;  // of the radius; digits of positions in files
  constexpr Real beyond = 1.5;                       // the radius over the farthest point, where it is the last
  for (Index count = start;; count *= 2) {
    const auto near = nearest(x, count);
    if (near.size() <= D)
      return std::nullopt;
    const bool is_all = count >= size();
    if (auto fit = fit_plane(*this, x, near, (is_all ? beyond * beyond : 1) * near.back().first, is_all ? at_all : well_spread))
      return fit;
    if (is_all)
      return std::nullopt;
  }
}

template class PointCloud<2>;
template class PointCloud<3>;

}  // namespace talus
