#pragma once
// On which side of a sheet a particle is.
#include <cmath>

#include "core/types.hpp"

namespace talus {

/// A sheet parts the velocities of the material in front of it from those behind it.  A particle near a sheet has a side, which it keeps
/// while its nearest point of the sheet is not on the rim: so a particle that the sheet pushes is not lost to the other side (the colours of
/// Hu et al., A moving least squares material point method with displacement discontinuity and two-way rigid body coupling, 2018).
struct SideOfSheet {
  Index sheet = none;    ///< the nearest one; none: no sheet is near
  bool behind = false;   ///< the sheet
  bool kept = false;     ///< the nearest point of the sheet is not on its rim
  bool changes = false;  ///< in the strips of the other side until the next step: `behind` is that of the next step

  /// The number in the column `side` of particles.
  Real number() const noexcept
  {
    if (sheet == none)
      return changes ? change : 0;
    const Real size = 2 * sheet + (kept ? 2 : 1);
    return (behind ? -size : size) + (changes ? change : 0);
  }
  explicit SideOfSheet(Real number) noexcept : changes(number > change / 2)
  {
    const Real side = changes ? number - change : number;
    if (side == 0)
      return;
    const auto size = static_cast<Index>(std::abs(side)) - 1;
    sheet = size / 2, kept = size % 2 != 0, behind = side < 0;
  }
  SideOfSheet() = default;
  /// Whether the strips have the particle among those behind a sheet.
  bool is_stored_behind() const noexcept { return behind != changes; }
  friend bool operator==(const SideOfSheet&, const SideOfSheet&) = default;

 private:
  static constexpr Real change = 1 << 20;
};

}  // namespace talus
