#include "core/format_duration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/finite_count.hpp"

namespace talus {

std::string in_minutes(Real seconds)
{
  const auto s = counted(std::round(seconds));
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60) : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::string duration_in_words(Real seconds)
{
  constexpr std::int64_t minute = 60, hour = 3600, day = 24 * hour;
  const auto whole = counted(std::round(seconds));
  if (seconds < 9.95)
    return fmt::format("{:.2g} s", seconds);
  if (whole < minute)
    return fmt::format("{} s", whole);
  if (whole < hour)
    return fmt::format("{} min {} s", whole / minute, whole % minute);
  if (whole < day)
    return fmt::format("{} h {} min", whole / hour, whole % hour / minute);
  return fmt::format("{} days {} h", whole / day, whole % day / hour);
}

std::string bar(Real share, int width)
{
  const auto full = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * width);
  return std::string(full, '#') + std::string(static_cast<std::size_t>(width) - full, ' ');
}

}  // namespace talus
