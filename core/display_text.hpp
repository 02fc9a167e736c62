#pragma once
// Text for people and shells: durations and progress on a terminal, units with SI prefixes, quoted words of commands.
#include <filesystem>
#include <string>

#include "core/types.hpp"

namespace talus {

/// A remaining or elapsed time [s] as "2:05" or "1:02:05".
std::string in_minutes(Real seconds);

/// An estimated time [s] as "3 min 20 s", "2.5 s" or "4 h 10 min".
std::string duration_in_words(Real seconds);

/// A progress bar of `width` characters, such as "#####     "; share in [0, 1].
std::string bar(Real share, int width);

struct ScaledUnit {
  Real factor;  ///< shown value over SI value
  std::string name;
};
/// kPa, MPa, GPa for large pressures, mm for small lengths; other units stay.
ScaledUnit scaled_unit(const std::string& unit, Real largest);

/// The word, quoted so that a shell takes it as one word.
std::string shell_word(const std::filesystem::path& word);

}  // namespace talus
