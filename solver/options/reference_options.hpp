#pragma once
// The key `reference` of a body: when it takes its present configuration as the reference of its weights.
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/fields.hpp"

namespace talus {

enum class ReferenceUpdate : std::uint8_t { always, adaptive, never };
constexpr std::array<std::string_view, 3> enum_names(ReferenceUpdate) { return {"always", "adaptive", "never"}; }

/// The reference configuration of a body: see solver/strips/reference.hpp.
struct ReferenceOptions {
  static constexpr Real default_distortion = 0.05, default_shift = 0.1;

  ReferenceUpdate update = ReferenceUpdate::always;
  std::optional<Real> distortion;  ///< largest entry of |G^T G - I| / 2 before it is renewed [-]
  /// Instead: largest |det G - 1| [-], the criterion of Su, Xue, Han, Jiang & Aanjaneya 2022, who take 0.01 for fluids, 0.5 for soft solids.
  std::optional<Real> volume_change;
  std::optional<Real> shift;  ///< largest distance from the reference position, over the altitude of the cell; none: does not count [-]
  static constexpr auto fields()
  {
    return std::tuple{
        optional_choice(
            "update", &ReferenceOptions::update,
            "always: in each step (updated Lagrangian); adaptive: when the body has strained or moved; never: total Lagrangian"),
        optional("distortion", &ReferenceOptions::distortion, positive, "-",
                 "adaptive: largest strain since the last renewal, as an entry of (G^T G - I) / 2; default 0.05"),
        optional("volume_change", &ReferenceOptions::volume_change, positive, "-",
                 "adaptive: largest |det G - 1| since the last renewal; instead of a distortion"),
        optional("shift", &ReferenceOptions::shift, positive, "-",
                 "adaptive: largest distance from the place of the last renewal, over the smallest altitude of the cell; default 0.1, or "
                 "none for a body that can touch nothing")};
  }
  void check(std::vector<std::string>& problems) const
  {
    if (update != ReferenceUpdate::adaptive && (distortion || volume_change || shift))
      problems.emplace_back("distortion, volume_change and shift say when `update: adaptive` renews: leave them out, or choose it");
    if (distortion && volume_change)
      problems.emplace_back("give one of distortion and volume_change");
  }
  bool is_renewed(bool due) const noexcept { return update == ReferenceUpdate::always || (update == ReferenceUpdate::adaptive && due); }
  /// The largest distortion, or change of volume.
  Real largest_strain() const noexcept { return volume_change ? *volume_change : distortion.value_or(default_distortion); }
};

/// Whether any body keeps a reference configuration.
inline bool has_reference(std::span<const ReferenceOptions> bodies) noexcept
{
  return std::ranges::any_of(bodies, [](const ReferenceOptions& one) { return one.update != ReferenceUpdate::always; });
}

}  // namespace talus
