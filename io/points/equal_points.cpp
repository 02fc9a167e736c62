#include "io/points/equal_points.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/geometry/linear_fit.hpp"

namespace talus {

namespace {

constexpr Real same_value = 1e-6;  // of the largest value: single precision
constexpr std::size_t most_unequal_points = 20;

Real largest_entry(Real number) { return std::abs(number); }
template <class Vector>
Real largest_entry(const Vector& vector)
{
  Real largest = 0;
  for (const Real number : vector)
    largest = std::max(largest, std::abs(number));
  return largest;
}
Real largest_gap(Real a, Real b) { return std::abs(a - b); }
template <class Vector>
Real largest_gap(const Vector& a, const Vector& b)
{
  Real largest = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(a.size()); ++k)
    largest = std::max(largest, std::abs(*(a.begin() + static_cast<std::ptrdiff_t>(k)) - *(b.begin() + static_cast<std::ptrdiff_t>(k))));
  return largest;
}

/// Says whether two points of a table have the same values.
class SameValues {
 public:
  explicit SameValues(const StartPoints& points)
      : points_(points),
        stress_(std::max(largest(points.stress), largest(points.pore))),  // both are stresses, of which the law gets the sum
        velocity_(largest(points.velocity)),
        displacement_(largest(points.displacement))
  {
    for (const auto& [key, column] : points.history)
      history_.push_back(largest(column));
  }

  bool operator()(std::size_t i, std::size_t j) const
  {
    const auto same = [&](const auto& column, Real largest) {
      return column.empty() || largest_gap(column[i], column[j]) <= same_value * largest;
    };
    bool all = same(points_.stress, stress_) && same(points_.pore, stress_) && same(points_.velocity, velocity_) &&
               same(points_.displacement, displacement_);
    for (std::size_t k = 0; k < history_.size(); ++k)
      all = all && same(points_.history[k].second, history_[k]);
    return all;
  }

 private:
  template <class Column>
  static Real largest(const Column& column)
  {
    Real largest = 0;
    for (const auto& value : column)
      largest = std::max(largest, largest_entry(value));
    return largest;
  }

  const StartPoints& points_;
  Real stress_ = 0, velocity_ = 0, displacement_ = 0;
  std::vector<Real> history_;
};

void keep_points(const std::vector<bool>& keep, StartPoints& points)
{
  const auto thin = [&](auto& column) {
    std::size_t to = 0;
    for (std::size_t i = 0; i < column.size(); ++i)
      if (keep[i])
        column[to++] = column[i];
    column.resize(to);
  };
  thin(points.x), thin(points.stress), thin(points.pore), thin(points.velocity), thin(points.displacement);
  for (auto& [key, column] : points.history)
    thin(column);
}

template <int D>
void merge_in(const PointFile& table, const std::vector<std::size_t>& rows, StartPoints& points, std::vector<SceneError>& problems)
{
  constexpr Real same_place = 1e-9;  // of the extent
  constexpr Index most_at_a_place = 16;
  std::vector<Vec<D>> places;
  Vec<D> low = Vec<D>::Constant(std::numeric_limits<Real>::infinity()), high = -low;
  for (const auto& x : points.x) {
    places.push_back(Eigen::Map<const Vec<D>>(x.data()));
    low = low.cwiseMin(places.back()), high = high.cwiseMax(places.back());
  }
  const Real tolerance = same_place * (high - low).norm();
  const PointCloud<D> cloud(std::move(places));
  const SameValues are_same(points);
  std::vector<bool> keep(points.x.size(), true);
  for (std::size_t i = 0; i < keep.size(); ++i)
    for (const auto& [squared, other] : cloud.nearest(cloud[static_cast<Index>(i)], most_at_a_place)) {
      const auto j = static_cast<std::size_t>(other);
      if (j >= i || squared > tolerance * tolerance || !keep[j])
        continue;
      keep[i] = false;
      if (!are_same(i, j) && problems.size() < most_unequal_points)
        problems.push_back(
            {table.where(rows[i]),
             fmt::format("{}it lies where {} does, ({:.6g}), and has other values: average them, give values of cells "
                         "(data), or tell materials apart (select)",
                         table.named(rows[i]),
                         table.line.empty() ? fmt::format("point {}", rows[j]) : fmt::format("that of line {}", table.line[rows[j]]),
                         fmt::join(points.x[i].begin(), points.x[i].begin() + D, ", ")),
             ""});
      break;
    }
  points.merged = static_cast<Index>(std::ranges::count(keep, false));
  keep_points(keep, points);
}

}  // namespace

void merge_equal_points(const PointFile& table, const std::vector<std::size_t>& rows, int dimension, StartPoints& points,
                        std::vector<SceneError>& problems)
{
  dimension == 2 ? merge_in<2>(table, rows, points, problems) : merge_in<3>(table, rows, points, problems);
}

}  // namespace talus
