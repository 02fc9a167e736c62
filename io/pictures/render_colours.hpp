#pragma once
// From values to colours.
#include <array>

#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

using Colour = std::array<unsigned char, 3>;

/// The maps are readable with any kind of colour blindness, the first two in grey as well.  share in [0, 1]; outside is clamped, NaN is grey.
Colour colour_of(Map map, Real share);

/// Where a value stands between the ends of the colour bar.
struct Scale {
  Map map = Map::viridis;
  std::array<Real, 2> range{0, 1};  ///< values at the two ends, SI; positive if `log`
  bool log = false;
  Real share(Real value) const;  ///< NaN for what has no logarithm
  Colour colour(Real value) const { return colour_of(map, share(value)); }
};

/// Smallest and largest finite value of what it has seen, as far as a colour bar can show them.
class Extent {
 public:
  explicit Extent(bool log) : log_(log) {}
  void add(const std::vector<Real>& values);
  /// A single value gets a range around it, so that there is a colour for it; about zero on both sides, `balanced` ends are equally far from it.
  std::array<Real, 2> range(bool balanced) const;

 private:
  bool log_;
  std::array<Real, 2> ends_{1, -1};  // none yet
};

}  // namespace talus::render
