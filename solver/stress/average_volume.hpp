#pragma once
// Against volumetric locking: the volume ratio that a law receives, averaged over the cells around nodes (F-bar through nodes).
#include "solver/stress/node_patch_sums.hpp"

namespace talus {

/// Bodies whose volumes are averaged as if they were one, and the sums over them.
///
/// The averaged volume ratio of a particle at the end of a step is
///     J_v = sum_p N_v(x_p) V_p / sum_p N_v(x_p) V0_p,    averaged_p = sum_v N_v(x_p) J_v,
/// N the linear shape functions of the mesh, V_p = det(I + dt L_p) times the volume before the step.  An isochoric law on simplices has one
/// constraint per cell and locks; averaged over the patches of cells around nodes it has one per node, as many as in mixed elements of equal order
/// (de Souza Neto et al. 2005, IJNME 62, 353: patches of simplices; Zhao, Jiang & Choo 2023, IJNME 124, 5334: in MPM).
///
/// A soil that is drawn as two bodies has the ratios, bitwise, of the same soil drawn as one, where its particles stand in the same order in
/// every cell.
template <int D>
struct AveragedBodies {
  std::vector<Index> groups;  ///< of particles, see ParticleStrips
  NodePatchSums<D, 2> sums;

  /// Sums the particles of a block, whose column `averaged` holds V_p; then sums.assemble().
  void sum_block(const Mesh<D>& mesh, const ParticleStrips<D>& strips, Index block)
  {
    sums.sum_block(strips, groups, block, [&](Index c, const ParticlesInCell<D>& run, auto& corners) {
      for_each_shape(mesh, c, run, [&](std::size_t p, const Pack& shape) {
        corners[0] += shape * run.columns.averaged.of(p);
        corners[1] += shape * run.columns.volume0.of(p);
      });
    });
  }
  /// Sets `averaged` of the particles of a block to their averaged ratio.
  void average_block(const Mesh<D>& mesh, const ParticleStrips<D>& strips, Index block) const
  {
    for_each_cell_of(strips, std::span<const Index>(groups), block, [&](Index c, auto&& runs) {
      std::array<Real, D + 1> ratio;
      for (std::size_t a = 0; a <= D; ++a) {
        const auto& [volume, volume0] = sums[mesh.cell(c)[a]].sum;
        ratio[a] = volume0 > 0 ? volume / volume0 : 1;  // nothing there: then the linear shape function of every particle is zero
      }
      runs([&](const ParticlesInCell<D>& run) {
        for_each_linear_value(mesh, c, ratio, run, [&](std::size_t p, Real mean) { run.columns.averaged.set(p, mean); });
      });
    });
  }
};

}  // namespace talus
