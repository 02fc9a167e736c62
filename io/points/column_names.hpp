#pragma once
// What the names of columns mean that programs give them.
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.hpp"

namespace talus {

enum class PointQuantity : std::uint8_t { other, position, stress, effective_stress, pore_pressure, velocity, displacement };

/// A quantity and the number of its component: of a vector 0..2, of stress as in Sym3.
struct ColumnMeaning {
  PointQuantity quantity = PointQuantity::other;
  std::size_t component = 0;
  bool mirrored = false;  ///< yx, zy or zx: the other half of a tensor, which has to be symmetric
  bool is_stress() const noexcept { return quantity == PointQuantity::stress || quantity == PointQuantity::effective_stress; }
};

/// A name without case, blanks and signs between its parts; Greek sigma and tau written out.
std::string plain_name(std::string_view name);

/// The meanings of the names of a table: "stress_xx", "sigma_xx", "S11", "effective_stress_xy", "x", "position_y", ...  Whether the number
/// in "velocity_1" counts from zero or one, and whether "stress:3" is of six components or of nine row by row, the other names tell.
std::vector<ColumnMeaning> meanings_of(std::span<const std::string> names);
/// The meaning of a name that stands alone.
ColumnMeaning meaning_of(std::string_view name);

/// The factor to SI of a unit of stress, length or speed; 0 for another one.
Real factor_of_unit(std::string_view unit, PointQuantity quantity);
/// The factor from one unit to another of the same kind, which a history variable has; 0 if it is not known.
Real factor_between(std::string_view from, std::string_view to);
/// The units that can be given for that unit, in words: "-, 1 and %".
std::string known_units_for(std::string_view unit);

/// The columns of the components of stress in their order.
inline constexpr std::array<std::string_view, 6> stress_endings{"xx", "yy", "zz", "xy", "yz", "xz"};

}  // namespace talus
