#pragma once
// Keys that have a second word, in every mapping that has them.
#include <array>
#include <string_view>

namespace talus {

/// The other word for a key; empty where there is none.  Readers of YAML 1.1 (PyYAML, Ruby's) take the key `on` for the switch true, and programs
/// that read a scene with them and write it again leave `true` there: `where` comes through as it is.
constexpr std::string_view other_word_for(std::string_view key) noexcept { return key == "on" ? "where" : key == "where" ? "on" : ""; }

/// Whether such a reader has made this of the key `on`.
constexpr bool was_on(std::string_view key) noexcept { return key == "true" || key == "True"; }

/// Says what to use instead of a choice that Talus had and has no longer: the path of a key ("projected.values") or a kernel.  Empty for
/// any other choice.
constexpr std::string_view removed_choice(std::string_view choice) noexcept
{
  if (choice == "projected.values")
    return "the kernel has one kind of values, those of largest entropy (maxent): leave the key out";
  if (choice == "umls_projected")
    return "this kernel was taken away: take projected, which has the same gradient, or umls, which has the same values";
  return "";
}

/// What is to be said of a key that no mapping has, because it belongs to something that Talus does not compute; empty of any other key.
constexpr std::string_view not_computed(std::string_view key) noexcept
{
  constexpr std::array<std::string_view, 11> flow{"permeab",  "hydraulic",     "seepage",     "darcy",         "consolidation", "biot",
                                                  "porosity", "fluid_density", "water_bulk_", "storage_coeff", "infiltration"};
  const auto has = [&](std::string_view word) {  // at the beginning of a word: preconsolidation is a property of a skeleton
    const std::size_t at = key.find(word);
    return at != key.npos && (at == 0 || key[at - 1] == '_');
  };
  for (const std::string_view word : flow)
    if (has(word))
      return "Talus computes one phase: water in the pores is a hydrostatic pressure below a table (block water) that does not flow, so "
             "there is "
             "no seepage and no consolidation; leave it out. For drained soil give water.table, of each stage where it changes; for soil "
             "that "
             "is loaded faster than it drains give undrained strengths (water.undrained)";
  return "";
}

}  // namespace talus
