#include "app/observers/body_forces.hpp"

namespace talus {

namespace {

template <int D>
BodySums<D> sums_of_body(const RunView<D>& view, Index body)
{
  ExactSums<BodySums<D>> sum;
  add_particles(view, {body, body + 1}, sum, [](const auto& p) {
    return BodySums<D>{p.mass(), 0.5 * p.mass() * p.v().squaredNorm(), p.mass() * p.v(), p.load()};
  });
  view.problem.ranks->sum(sum);
  return sum.value();
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
  const Vec<D> gravity = view.nodes.gravity;
  const Real kick = view.nodes.kick;
  const auto lost = [&](std::size_t b) { return now[b].mass != sums_[b].mass; };
  std::size_t losers = 0;
  for (std::size_t b = 0; b < now.size(); ++b)
    losers += lost(b) ? 1 : 0;
  const Real failed = view.state.mass.failed - failed_;  // they took part in the step in which they failed, with their loads
  // Those that have left the mesh did not: their loads are not known any more.
  constexpr Real rounding = 1e-9;
  const auto left = [&](std::size_t b) { return sums_[b].mass - now[b].mass - failed > rounding * sums_[b].mass; };
  for (std::size_t b = 0; b < now.size(); ++b) {
    BodyImpulse<D>& impulse = impulses_[b];
    if (lost(b) && (losers > 1 || (left(b) && view.problem.columns.applied))) {
      ++impulse.unknown;
      continue;
    }
    const Vec<D> deleted = lost(b) ? Vec<D>(view.state.mass.carried_away.linear - deleted_) : Vec<D>(Vec<D>::Zero());
    const Real mass = now[b].mass + (lost(b) ? failed : 0);
    impulse.given += now[b].momentum - sums_[b].momentum + deleted - kick * (mass * gravity + sums_[b].load);
  }
}

template class BodyForces<2>;
template class BodyForces<3>;

}  // namespace talus
