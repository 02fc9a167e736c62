#pragma once
// The key `resample` of a body: when its particles are split and merged.
#include <algorithm>
#include <optional>
#include <span>

#include "core/fields.hpp"

namespace talus {

/// How fine the particles of a body stay: see solver/particles/resample.hpp.
struct ResampleOptions {
  Real longest = 1;           ///< a particle longer than this is split, over the size of its cell, the D-th root of its volume [-]
  std::optional<Index> most;  ///< particles of the body in a cell, above which they are merged; has a value in a model
  Index every = 10;           ///< steps
  static constexpr auto fields()
  {
    return std::tuple{
        optional("longest", &ResampleOptions::longest, positive, "-",
                 "a particle whose longest side is above this is split, over the size of its cell, the square or cube root of the cell's "
                 "volume"),
        optional("most", &ResampleOptions::most, positive, "-",
                 "a cell with more particles of the body merges the nearest ones; default 24 in 2-D, 48 in 3-D, at least twice "
                 "particles_per_cell"),
        optional("every", &ResampleOptions::every, positive, "-", "steps from one look at the particles to the next")};
  }
  void check(std::vector<std::string>& problems) const
  {
    if (longest < least_longest)
      problems.emplace_back("longest below 0.1 splits each cell into hundreds of particles");
    if (most && *most < 2)
      problems.emplace_back("most must be at least 2");
  }
  static constexpr Real least_longest = 0.1;
};

/// Whether any body is resampled.
inline bool any_resampled(std::span<const std::optional<ResampleOptions>> bodies) noexcept
{
  return std::ranges::any_of(bodies, [](const auto& one) { return one.has_value(); });
}

}  // namespace talus
