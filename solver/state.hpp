#pragma once
// The state of a run between two steps: all that the steps to come depend on and that set-up does not find again in the scene.
#include "solver/particles/redistribute.hpp"
#include "solver/run_view.hpp"

namespace talus {

/// To be changed.  Names are those of a Frame.
template <int D>
struct State {
  Particles<D>& particles;
  std::vector<Body>& bodies;
  std::vector<AnyBatch>& materials;
  BoundaryConditions<D>& walls;
  Clock& clock;
  StageState& stage;
  EnergyLedger& energy;
  MassLedger<D>& mass;
  MomentumLedger<D>& momentum;
  LimitMonitor& watched;
  Timings& timings;
  Real &residual, &crossing;
};

template <int D, Kernel<D> K>
State<D> state_of(Model<D, K>& m)
{
  return {m.particles, m.bodies,   m.materials, m.walls,   m.clock,    m.stage,   m.energy,
          m.mass,      m.momentum, m.watched,   m.timings, m.residual, m.crossing};
}

/// f(name, part) for each; S is a State or a Frame.
template <class S, class F>
void for_each_part(const S& state, F&& f)
{
  f("clock", state.clock), f("stage", state.stage), f("energy", state.energy), f("mass", state.mass);
  f("momentum", state.momentum), f("watched", state.watched), f("timings", state.timings);
  f("residual", state.residual), f("crossing", state.crossing), f("walls", state.walls), f("bodies", state.bodies);
  f("particles", state.particles);
}

/// Puts a model together again after its state has been replaced: what follows from the state, and what is sized by it.  Where ranks share the
/// run each has some of the particles, in cells of the whole mesh: they go to the ranks whose cells these are.
template <int D, Kernel<D> K>
void adopt_state(Model<D, K>& m)
{
  if (!m.share.alone())
    receive_owned_particles(*m.ranks, m.share, m.bodies, m.materials, m.particles);
  take_rows(m);
}

/// A state by itself, between two models.
template <int D>
struct LooseState {
  Particles<D> particles;
  std::vector<Body> bodies;
  std::vector<AnyBatch> materials;
  BoundaryConditions<D> walls;
  Clock clock;
  StageState stage;
  EnergyLedger energy;
  MassLedger<D> mass;
  MomentumLedger<D> momentum;
  LimitMonitor watched;
  Timings timings;
  Real residual = 0, crossing = 0;
};

/// Taken out of a model that is not needed any more.
template <int D>
LooseState<D> take_out(const State<D>& state)
{
  const auto& [particles, bodies, materials, walls, clock, stage, energy, mass, momentum, watched, timings, residual, crossing] = state;
  return {std::move(particles),
          std::move(bodies),
          std::move(materials),
          std::move(walls),
          clock,
          stage,
          energy,
          mass,
          momentum,
          std::move(watched),
          timings,
          residual,
          crossing};
}

/// Put into another model of the same scene.
template <int D>
void put_into(const State<D>& state, LooseState<D> loose)
{
  const auto& [particles, bodies, materials, walls, clock, stage, energy, mass, momentum, watched, timings, residual, crossing] = state;
  particles = std::move(loose.particles), bodies = std::move(loose.bodies), materials = std::move(loose.materials);
  walls.continue_from(loose.walls);
  clock = loose.clock, stage = loose.stage, energy = loose.energy, mass = loose.mass, momentum = loose.momentum;
  watched = std::move(loose.watched), timings = loose.timings, residual = loose.residual, crossing = loose.crossing;
}

}  // namespace talus
