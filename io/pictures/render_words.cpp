// Round numbers.
#include "io/pictures/render_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace talus::render {

namespace {

constexpr Real wanted_intervals = 5;
constexpr Real slack = 1e-9;  // fraction of a step: an end of the range that differs from a tick by round-off

}  // namespace

Real round_below(Real length)
{
  const Real power = std::pow(10, std::floor(std::log10(length)));
  for (const Real digit : {5.0, 2.0})
    if (digit * power <= length * (1 + slack))
      return digit * power;
  return power;
}

std::vector<Tick> ticks(Real low, Real high)
{
  const Real step = round_below(1.5 * (high - low) / wanted_intervals);  // three to eight intervals
  const Real largest = std::max(std::abs(low), std::abs(high));
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + slack)));
  constexpr Real long_number = 1e5, fine = 1e-3;  // map coordinates are long numbers that differ in their last digits
  const bool in_full = decimals < 5 && (largest < long_number || step < fine * largest);
  std::vector<Tick> list;
  for (Real i = std::ceil(low / step - slack); i * step <= high + slack * step; ++i) {
    const Real value = i * step;
    list.push_back({value, in_full ? fmt::format("{:.{}f}", value + 0.0, decimals) : fmt::format("{:.3g}", value + 0.0)});
  }
  return list;
}

std::vector<Tick> decades(Real low, Real high)
{
  const bool wide = high / low >= 100;
  std::vector<Tick> list;
  for (Real power = std::pow(10, std::floor(std::log10(low))); power <= high; power *= 10)
    for (const Real digit : {1.0, 2.0, 5.0})
      if (const Real value = digit * power; value >= low * (1 - slack) && value <= high * (1 + slack) && (digit == 1 || !wide))
        list.push_back({value, fmt::format("{:.6g}", value)});
  return list;
}

}  // namespace talus::render
