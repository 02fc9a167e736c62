#include "core/spacing.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.hpp"

namespace talus {

namespace {

constexpr std::size_t sample = 250;  // points asked for their neighbours: each looks at all others, which takes no tree for so few

}  // namespace

Real spacing_of(std::span<const Real> positions, int dimension)
{
  const std::size_t n = positions.size() / 3;
  if (n < 2)
    return 1;
  const auto neighbours = std::min(2 * static_cast<std::size_t>(dimension), n - 1);
  const std::size_t stride = n / sample + 1;
  std::vector<Real> means((n + stride - 1) / stride);
  parallel_for(static_cast<Index>(means.size()), [&](Index i) {
    const std::size_t p = static_cast<std::size_t>(i) * stride;
    std::vector<Real> nearest(neighbours + 1, std::numeric_limits<Real>::infinity());  // squared, a heap; the point itself is one of them
    for (std::size_t q = 0; q < n; ++q) {
      Real square = 0;
      for (std::size_t d = 0; d < 3; ++d)
        square += (positions[3 * q + d] - positions[3 * p + d]) * (positions[3 * q + d] - positions[3 * p + d]);
      if (square < nearest.front()) {
        std::pop_heap(nearest.begin(), nearest.end());
        nearest.back() = square;
        std::push_heap(nearest.begin(), nearest.end());
      }
    }
    means[static_cast<std::size_t>(i)] =
        std::accumulate(nearest.begin(), nearest.end(), Real{0}, [](Real sum, Real square) { return sum + std::sqrt(square); }) /
        static_cast<Real>(neighbours);
  });
  const auto middle = means.begin() + static_cast<std::ptrdiff_t>(means.size() / 2);
  std::nth_element(means.begin(), middle, means.end());
  return *middle > 0 ? *middle : 1;
}

}  // namespace talus
