#include "core/display_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

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

ScaledUnit scaled_unit(const std::string& unit, Real largest)
{
  const auto scaled = [&](Real factor, const char* prefix) { return ScaledUnit{factor, prefix + unit}; };
  if (unit == "Pa" && largest >= 1e9)
    return scaled(1e-9, "G");
  if (unit == "Pa" && largest >= 1e6)
    return scaled(1e-6, "M");
  if (unit == "Pa" && largest >= 1e3)
    return scaled(1e-3, "k");
  if (unit == "m" && largest < 0.1)
    return scaled(1e3, "m");
  return {1, unit};
}

std::string shell_word(const std::filesystem::path& word)
{
  const std::string text = word.string();
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=,:+@%";
  if (!text.empty() && text.find_first_not_of(plain) == text.npos)
    return text;
  std::string out = "'";
  for (const char c : text)
    out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace talus
