#pragma once
// Checks of words and numbers on the command line.  CLI11's own checks accept nan and print limits with 300 digits.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <cmath>
#include <string>
#include <system_error>
#include <vector>

#include "core/finite_count.hpp"

namespace talus {

inline constexpr auto set_help = "change a value of the scene: key=value, such as time.end=2 or bodies[0].particles_per_cell=6";
inline constexpr int most_steps = 10'000'000;

/// Kinds of values in the help, which a shell completes (completion.hpp): files by their names, folders, some words.
inline constexpr auto scene_value = "*.yaml", folder_value = "FOLDER";
inline std::string one_of(const std::vector<std::string>& words) { return fmt::format("{{{}}}", fmt::join(words, ",")); }

/// f(number) tells what is wrong with a number, or nothing.  What is no number at all is left to the reader of the option.
template <class F>
CLI::Validator checked_number(F&& wrong_with, const std::string& description)
{
  return {[wrong_with](const std::string& text) -> std::string {
            Real x = 0;
            const auto [end, trouble] = std::from_chars(text.data(), text.data() + text.size(), x);
            if (end != text.data() + text.size() || (trouble != std::errc() && trouble != std::errc::result_out_of_range))
              return "";
            if (!std::isfinite(x) || trouble != std::errc())
              return fmt::format("{} is no number that can be taken", text);
            const std::string wrong = wrong_with(x);
            return wrong.empty() ? "" : fmt::format("{} is {}", text, wrong);
          },
          description};
}

inline CLI::Validator number_within(Real low, Real high)
{
  return checked_number(
      [low, high](Real x) { return low <= x && x <= high ? std::string() : fmt::format("not between {} and {}", low, high); },
      fmt::format("in [{} - {}]", low, high));
}

inline CLI::Validator number_above_zero()
{
  return checked_number([](Real x) { return x > 0 ? std::string() : std::string("not above 0"); }, "POSITIVE");
}

/// A number, or a count, which must fit into its integer.
inline CLI::Validator number_not_below_zero()
{
  return checked_number(
      [](Real x) {
        return x < 0 ? std::string("below 0") : x > static_cast<Real>(most_counted) ? std::string("more than 1e18") : std::string();
      },
      "NONNEGATIVE");
}

}  // namespace talus
