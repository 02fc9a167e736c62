#pragma once
// How fast water flows through pores.
#include "solver/model/problem.hpp"
#include "solver/model/state.hpp"

namespace talus {

/// The weight of water [N/m^3] at a time [s], as gravity acts then.
template <int D>
Vec<D> weight_of_water(const Problem<D>& problem, const StageState& stage, Real time)
{
  const Gravity<D>& gravity = problem.loads.gravity;
  const Real full = gravity.acceleration.norm();
  return full > 0 ? Vec<D>(problem.flow.unit_weight / full * gravity(time, stage.ramp(time))) : Vec<D>(Vec<D>::Zero());
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
  return mobility * (weight_of_water(problem, state.stage, state.clock.time) - particles.water_gradient[p]);
}

}  // namespace talus
