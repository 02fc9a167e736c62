#include "io/scene/accuracy.hpp"

#include <algorithm>
#include <cmath>

namespace talus {

namespace {

struct Preset {
  Real cells;  ///< factor of the cell sizes
  Index particles_2d, particles_3d;
  Real cfl;
};

Preset preset_of(Accuracy accuracy)
{
  switch (accuracy) {
    case Accuracy::draft: return {.cells = 2, .particles_2d = 3, .particles_3d = 4, .cfl = 0.8};
    case Accuracy::fine: return {.cells = 0.5, .particles_2d = 12, .particles_3d = 14, .cfl = 0.4};
    case Accuracy::standard: break;
  }
  return {.cells = 1, .particles_2d = 4, .particles_3d = 4, .cfl = 0.4};
}

void scale_cells(TerrainSpec& terrain, Real factor)
{
  for (LayerSpec& layer : terrain.layers)
    if (layer.size)
      *layer.size *= factor;
  if (terrain.air && terrain.air->size)
    *terrain.air->size *= factor;
  for (FinerSpec& finer : terrain.refine)
    finer.size *= factor;
}

}  // namespace

void scale_cells(MeshSpec& mesh, Real factor)
{
  if (mesh.size)
    *mesh.size *= factor;
  for (RefineSpec& refine : mesh.refine)
    refine.size *= factor;
  if (mesh.grid)
    for (Index& count : mesh.grid->cells)
      count = std::max<Index>(1, static_cast<Index>(std::lround(count / factor)));
  if (mesh.terrain)
    scale_cells(*mesh.terrain, factor);
}

void settle_accuracy(Scene& scene)
{
  const Preset preset = preset_of(scene.accuracy);
  scale_cells(scene.mesh, preset.cells);
  scene.time.cfl = scene.time.cfl.value_or(preset.cfl);
  for (BodySpec& body : scene.bodies)
    if (body.fills())
      body.particles_per_cell = body.particles_per_cell.value_or(scene.dimension == 2 ? preset.particles_2d : preset.particles_3d);
}

}  // namespace talus
