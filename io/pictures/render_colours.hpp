#pragma once
// Mapping of values to colours.
#include <array>

#include "io/pictures/settings/picture_settings.hpp"

namespace talus::render {

using Colour = std::array<unsigned char, 3>;

/// The colour at a fraction of a colour map.  The maps are readable with any kind of colour blindness, the first two in grey as well.
/// `share` is clamped to [0, 1]; NaN is grey.
Colour colour_of(Map map, Real share);

/// The position of a value between the ends of the colour bar.
struct Scale {
  Map map = Map::viridis;
  std::array<Real, 2> range{0, 1};  ///< values at the two ends, SI; positive if `log`
  bool log = false;
  Real share(Real value) const;  ///< NaN for values without a logarithm
  Colour colour(Real value) const { return colour_of(map, share(value)); }
};

/// The smallest and largest finite value among those added, as far as a colour bar can show them.
class Extent {
 public:
  explicit Extent(bool log) : log_(log) {}
  void add(const std::vector<Real>& values);
  /// The range of the colour bar.  A single value gets a range around it.  If `balanced` and the values have both signs, the ends are
  /// equally far from zero.
  std::array<Real, 2> range(bool balanced) const;

 private:
  bool log_;
  std::array<Real, 2> ends_{1, -1};  // empty
};

}  // namespace talus::render
