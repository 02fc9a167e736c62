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
  std::optional<Real> shift;       ///< largest distance from the reference position, over the altitude of the cell [-]
  /// Renewed in one piece.  Without a limit of the shift, parts renewed at different times would lie far apart in the mesh.
  bool whole = false;
  static constexpr auto fields()
  {
    return std::tuple{
        optional_choice("update", &ReferenceOptions::update,
                        "always: in each step (updated Lagrangian); adaptive: where the body has deformed or moved; never: total Lagrangian"),
        optional("distortion", &ReferenceOptions::distortion, positive, "-",
                 "adaptive: largest strain since the last renewal, as an entry of (G^T G - I) / 2; default 0.05"),
        optional("shift", &ReferenceOptions::shift, positive, "-",
                 "adaptive: largest distance from the place of the last renewal, over the smallest altitude of the cell; default 0.1"),
        optional("whole", &ReferenceOptions::whole, any, "-",
                 "adaptive: renews the body in one piece and only by its distortion, however far it moves; otherwise eight cells at a time")};
  }
  void check(std::vector<std::string>& problems) const
  {
    if (update != ReferenceUpdate::adaptive && (distortion || shift || whole))
      problems.emplace_back("distortion, shift and whole say when `update: adaptive` renews: leave them out, or choose it");
    if (whole && shift)
      problems.emplace_back("a body that is renewed as a whole is not renewed for its shift: leave one of them out");
  }
  bool renews_in_parts() const noexcept { return update == ReferenceUpdate::adaptive && !whole; }
  bool renews_whole() const noexcept { return update == ReferenceUpdate::adaptive && whole; }
};

/// Whether any body keeps a reference configuration.
inline bool has_reference(std::span<const ReferenceOptions> bodies) noexcept
{
  return std::ranges::any_of(bodies, [](const ReferenceOptions& one) { return one.update != ReferenceUpdate::always; });
}

}  // namespace talus
