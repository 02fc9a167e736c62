#pragma once
// Heat between the particles of bodies whose law conducts it.
#include "materials/interface/material.hpp"
#include "solver/stress/node_patch_sums.hpp"

namespace talus {

/// Sums at nodes: heat capacity and heat content, then the heat that flows in.
template <int D>
struct HeatSums {
  NodePatchSums<D, 2> content;
  NodePatchSums<D, 1> flow;
  explicit HeatSums(const Mesh<D>& mesh) : content(mesh), flow(mesh) {}
  HeatSums(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& subdomain)
      : content(ranks, mesh, subdomain), flow(ranks, mesh, subdomain)
  {}
};

/// One explicit step of  rho c dT/dt = div(k grad T)  on the linear shape functions of the mesh, insulated at every surface and between groups of particles:
///     C_v = sum_p m_p c N_v,   T_v = sum_p m_p c T_p N_v / C_v,   H_v = -sum_p V_p k (grad T)_p . grad N_v,
///     T_p <- T_p + dt sum_v N_v H_v / C_v
/// at the places of the particles after their move.  Rates are interpolated, not temperatures, so that nothing is smeared at rest; the
/// sum of m_p c T_p is kept to round-off.  Nothing happens under a law without temperature or without conductivity.
template <int D>
void conduct_heat(const Mesh<D>& mesh, const ConstitutiveLaw& law, const ParticleStrips<D>& strips, Index group, Real dt, HeatSums<D>& sums)
{
  const std::optional<HeatConduction> heat = law.heat();
  if (!heat)
    return;
  const Real conductivity = heat->conductivity, specific_heat = heat->specific_heat;
  const auto temperature = [&](const ParticlesInCell<D>& run, std::size_t p) -> Real& {
    return run.history.component(heat->temperature)[p];
  };
  const std::span<const Index> only(&group, 1);
  sums.content.gather(strips, only, [&](Index c, const ParticlesInCell<D>& run, auto& corners) {
    for_each_shape(mesh, c, run, [&](std::size_t p, const Pack& shape) {
      const Pack capacity = run.columns.mass.of(p) * specific_heat * shape;
      corners[0] += capacity;
      corners[1] += capacity * temperature(run, p);
    });
  });
  sums.flow.gather(strips, only, [&](Index c, const ParticlesInCell<D>& run, auto& corners) {
    const std::optional<Vec<D>> slope = gradient_of_mean(mesh, c, sums.content);
    if (!slope)
      return;
    Real volume = 0;
    for (std::size_t p = run.begin; p < run.end; ++p)
      volume += run.columns.volume.of(p);
    for (std::size_t a = 0; a <= D; ++a)
      corners[0][static_cast<int>(a)] = -volume * conductivity * slope->dot(mesh.gradients(c)[a]);
  });
  parallel_for_uneven(strips.blocks(), [&](Index block) {
    for_each_cell_of(strips, only, block, [&](Index c, auto&& runs) {
      std::array<Real, D + 1> change;
      for (std::size_t a = 0; a <= D; ++a) {
        const Index n = mesh.cell(c)[a];
        change[a] = sums.content[n][0] > 0 ? dt * sums.flow[n][0] / sums.content[n][0] : 0;
      }
      runs([&](const ParticlesInCell<D>& run) {
        for_each_linear_value(mesh, c, change, run, [&](std::size_t p, Real here) { temperature(run, p) += here; });
      });
    });
  });
}

}  // namespace talus
