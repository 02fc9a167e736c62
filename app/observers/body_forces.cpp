#include "app/observers/body_forces.hpp"

#include <cmath>

namespace talus {

namespace {

template <int D>
BodySums<D> sums_of_body(const RunView<D>& view, Index body)
{
  ExactSums<BodySums<D>> sum;
  add_particles(view, {body, body + 1}, sum, [](const auto& p) {
    return BodySums<D>{p.mass(), 0.5 * p.mass() * p.v().squaredNorm(), p.mass() * p.v()};
  });
  view.problem.ranks->sum(sum);
  return sum.value();
}

/// The loads that acted on the particles and the surface of a body in the last step, without particles that left the mesh before it [N].
/// Collective.
template <int D>
Vec<D> loads_on_body(const RunView<D>& view, std::size_t body)
{
  if (view.loads.empty() && view.on_surfaces.empty())
    return Vec<D>::Zero();
  ExactSums<ForceAndMoment<D>> sum;
  for (Index block = 0; !view.loads.empty() && block < view.order.blocks; ++block)
    for (std::size_t key = view.order.key(static_cast<Index>(body), block); key < view.loads.size();
         key += view.order.key(static_cast<Index>(view.state.bodies.size()), 0))  // in front of sheets, then behind
      sum.add(view.loads[key].force);
  for (std::size_t k = 0; k < view.on_surfaces.size(); ++k)
    if (view.problem.loads.on_surfaces[k].body == static_cast<Index>(body))
      sum.add(view.on_surfaces[k]);
  view.problem.ranks->sum(sum);
  return sum.value().linear;
}

}  // namespace

template <int D>
void BodyForces<D>::see(const RunView<D>& view, RunEvent event)
{
  if (!wanted_ || event == RunEvent::step_begins || event == RunEvent::given_up)
    return;
  std::vector<BodySums<D>> now;
  for (std::size_t b = 0; b < view.state.bodies.size(); ++b)
    now.push_back(sums_of_body(view, static_cast<Index>(b)));
  impulses_.resize(now.size());
  if (event == RunEvent::step_done)
    add_step(view, now);
  sums_ = std::move(now);
  deleted_ = view.state.mass.carried_away.linear;
  failed_ = view.state.mass.failed;
}

template <int D>
void BodyForces<D>::add_step(const RunView<D>& view, const std::vector<BodySums<D>>& now)
{
  const Vec<D> gravity = view.fields.front().nodes.gravity;
  const Real kick = view.fields.front().nodes.kick;
  constexpr Real rounding = 1e-12;  // of the sum, whose order changes with the cells of particles
  const auto lost = [&](std::size_t b) { return std::abs(now[b].mass - sums_[b].mass) > rounding * sums_[b].mass; };
  std::size_t losers = 0;
  for (std::size_t b = 0; b < now.size(); ++b)
    losers += lost(b) ? 1 : 0;
  const Real failed = view.state.mass.failed - failed_;  // they took part in the step in which they failed
  for (std::size_t b = 0; b < now.size(); ++b) {
    BodyImpulse<D>& impulse = impulses_[b];
    const Vec<D> loads = loads_on_body(view, b);
    if (lost(b) && losers > 1) {
      ++impulse.unknown;
      continue;
    }
    const Vec<D> deleted = lost(b) ? Vec<D>(view.state.mass.carried_away.linear - deleted_) : Vec<D>(Vec<D>::Zero());
    const Real mass = now[b].mass + (lost(b) ? failed : 0);
    impulse.given += now[b].momentum - sums_[b].momentum + deleted - kick * (mass * gravity + loads);
  }
}

template class BodyForces<2>;
template class BodyForces<3>;

}  // namespace talus
