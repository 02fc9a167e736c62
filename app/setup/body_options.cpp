#include "app/setup/body_options.hpp"

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

std::vector<std::optional<ResampleOptions>> resampling_of(const Scene& scene)
{
  const Index fewest = scene.dimension == 2 ? 24 : 48;  // 4 particles a cell, split once along each axis, are 16 and 32
  std::vector<std::optional<ResampleOptions>> all;
  for (const BodySpec& body : scene.bodies) {
    std::optional<ResampleOptions>& one = all.emplace_back(body.resample);
    if (one && !one->most)
      one->most = std::max(fewest, 2 * body.particles_per_cell.value_or(0));
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

std::string describe(const std::string& body, const ResampleOptions& resample)
{
  return fmt::format("particles of body \"{}\" are split where they are longer than {:.6g} cells, and merged where a cell has more than {}",
                     body, resample.longest, resample.most.value());
}

}  // namespace talus
