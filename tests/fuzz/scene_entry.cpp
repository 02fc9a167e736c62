#include <algorithm>
#include <stdexcept>

#include "app/setup/expression.hpp"
#include "core/error.hpp"
#include "io/load_mesh.hpp"
#include "io/scene/reader.hpp"
#include "tests/fuzz/entries.hpp"

namespace talus {

namespace {

/// As a body's velocity and a load are asked for.
void try_formula(const std::string& text)
{
  try {
    const Vec3 place(1, 2, 3);
    evaluate(text, std::span(&place, 1));
    const Formula formula(text);
    formula(place, 4);
  } catch (const std::invalid_argument&) {  // located where it is asked for
  }
}

bool is_small(const GridSpec& grid)
{
  constexpr Index most = 8;  // along each axis: a cell takes microseconds
  return std::all_of(grid.cells.begin(), grid.cells.end(), [](Index n) { return n <= most; });
}

}  // namespace

void fuzz_scene(std::string_view bytes)
{
  try {
    const Scene scene = read_scene_text("scene.yaml", std::string(bytes), {}, Libraries::closed);
    for (const BodySpec& body : scene.bodies)
      std::for_each(body.velocity.begin(), body.velocity.end(), try_formula);
    for (const LoadSpec& load : scene.loads)
      if (const auto* force = std::get_if<BodyForceSpec>(&load))
        std::for_each(force->acceleration.begin(), force->acceleration.end(), try_formula);
    if (!scene.mesh.grid || !is_small(*scene.mesh.grid))
      return;
    if (scene.dimension == 2)
      load_mesh<2>(scene.mesh, "");
    else
      load_mesh<3>(scene.mesh, "");
  } catch (const SceneErrors&) {
  }
}

}  // namespace talus
