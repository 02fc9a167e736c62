#pragma once
// Against volumetric locking: the volume ratio that a law receives, averaged over the cells around nodes (F-bar through nodes).
#include "solver/stress/node_patch_sums.hpp"

namespace talus {

/// The averaged volume ratio of the particles of some bodies at the end of a step, into their column `averaged`, which holds V_p before:
///     J_v = sum_p N_v(x_p) V_p / sum_p N_v(x_p) V0_p,    averaged_p = sum_v N_v(x_p) J_v,
/// N the linear shape functions of the mesh, V_p = det(I + dt L_p) times the volume before the step.  An isochoric law on simplices has one
/// constraint per cell and locks; averaged over the patches of cells around nodes it has one per node, as many as in mixed elements of equal order
/// (de Souza Neto et al. 2005, IJNME 62, 353: patches of simplices; Zhao, Jiang & Choo 2023, IJNME 124, 5334: in MPM).
///
/// The bodies are averaged as if they were one: a soil that is drawn as two bodies has the ratios, bitwise, of the same soil drawn as one,
/// where its particles stand in the same order in every cell.
template <int D>
void average_volume(const Mesh<D>& mesh, const ParticleStrips<D>& strips, std::span<const Index> bodies, NodePatchSums<D, 2>& sums)
{
  sums.gather(strips, bodies, [&](Index c, const ParticlesInCell<D>& run, auto& corners) {
    for (std::size_t p = run.begin; p < run.end; ++p) {
      const auto shape = barycentric_inside(mesh, c, run.columns.x.of(p));
      for (std::size_t a = 0; a <= D; ++a) {
        corners[a][0] += shape[a] * run.columns.averaged.of(p);
        corners[a][1] += shape[a] * run.columns.volume0.of(p);
      }
    }
  });
  parallel_for_uneven(strips.blocks(), [&](Index block) {
    for_each_cell_of(strips, bodies, block, [&](Index c, auto&& runs) {
      std::array<Real, D + 1> ratio;
      for (std::size_t a = 0; a <= D; ++a) {
        const auto& [volume, volume0] = sums[mesh.cell(c)[a]].sum;
        ratio[a] = volume0 > 0 ? volume / volume0 : 1;  // nothing there: then the linear shape function of every particle is zero
      }
      runs([&](const ParticlesInCell<D>& run) {
        for (std::size_t p = run.begin; p < run.end; ++p) {
          const auto shape = barycentric_inside(mesh, c, run.columns.x.of(p));
          Real mean = 0;
          for (std::size_t a = 0; a <= D; ++a)
            mean += shape[a] * ratio[a];
          run.columns.averaged.set(p, mean);
        }
      });
    });
  });
}

}  // namespace talus
