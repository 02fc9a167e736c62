#include "app/setup/references_of_scene.hpp"

#include <fmt/format.h>

#include "io/scene/scene_rules.hpp"

namespace talus {

std::vector<ReferenceOptions> references_of(const Scene& scene)
{
  std::vector<ReferenceOptions> all;
  for (const BodySpec& body : scene.bodies) {
    ReferenceOptions& reference = all.emplace_back(body.reference.value_or(ReferenceOptions()));
    if (!reference.shift && !contacts_of_body(scene, body).empty())
      reference.shift = ReferenceOptions::default_shift;
  }
  return all;
}

std::string describe(const std::string& body, const ReferenceOptions& reference)
{
  if (reference.update == ReferenceUpdate::never)
    return fmt::format("body \"{}\" keeps its first reference configuration (total Lagrangian)", body);
  std::string text = fmt::format("body \"{}\" takes a new reference configuration at a {} of {:.6g}", body,
                                 reference.volume_change ? "change of volume" : "distortion", reference.largest_strain());
  if (reference.shift)
    text += fmt::format(" or a shift of {:.6g} altitudes of a cell", *reference.shift);
  return text;
}

}  // namespace talus
