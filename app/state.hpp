#pragma once
// The state of a run between two steps: all that the steps to come depend on and that set-up does not find again in the scene.
#include "app/frame.hpp"
#include "solver/deal.hpp"

namespace talus {

/// To be changed.  Names are those of a Frame.
template <int D>
struct State {
  Particles<D>& particles;
  std::vector<Body>& bodies;
  std::vector<AnyBatch>& materials;
  Walls<D>& walls;
  Clock& clock;
  StageState& stage;
  EnergyLedger& energy;
  MassLedger<D>& mass;
  MomentumLedger<D>& momentum;
  Watched& watched;
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
    take_own_particles(*m.ranks, m.share, m.bodies, m.materials, m.particles);
  sort_by_cell(m.particles.cell, m.particles.id, m.bodies, m.mesh.n_cells(), m.order);
  follow_rows(m);
}

}  // namespace talus
