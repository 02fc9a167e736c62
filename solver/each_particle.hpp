#pragma once
// Loops over the particles of a run for observers, in columns or in strips: what is read often needs no copy into columns.
#include "solver/run_view.hpp"

namespace talus {

/// The pressure of flowing water at a particle [Pa], and what it would be below the water table of the scene.
struct WaterAt {
  Real pressure, at_rest;
};

/// A particle in columns.
template <int D>
struct ColumnParticle {
  const Particles<D>& all;
  std::size_t p;
  const Real* of_law;

  std::int64_t id() const noexcept { return all.id[p]; }
  Real mass() const noexcept { return all.mass[p]; }                               ///< [kg]
  Real volume0() const noexcept { return all.volume0[p]; }                         ///< at the start [m^D]
  Vec<D> x() const noexcept { return all.x[p]; }                                   ///< [m]
  Vec<D> displacement() const noexcept { return all.x[p] - all.x0[p]; }            ///< [m]; with start positions only
  Vec<D> v() const noexcept { return all.v[p]; }                                   ///< [m/s]
  Sym3 stress() const noexcept { return all.stress[p]; }                           ///< [Pa]
  WaterAt water() const noexcept { return {all.water[p], all.water_at_rest[p]}; }  ///< where water flows only
  Real history(int number) const noexcept { return of_law[number]; }
};

/// The same in a strip.
template <int D>
struct StripParticle {
  const StripColumns<D>& all;
  std::size_t p;
  const StripColumn<Real>& of_law;

  std::int64_t id() const noexcept { return all.id[p]; }
  Real mass() const noexcept { return all.mass.of(p); }
  Real volume0() const noexcept { return all.volume0.of(p); }
  Vec<D> x() const noexcept { return all.x.of(p); }
  Vec<D> displacement() const noexcept { return all.x.of(p) - all.x0.of(p); }
  Vec<D> v() const noexcept { return all.v.of(p); }
  Sym3 stress() const noexcept { return all.stress.of(p); }
  WaterAt water() const noexcept { return {all.water.of(p), all.water_at_rest.of(p)}; }
  Real history(int number) const noexcept { return of_law.component(number)[p]; }
};

/// Calls f(particle) for the particles of a body in a block of cells, in the order of cells and ids; `key` is CellOrder::key().
template <int D, class F>
void for_each_particle(const RunView<D>& view, std::size_t key, F&& f)
{
  if (view.strips != nullptr) {
    const auto blocks = static_cast<std::size_t>(view.order.blocks);
    view.strips->for_each_key_of(static_cast<Index>(key / blocks), static_cast<Index>(key % blocks), [&](std::size_t of_side) {
      for (const Strip& strip : view.strips->strips(of_side)) {
        const StripColumns<D> columns = view.strips->columns(strip);
        const StripColumn<Real> history = view.strips->history(strip);
        for (Index i = 0; i < strip.n; ++i)
          f(StripParticle<D>{columns, static_cast<std::size_t>(i), history});
      }
    });
    return;
  }
  const Material& material = view.state.materials[key / static_cast<std::size_t>(view.order.blocks)];
  for (const Index row : view.order.rows(key))
    f(ColumnParticle<D>{view.state.particles, static_cast<std::size_t>(row), material.history.row(row - material.begin)});
}

/// Calls f(particle) for the particles of a body, or of all where the name is empty.
template <int D, class F>
void for_each_particle_of(const RunView<D>& view, const std::string& body, F&& f)
{
  for (std::size_t b = 0; b < view.state.bodies.size(); ++b)
    for (Index block = 0; block < view.order.blocks; ++block)
      if (body.empty() || view.state.bodies[b].name == body)
        for_each_particle(view, view.order.key(static_cast<Index>(b), block), f);
}

/// Adds f(particle) for the particles of bodies [first, last) on this rank: bitwise identical for any number of threads and, once summed,
/// of ranks.
template <class T, int D, class F>
void add_particles(const RunView<D>& view, std::pair<Index, Index> bodies, ExactSums<T>& sum, F&& f)
{
  const std::size_t first = view.order.key(bodies.first, 0);
  add_parts((bodies.second - bodies.first) * view.order.blocks, sum, [&](Index k) {
    T part{};
    for_each_particle(view, first + static_cast<std::size_t>(k), [&](const auto& particle) { part += f(particle); });
    return part;
  });
}
/// The sum of f(particle) over the particles of all bodies and ranks.  Collective.
template <class T, int D, class F>
T sum_particles(const RunView<D>& view, F&& f)
{
  ExactSums<T> sum;
  add_particles(view, {0, static_cast<Index>(view.state.bodies.size())}, sum, f);
  view.problem.ranks->sum(sum);
  return sum.value();
}

/// Mass [kg], momentum [kg m/s] and energy [J] of the particles of all ranks.  Collective.
template <int D>
Totals<D> totals(const RunView<D>& view)
{
  Communicator& ranks = *view.problem.ranks;
  return view.strips != nullptr ? totals(*view.strips, ranks) : totals(view.state.particles, view.order, ranks);
}

/// Energy dissipated by the laws of bodies [first, last) so far, over all ranks [J].  Collective.
template <int D>
Real plastic_work(const RunView<D>& view, std::pair<Index, Index> bodies)
{
  ExactSums<Real> sum;
  for (Index body = bodies.first; body < bodies.second; ++body) {
    const ConstitutiveLaw& law = view.state.materials[static_cast<std::size_t>(body)].law();
    if (const auto work = law.description().scalar_variable("plastic_work"))
      add_particles(view, {body, body + 1}, sum, [&](const auto& p) { return p.volume0() * p.history(*work); });
  }
  view.problem.ranks->sum(sum);
  return sum.value();
}
template <int D>
Real plastic_work(const RunView<D>& view)
{
  return plastic_work(view, {0, static_cast<Index>(view.state.bodies.size())});
}

}  // namespace talus
