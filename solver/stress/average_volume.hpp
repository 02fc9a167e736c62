#pragma once
// Against volumetric locking: the volume ratio that a law receives, averaged over the cells around nodes (F-bar through nodes).
#include "core/particles.hpp"
#include "solver/stress/node_patch_sums.hpp"

namespace talus {

/// The averaged volume ratio of the particles of some bodies at the end of a step, into `averaged`:
///     J_v = sum_p N_v(x_p) V_p / sum_p N_v(x_p) V0_p,    averaged_p = sum_v N_v(x_p) J_v,
/// N the linear shape functions of the mesh, V_p = det(I + dt L_p) times the volume before the step.  An isochoric law on simplices has one
/// constraint per cell and locks; averaged over the patches of cells around nodes it has one per node, as many as in mixed elements of equal order
/// (de Souza Neto et al. 2005, IJNME 62, 353: patches of simplices; Zhao, Jiang & Choo 2023, IJNME 124, 5334: in MPM).
///
/// The bodies are averaged as if they were one: a soil that is drawn as two bodies has the ratios, bitwise, of the same soil drawn as one,
/// where its particles stand in the same order in every cell.
template <int D>
void average_volume(const Mesh<D>& mesh, const CellOrder& order, std::span<const Index> bodies, Real dt, const Particles<D>& particles,
                    NodePatchSums<D, 2>& sums, std::vector<Real>& averaged)
{
  sums.gather(order, bodies, particles, [&](Index c, std::span<const Index> run, auto& corners) {
    for (const Index row : run) {
      const auto p = static_cast<std::size_t>(row);
      const auto shape = barycentric_inside(mesh, c, particles.x[p]);
      const Real volume = (Mat<D>::Identity() + dt * particles.L[p]).determinant() * particles.volume[p];
      for (std::size_t a = 0; a <= D; ++a) {
        corners[a][0] += shape[a] * volume;
        corners[a][1] += shape[a] * particles.volume0[p];
      }
    }
  });
  parallel_for_uneven(order.blocks, [&](Index block) {
    for_each_cell_of(order, bodies, block, particles.cell, [&](Index c, auto&& runs) {
      std::array<Real, D + 1> ratio;
      for (std::size_t a = 0; a <= D; ++a) {
        const auto& [volume, volume0] = sums[mesh.cell(c)[a]].sum;
        ratio[a] = volume0 > 0 ? volume / volume0 : 1;  // nothing there: then the linear shape function of every particle is zero
      }
      runs([&](std::span<const Index> run) {
        for (const Index row : run) {
          const auto p = static_cast<std::size_t>(row);
          const auto shape = barycentric_inside(mesh, c, particles.x[p]);
          Real mean = 0;
          for (std::size_t a = 0; a <= D; ++a)
            mean += shape[a] * ratio[a];
          averaged[p] = mean;
        }
      });
    });
  });
}

}  // namespace talus
