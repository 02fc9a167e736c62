#pragma once
// The pore pressures of particles at the end of a step.
#include "solver/model/model.hpp"
#include "solver/transfer/strip_scratch.hpp"

namespace talus {

/// Pore pressures of the particles of a strip of a body after a step of length dt [s]; nothing where the law of the body uses total stress.
/// Those of flowing water are where the particles were at the beginning of the step, as nodes move with them; in stages in which it does not
/// flow they stay what they are, once it has, and so do those of particles that have just come to a cell whose nodes have not seen water yet.
template <int D>
StripColumn<Real> find_pore_pressures(const Model<D>& m, Index body, const StripColumns<D>& columns, Real dt,
                                      StripScratch<D>& scratch) noexcept
{
  const auto water = pore_water(m, body, m.state.clock.time + dt);
  if (!water)
    return {};
  const Mesh<D>& mesh = m.problem.mesh;
  const bool flows = m.problem.flow.flows(body), moves = flows && m.state.stage.flows, stays = flows && m.state.flow.begun && !moves;
  for (const CellRun<D>& run : scratch.runs) {
    const Index cell = run.frame->cell;
    const bool known = moves && m.work.flow->knows(mesh, cell);
    const Vec<D> gradient = known ? m.work.flow->gradient(mesh, cell) : Vec<D>(Vec<D>::Zero());
    for (std::size_t i = run.begin; i < run.end; ++i) {
      Real& after = scratch.pore_after[i];
      const Vec<D> x = moves ? columns.before.of(i) : columns.x.of(i);
      const Real at_rest = water->pressure(mesh, cell, x);
      if (columns.water)  // an output of bodies through which no water flows, too
        columns.water_at_rest.set(i, at_rest);
      if (known) {
        const Real p = m.work.flow->at(mesh, cell, x);
        columns.water.set(i, p), columns.water_gradient.set(i, gradient);
        after = m.problem.flow.stress_of(body, p);
      } else if (moves || stays) {
        after = columns.pore.of(i);
      } else {
        after = m.problem.flow.stress_of(body, at_rest);
        if (columns.water)
          columns.water.set(i, at_rest), columns.water_gradient.set(i, water->gradient(mesh, cell, x));
      }
    }
  }
  return {scratch.pore_after, 0};
}

}  // namespace talus
