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

/// One explicit step of  rho c dT/dt = div(k grad T)  on the linear shape functions of the mesh, insulated at every surface and between bodies:
///     C_v = sum_p m_p c N_v,   T_v = sum_p m_p c T_p N_v / C_v,   H_v = -sum_p V_p k (grad T)_p . grad N_v,
///     T_p <- T_p + dt sum_v N_v H_v / C_v
/// at the places of the particles after their move.  Rates are interpolated, not temperatures, so that nothing is smeared at rest; the
/// sum of m_p c T_p is kept to round-off.  Nothing happens under a law without temperature or without conductivity.
template <int D>
void conduct_heat(const Mesh<D>& mesh, Material& material, const CellOrder& order, Index body, Real dt, const Particles<D>& particles,
                  HeatSums<D>& sums)
{
  const std::optional<HeatConduction> heat = material.law().heat();
  if (!heat)
    return;
  const Real conductivity = heat->conductivity, specific_heat = heat->specific_heat;
  const auto temperature = [&](std::size_t p) -> Real& {
    return material.history.row(static_cast<Index>(p) - material.begin)[heat->temperature];
  };
  sums.content.gather(order, body, particles, [&](Index c, std::span<const Index> run, auto& corners) {
    for (const Index row : run) {
      const auto p = static_cast<std::size_t>(row);
      const auto shape = barycentric_inside(mesh, c, particles.x[p]);
      for (std::size_t a = 0; a <= D; ++a) {
        const Real capacity = particles.mass[p] * specific_heat * shape[a];
        corners[a][0] += capacity;
        corners[a][1] += capacity * temperature(p);
      }
    }
  });
  sums.flow.gather(order, body, particles, [&](Index c, std::span<const Index> run, auto& corners) {
    const auto& gradients = mesh.gradients(c);
    Vec<D> slope = Vec<D>::Zero();
    for (std::size_t a = 0; a <= D; ++a) {
      const auto& [capacity, content] = sums.content[mesh.cell(c)[a]].sum;
      if (!(capacity > 0))
        return;  // particles on a facet leave the corner opposite it empty: no gradient, no flow
      slope += content / capacity * gradients[a];
    }
    Real volume = 0;
    for (const Index row : run)
      volume += particles.volume[static_cast<std::size_t>(row)];
    for (std::size_t a = 0; a <= D; ++a)
      corners[a][0] = -volume * conductivity * slope.dot(gradients[a]);
  });
  parallel_for_uneven(order.blocks, [&](Index block) {
    for_each_run(order.rows(body, block), particles.cell, [&](Index c, std::span<const Index> run) {
      for (const Index row : run) {
        const auto p = static_cast<std::size_t>(row);
        const auto shape = barycentric_inside(mesh, c, particles.x[p]);
        for (std::size_t a = 0; a <= D; ++a) {
          const Index n = mesh.cell(c)[a];
          if (const Real capacity = sums.content[n][0]; capacity > 0)
            temperature(p) += dt * shape[a] * sums.flow[n][0] / capacity;
        }
      }
    });
  });
}

}  // namespace talus
