#include "solver/statics/static_stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "solver/statics/load_increment.hpp"

namespace talus {

/// Takes away the stress of the particles against jumps of gradients.
template <int D>
void drop_jump_stress(Model<D>& m)
{
  end_sweeps(m);
  ParticleColumn<Mat<D>>& column = m.state.particles.jump_stress;
  column.assign(column.size(), Mat<D>::Zero());
}

/// An increment is easy where Newton's method takes at most so many iterations; the next one is longer by this factor.
constexpr int easy_iterations = 6;
constexpr Real growth = 1.5;

template <int D>
std::optional<std::string> make_increment(Model<D>& m, const EquilibriumOptions& options, Real full, Real left)
{
  const Real wanted = m.state.solve.increment > 0 ? std::min(m.state.solve.increment, full) : full;
  Real dt = left <= wanted * (1 + 1e-12) ? left : left < 2 * wanted ? left / 2 : wanted;  // no sliver at the end
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

template std::optional<std::string> make_increment(Model<2>&, const EquilibriumOptions&, Real, Real);
template std::optional<std::string> make_increment(Model<3>&, const EquilibriumOptions&, Real, Real);

}  // namespace talus
