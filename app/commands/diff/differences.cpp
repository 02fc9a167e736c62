#include "app/commands/diff/differences.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace talus {

namespace {

constexpr Real same_time = 1e-12;  // relative; two runs may add the same steps in another order

/// Walks along two ascending lists at once.  comes_before(x, y) is false in both directions for items that belong together.
template <class T, class Before>
Pairs match_in_order(std::span<const T> a, std::span<const std::size_t> order_a, std::span<const T> b, std::span<const std::size_t> order_b,
                     Before&& comes_before)
{
  Pairs pairs;
  std::size_t i = 0, j = 0;
  while (i < order_a.size() || j < order_b.size()) {
    if (j == order_b.size() || (i < order_a.size() && comes_before(a[order_a[i]], b[order_b[j]])))
      pairs.only_a.push_back(order_a[i++]);
    else if (i == order_a.size() || comes_before(b[order_b[j]], a[order_a[i]]))
      pairs.only_b.push_back(order_b[j++]);
    else
      pairs.both.emplace_back(order_a[i++], order_b[j++]);
  }
  return pairs;
}

template <class T>
std::vector<std::size_t> ascending(std::span<const T> values)
{
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!std::is_sorted(values.begin(), values.end()))
    std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return values[i] < values[j]; });
  return order;
}

/// |a - b|; infinite if the difference is not defined and they are not equal.
Real distance(Real a, Real b)
{
  if (a == b || (std::isnan(a) && std::isnan(b)))
    return 0;
  const Real d = std::abs(a - b);
  return std::isnan(d) ? std::numeric_limits<Real>::infinity() : d;
}

}  // namespace

Pairs match_times(std::span<const Real> a, std::span<const Real> b)
{
  return match_in_order(a, ascending(a), b, ascending(b),
                        [](Real s, Real t) { return t - s > same_time * std::max(std::abs(s), std::abs(t)); });
}

Pairs match_ids(std::span<const std::int64_t> a, std::span<const std::int64_t> b)
{
  return match_in_order(a, ascending(a), b, ascending(b), [](std::int64_t i, std::int64_t j) { return i < j; });
}

Real largest_modulus(std::span<const Real> values)
{
  Real largest = 0;
  for (const Real value : values)
    if (std::isfinite(value))
      largest = std::max(largest, std::abs(value));
  return largest;
}

Gap compare(std::span<const Real> a, std::span<const Real> b, int components, std::span<const std::pair<std::size_t, std::size_t>> rows,
            Real tolerance)
{
  const auto width = static_cast<std::size_t>(components);
  Gap gap;
  gap.values = static_cast<std::int64_t>(width * rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < width; ++c) {
      const Real value_a = a[width * rows[r].first + c], value_b = b[width * rows[r].second + c];
      const Real d = distance(value_a, value_b);
      gap.differing += d > tolerance || std::isinf(d) ? 1 : 0;  // infinite differences count even with an infinite tolerance
      if (d > gap.largest) {
        gap.largest = d;
        gap.pair = r;
        gap.component = static_cast<int>(c);
        gap.a = value_a;
        gap.b = value_b;
      }
    }
  return gap;
}

}  // namespace talus
