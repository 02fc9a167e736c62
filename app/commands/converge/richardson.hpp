#pragma once
// A number that was computed with cells of several sizes: observed order, extrapolated value, grid convergence index.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/types.hpp"

namespace talus {

/// What the values say of convergence.  Only `converges` and `constant` have an extrapolated value.
enum class Convergence : std::uint8_t {
  converges,
  constant,              ///< the same at all sizes
  oscillates,            ///< the changes alternate in sign and fall: oscillatory convergence
  oscillates_and_grows,  ///< the changes alternate in sign and do not fall: oscillatory divergence
  diverges,              ///< the changes have one sign and do not fall
  order_low,             ///< below `lowest_order`
  order_high,            ///< above `highest_order`
  unsteady,              ///< the next coarser sizes have another order, or none
  undecided,             ///< the two finest values are equal, the coarser one is not: no order follows
  no_value,              ///< missing at some size
};
constexpr std::array<std::string_view, 10> enum_names(Convergence)
{
  return {"converges", "constant", "oscillates", "osc. grows", "diverges", "order<0.5", "order>3", "unsteady", "undecided", "no value"};
}
/// One sentence on such values, for a warning or a legend.
std::string_view meaning_of(Convergence verdict) noexcept;

/// The direction of the changes as cells become smaller.
enum class Trend : std::uint8_t { rises, falls, turns, stays };
constexpr std::array<std::string_view, 4> enum_names(Trend) { return {"rises", "falls", "turns", "stays"}; }

/// Orders that are believed.  The method is of second order where all is smooth and of first order at fronts and where material yields.
/// Below the lowest, an extrapolation goes several times as far as the values differ; above the highest, an order is an accident.
inline constexpr Real lowest_order = 0.5, highest_order = 3;
/// The grid convergence index takes no higher order than that of linear shape functions.
inline constexpr Real formal_order = 2;
/// Factor of the grid convergence index for three sizes [Roache 1994, 1998].
inline constexpr Real safety_factor = 1.25;
/// Orders of successive sizes that differ by more than this are `unsteady`.
inline constexpr Real steady_within = 1;

struct Extrapolation {
  Convergence verdict = Convergence::no_value;
  Trend trend = Trend::stays;
  std::optional<Real> order;         ///< observed order, also one that is not believed [-]
  std::optional<Real> extrapolated;  ///< value for cells of no size, in the unit of the number
  std::optional<Real> uncertainty;   ///< grid convergence index of the finest value, in the unit of the number
};

/// The order p of three values with changes of one sign: the root of
///   ratio_fine^p (ratio_coarse^p - 1) / (ratio_fine^p - 1) = change_coarse / change_fine,
/// eq. 3 of Celik, Ghia, Roache, Freitas, Coleman & Raad 2008 (J. Fluids Eng. 130, 078001).  The equation is solved by bisection: its left
/// side grows with p, and their fixed-point iteration fails where ratio_coarse > ratio_fine^2.  Ratios are sizes of cells over the next
/// smaller ones, above 1.  Nothing if no positive p solves it: the changes do not fall with the sizes.  Infinite above 20.
std::optional<Real> observed_order(Real change_coarse, Real change_fine, Real ratio_coarse, Real ratio_fine) noexcept;

/// Judges values at `sizes` [m], from coarse to fine, at least three of each.  The three finest count; coarser ones only have to agree.
/// Differences up to `floor`, in the unit of the values, are rounding.
/// Extrapolated value: eq. 5, grid convergence index: eq. 7 of Celik et al. 2008, with the order limited to `formal_order`.
Extrapolation extrapolate(std::span<const Real> sizes, std::span<const Real> values, Real floor) noexcept;

}  // namespace talus
