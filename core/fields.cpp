#include "core/fields.hpp"

#include <fmt/format.h>

namespace talus {

std::string to_string(const Range& range)
{
  const bool below = std::isfinite(range.low), above = std::isfinite(range.high);
  if (below && above)
    return fmt::format("{}{}, {}{}", range.low_allowed ? "[" : "(", range.low, range.high, range.high_allowed ? "]" : ")");
  if (below)
    return fmt::format("{} {}", range.low_allowed ? ">=" : ">", range.low);
  if (above)
    return fmt::format("{} {}", range.high_allowed ? "<=" : "<", range.high);
  return "any";
}

}  // namespace talus
