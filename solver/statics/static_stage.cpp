#include "solver/statics/static_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/statics/load_increment.hpp"

namespace talus {

/// Takes away the stress of particles and empty cells against jumps of gradients.
template <int D>
void drop_jump_stress(Model<D>& m)
{
  end_sweeps(m);
  ParticleColumn<Mat<D>>& column = m.state.particles.jump_stress;
  column.assign(column.size(), Mat<D>::Zero());
  m.state.empty_cells.clear();
}

/// An increment is easy where Newton's method takes at most so many iterations; the next one is longer by this factor.
constexpr int easy_iterations = 6;
constexpr Real growth = 1.5;
/// Particles that have moved to other cells in an increment change the forces against jumps there, which the next increment balances.  For
/// the last one, short increments do that: over this share of an increment, each over half of what is left of it, until no more than this
/// share of the loads is out of balance where the next one begins, or until the shortest one.
constexpr Real closing_share = 1.0 / 8192, balanced = 1e-3, shortest_share = closing_share / 256;

template <int D>
std::optional<std::string> make_increment(Model<D>& m, const EquilibriumOptions& options, Real full, Real left)
{
  const bool keeps = options.keeps_jump_stress && m.problem.columns.jump_stress;
  const Real closing = keeps ? closing_share * full : 0;
  const bool closes = keeps && left <= 1.01 * closing;  // what is left is a difference of times
  const Real ahead = closes ? left : left - closing;
  const Real wanted = m.state.solve.increment > 0 ? std::min(m.state.solve.increment, full) : full;
  Real dt = ahead <= wanted * (1 + 1e-12) ? ahead : ahead < 2 * wanted ? ahead / 2 : wanted;  // no sliver at the end
  if (!options.keeps_jump_stress)
    drop_jump_stress(m);
  if (closes && left > shortest_share * full)
    if (LoadIncrement<D> all(m, left, true); all.is_sound() && all.imbalance_at_start().value_or(0) > balanced)
      dt = left / 2;
  for (int cuts = 0;; ++cuts) {
    LoadIncrement<D> increment(m, dt, options.keeps_jump_stress);
    if (!increment.is_sound())
      return std::nullopt;
    const std::optional<std::string> why = increment.solve(*m.problem.equations, options);
    SolveLedger& solve = m.state.solve;
    if (why && closes)
      increment.skip();  // the stage says what is out of balance
    if (!why || closes) {
      ++solve.increments;
      solve.cuts += cuts;
      if (closes)
        return std::nullopt;
      solve.increment = std::max(dt, cuts > 0 ? dt : wanted);
      if (cuts == 0 && solve.last_iterations <= easy_iterations)
        solve.increment = std::min(full, growth * solve.increment);
      return std::nullopt;
    }
    if (dt <= full * std::ldexp(1, -options.most_cuts))
      return fmt::format("there is no equilibrium at {:.6g} of the stage, or it was not found: {}",
                         (m.state.clock.time + dt - m.state.stage.begin) / (m.state.clock.time + left - m.state.stage.begin), *why);
    dt /= 2;
  }
}

template std::optional<std::string> make_increment(Model<2>&, const EquilibriumOptions&, Real, Real);
template std::optional<std::string> make_increment(Model<3>&, const EquilibriumOptions&, Real, Real);

}  // namespace talus
