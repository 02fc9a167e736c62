#pragma once
// How fast water flows through pores.
#include "core/parallel/threads.hpp"
#include "solver/model/problem.hpp"
#include "solver/model/state.hpp"

namespace talus {

/// The mass of water per volume [kg/m^3]: its unit weight is that under gravity, or under 9.81 m/s^2 where a scene has none.
template <int D>
Real density_of_water(const Problem<D>& problem)
{
  const Real gravity = problem.loads.gravity.acceleration.norm();
  return problem.flow.unit_weight / (gravity > 0 ? gravity : Real{9.81});
}

/// The weight of water [N/m^3] at a time [s], as gravity acts then.
template <int D>
Vec<D> weight_of_water(const Problem<D>& problem, const StageState& stage, Real time)
{
  return density_of_water(problem) * problem.loads.gravity(time, stage.ramp(time));
}

/// What forces per mass that depend on the place do to water at x [N/m^3].
template <int D>
Vec<D> force_on_water(const Problem<D>& problem, const StageState& stage, Real time, const Vec<D>& x)
{
  Vec<D> sum = Vec<D>::Zero(), one;
  for (const BodyForce<D>& load : problem.loads.of_place) {
    load.acceleration(std::span(&x, 1), time, std::span(&one, 1));
    sum += one;
  }
  return stage.ramp(time) * density_of_water(problem) * sum;
}

/// The same in the middle of each cell; empty where a scene has no such forces.
template <int D>
std::vector<Vec<D>> forces_on_water(const Problem<D>& problem, const StageState& stage, Real time)
{
  std::vector<Vec<D>> forces;
  if (problem.loads.of_place.empty())
    return forces;
  forces.resize(static_cast<std::size_t>(problem.mesh.n_cells()));
  parallel_for(problem.mesh.n_cells(), [&](Index c) {
    Vec<D> middle = Vec<D>::Zero();
    for (const Index n : problem.mesh.cell(c))
      middle += problem.mesh.node(n) / (D + 1);
    forces[static_cast<std::size_t>(c)] = force_on_water(problem, stage, time, middle);
  });
  return forces;
}

/// Darcy's velocity [m/s] at a particle: the volume of water per area and time, relative to the grains.  Zero where none flows.
template <int D>
Vec<D> seepage_velocity(const Problem<D>& problem, const State<D>& state, std::size_t p)
{
  const Particles<D>& particles = state.particles;
  const FlowOfBody* pores = problem.flow.pores_of(body_of(state.bodies, static_cast<Index>(p)));
  if (pores == nullptr || !state.flow.begun)
    return Vec<D>::Zero();
  const Real porosity = pores->porosity_at(particles.F[p].determinant());
  const Real mobility = pores->permeability_at(porosity) * pores->retention.conductance(particles.water[p]) / problem.flow.unit_weight;
  const Real now = state.clock.time;
  const Vec<D> weight = weight_of_water(problem, state.stage, now) + force_on_water(problem, state.stage, now, particles.x[p]);
  return mobility * (weight - particles.water_gradient[p]);
}

}  // namespace talus
