#include "app/setup/quick.hpp"

#include <algorithm>

#include "io/scene/accuracy.hpp"

namespace talus {

void coarsen(Scene& scene)
{
  scale_cells(scene.mesh, 2);
  const Index fewest = scene.dimension == 2 ? 3 : 4;
  for (BodySpec& body : scene.bodies)
    if (body.fills())
      body.particles_per_cell = std::min(body.particles_per_cell.value_or(fewest), fewest);
}

void shorten(Real dt, std::vector<Stage>& stages, OutputSpec& outputs)
{
  constexpr Real most_outputs = 4;
  Real total = 0;
  for (const Stage& stage : stages)
    total += stage.duration;
  const Real share = std::min(Real{1}, quick_steps * dt / total);
  for (Stage& stage : stages) {
    stage.duration *= share;
    stage.ramp *= share;
    stage.residual.reset();
    if (stage.equilibrium)
      stage.equilibrium->most_unbalanced.reset();
  }
  const auto fewer = [&](auto& output) {
    if (output)
      output->every = std::max(output->every * share, total * share / most_outputs);
  };
  fewer(outputs.particles);
  fewer(outputs.mesh);
  fewer(outputs.history);
  fewer(outputs.runout);
  if (outputs.runout && outputs.runout->frames_every)
    outputs.runout->frames_every = std::max(*outputs.runout->frames_every * share, total * share / most_outputs);
}

}  // namespace talus
