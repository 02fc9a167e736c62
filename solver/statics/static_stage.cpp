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
Real time_of_short_increments(const Model<D>& m, const EquilibriumOptions& options, Real full)
{
  const auto is_of_rates = [](const Material& material) { return material.viscosity || material.law().description().is_fluid; };
  const bool has_jumps = options.keeps_jump_stress && m.problem.columns.jump_stress;
  return has_jumps && std::ranges::none_of(m.state.materials, is_of_rates) ? closing_share * full : 0;
}

/// A short increment at the end, of which `left` [s] are left.  One that is not solved moves nothing; the stage says what is out of balance.
template <int D>
std::optional<std::string> make_short_increment(Model<D>& m, const EquilibriumOptions& options, Real full, Real left)
{
  Real dt = left;
  if (left > shortest_share * full)
    if (LoadIncrement<D> all(m, left, true); all.is_sound() && all.imbalance_at_start().value_or(0) > balanced)
      dt = left / 2;
  std::optional<std::string> why;
  {
    LoadIncrement<D> increment(m, dt, true);
    if (!increment.is_sound())
      return std::nullopt;
    why = increment.solve(*m.problem.equations, options);
    if (!why)
      ++m.state.solve.increments;
    if (!why || !increment.is_without_solution())
      return why;
  }
  LoadIncrement<D> rest(m, left, true);
  if (!rest.is_sound())
    return std::nullopt;
  if (!rest.imbalance_at_start())
    return why;
  rest.skip();
  return std::nullopt;
}

template <int D>
std::optional<std::string> make_increment(Model<D>& m, const EquilibriumOptions& options, Real full, Real left)
{
  const Real closing = time_of_short_increments(m, options, full);
  if (left <= 1.01 * closing)  // what is left is a difference of times
    return make_short_increment(m, options, full, left);
  const Real wanted = m.state.solve.increment > 0 ? std::min(m.state.solve.increment, full) : full;
  Real dt = left <= wanted * (1 + 1e-12) ? left - closing : left < 2 * wanted ? left / 2 : wanted;  // no sliver at the end
  if (!options.keeps_jump_stress)
    drop_jump_stress(m);
  for (int cuts = 0;; ++cuts) {
    LoadIncrement<D> increment(m, dt, options.keeps_jump_stress);
    if (!increment.is_sound())
      return std::nullopt;
    const std::optional<std::string> why = increment.solve(*m.problem.equations, options);
    SolveLedger& solve = m.state.solve;
    if (!why) {
      ++solve.increments;
      solve.cuts += cuts;
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

template Real time_of_short_increments(const Model<2>&, const EquilibriumOptions&, Real);
template Real time_of_short_increments(const Model<3>&, const EquilibriumOptions&, Real);
template std::optional<std::string> make_increment(Model<2>&, const EquilibriumOptions&, Real, Real);
template std::optional<std::string> make_increment(Model<3>&, const EquilibriumOptions&, Real, Real);

}  // namespace talus
