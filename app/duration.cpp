#include "app/duration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace talus {

std::string in_minutes(Real seconds)
{
  const auto s = static_cast<std::int64_t>(std::lround(seconds));
  return s < 3600 ? fmt::format("{}:{:02}", s / 60, s % 60) : fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

std::string bar(Real share, int width)
{
  const auto full = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * width);
  return std::string(full, '#') + std::string(static_cast<std::size_t>(width) - full, ' ');
}

}  // namespace talus
