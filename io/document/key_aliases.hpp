#pragma once
// Keys with a second name, in every mapping that has them.
#include <array>
#include <string_view>

namespace talus {

/// The other name of a key; empty if it has none.  Readers of YAML 1.1 (PyYAML, Ruby's) read the key `on` as the boolean true, and programs
/// that read and rewrite a scene with them write `true`; `where` is not changed.
constexpr std::string_view other_word_for(std::string_view key) noexcept { return key == "on" ? "where" : key == "where" ? "on" : ""; }

/// Whether such a program has turned the key `on` into this.
constexpr bool was_on(std::string_view key) noexcept { return key == "true" || key == "True"; }

/// Advice for a choice that Talus has removed: the path of a key ("projected.values") or a kernel.  Empty for any other choice.
constexpr std::string_view removed_choice(std::string_view choice) noexcept
{
  if (choice == "projected.values")
    return "the kernel has one kind of values, those of largest entropy (maxent): leave the key out";
  if (choice == "precision")
    return "particles are kept in double precision; single precision saved little time and was removed: leave the key out";
  if (choice == "umls_projected")
    return "this kernel was taken away: take projected, which has the same gradient, or umls, which has the same values";
  return "";
}

/// Advice for an unknown key about the flow of water, which has a place of its own; empty for any other key.
constexpr std::string_view advice_on_flow(std::string_view key) noexcept
{
  constexpr std::array<std::string_view, 11> flow{"permeab",  "hydraulic",     "seepage",     "darcy",         "consolidation", "biot",
                                                  "porosity", "fluid_density", "water_bulk_", "storage_coeff", "infiltration"};
  const auto has = [&](std::string_view word) {  // only at the beginning of a word: preconsolidation is a property of a skeleton
    const std::size_t at = key.find(word);
    return at != key.npos && (at == 0 || key[at - 1] == '_');
  };
  for (const std::string_view word : flow)
    if (has(word))
      return "water that flows through pores is described in the block water: flow: {bodies: [{body, porosity, permeability}]}, with the "
             "hydraulic conductivity in m/s as permeability; without flow water rests below a table";
  return "";
}

}  // namespace talus
