#pragma once
// Fields of particles and nodes that a run can write, one row each.
#include "core/tensor.hpp"
#include "io/output/quantity.hpp"

namespace talus {

/// Fields of outputs.particles, besides the history variables of laws.  The function of each is called with the `problem` and
/// the `state` of a run, and a row of the particles of that state.
constexpr auto particle_fields()
{
  using enum QuantityKind;
  return std::tuple{
      quantity<vector>("velocity", "m/s", "velocity", [](const auto& of, auto p) { return of.state.particles.v[p]; }),
      quantity<vector>("displacement", "m", "position less the reference position",
                       [](const auto& of, auto p) { return (of.state.particles.x[p] - of.state.particles.x0[p]).eval(); }),
      quantity<symmetric>("stress", "Pa", "Cauchy stress, total, positive in tension",
                          [](const auto& of, auto p) { return of.state.particles.stress[p]; }),
      quantity<number>("pressure", "Pa", "minus the mean of the normal stresses",
                       [](const auto& of, auto p) {
                         const auto stress = of.state.particles.stress[p];
                         return -(stress[0] + stress[1] + stress[2]) / 3;
                       }),
      quantity<number>("von_mises", "Pa", "von Mises stress",
                       [](const auto& of, auto p) { return von_mises(unpack(of.state.particles.stress[p])); }),
      quantity<number>("pore_pressure", "Pa", "pressure of water in the pores; 0 where there is none",
                       [](const auto& of, auto p) {
                         return !of.state.particles.water.empty() ? Real{of.state.particles.water[p]}
                                : of.state.particles.pore.empty() ? Real{0}
                                                                  : Real{of.state.particles.pore[p]};
                       }),
      quantity<symmetric>("effective_stress", "Pa", "stress plus pore pressure",
                          [](const auto& of, auto p) {
                            Sym3 stress = of.state.particles.stress[p];
                            if (!of.state.particles.pore.empty())
                              stress.head<3>().array() += of.state.particles.pore[p];
                            return stress;
                          }),
      quantity<number>("excess_pore_pressure", "Pa", "of water that flows: its pressure less that of water at rest below water.table",
                       [](const auto& of, auto p) {
                         return of.state.particles.water.empty() ? Real{0}
                                                                 : of.state.particles.water[p] - of.state.particles.water_at_rest[p];
                       }),
      quantity<number>("saturation", "-", "share of the pores that water fills; 0 where none can flow",
                       [](const auto& of, auto p) {
                         const auto* pores = of.problem.flow.pores_of(body_of(of.state.bodies, static_cast<Index>(p)));
                         return pores != nullptr ? pores->retention.saturation(of.state.particles.water[p]) : Real{0};
                       }),
      quantity<vector>("seepage_velocity", "m/s", "volume of water that flows through the pores, per area and time (Darcy)",
                       [](const auto& of, auto p) { return seepage_velocity(of.problem, of.state, p); }),
      quantity<number>("volume", "m^D", "volume now, of unit thickness in 2-D",
                       [](const auto& of, auto p) { return of.state.particles.F[p].determinant() * of.state.particles.volume0[p]; }),
      quantity<number>("mass", "kg", "mass", [](const auto& of, auto p) { return of.state.particles.mass[p]; }),
      quantity<number>("cell", "-", "number of the cell of the mesh", [](const auto& of, auto p) { return of.state.particles.cell[p]; }),
      quantity<number>("body", "-", "number of the body in the scene, from 0",
                       [](const auto& of, auto p) { return body_of(of.state.bodies, static_cast<Index>(p)); }),
      quantity<tensor>("F", "-", "deformation gradient, by rows", [](const auto& of, auto p) { return of.state.particles.F[p]; }),
      quantity<tensor>("velocity_gradient", "1/s", "velocity gradient, by rows",
                       [](const auto& of, auto p) { return embed(of.state.particles.L[p]); })};
}

/// The sum of of(nodes) over the velocity fields of a RunView.
template <class Run, class F>
auto sum_over_fields(const Run& run, F&& of)
{
  auto sum = of(run.fields.front().nodes);
  for (const auto& field : run.fields.subspan(1))
    sum += of(field.nodes);
  return sum;
}

/// Fields of outputs.mesh, with the values of the last step.  The function of each is called with a RunView and a row of its nodes.
constexpr auto node_fields()
{
  using enum QuantityKind;
  return std::tuple{
      quantity<number>("mass", "kg", "mass",
                       [](const auto& run, auto n) { return sum_over_fields(run, [&](const auto& nodes) { return nodes.sum[n].mass; }); }),
      // Bodies in contact have velocities of their own: the mean, weighted by mass.
      quantity<vector>("velocity", "m/s", "velocity",
                       [](const auto& run, auto n) {
                         auto v = run.fields.front().nodes.motion[n].v;
                         const auto mass = sum_over_fields(run, [&](const auto& nodes) { return nodes.sum[n].mass; });
                         if (run.fields.size() > 1 && mass > 0)
                           v = sum_over_fields(run, [&](const auto& nodes) { return (nodes.sum[n].mass * nodes.motion[n].v).eval(); }) /
                               mass;
                         return v;
                       }),
      quantity<vector>("force", "N", "internal force and loads other than gravity",
                       [](const auto& run, auto n) { return sum_over_fields(run, [&](const auto& nodes) { return nodes.sum[n].force; }); }),
      // The change of momentum not due to forces and gravity; nodes with a boundary condition are not damped.
      quantity<vector>("reaction", "N", "force of all walls on the node", [](const auto& run, auto n) {
        return sum_over_fields(run, [&](const auto& nodes) {
          const auto& sum = nodes.sum[n];
          auto force = sum.force;
          if (nodes.active[n] == 0 || nodes.bound[n] == 0 || nodes.kick == 0)
            force.setZero();
          else
            force = sum.mass * (nodes.motion[n].change / nodes.kick - nodes.gravity) - sum.force;
          return force;
        });
      })};
}

}  // namespace talus
