#include "app/quick.hpp"

#include <algorithm>

namespace talus {

void coarsen(Scene& scene)
{
  MeshSpec& mesh = scene.mesh;
  if (mesh.size)
    *mesh.size *= 2;
  for (RefineSpec& refine : mesh.refine)
    refine.size *= 2;
  if (mesh.grid)
    for (Index& count : mesh.grid->cells)
      count = std::max<Index>(1, count / 2);
  const Index fewest = scene.dimension == 2 ? 3 : 4;
  for (BodySpec& body : scene.bodies)
    body.particles_per_cell = std::min(body.particles_per_cell, fewest);
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
  }
  const auto fewer = [&](auto& output) {
    if (output)
      output->every = std::max(output->every * share, total * share / most_outputs);
  };
  fewer(outputs.particles);
  fewer(outputs.mesh);
  fewer(outputs.history);
}

}  // namespace talus
