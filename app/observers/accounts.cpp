#include "app/observers/accounts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace talus {

Real EnergyNow::largest_term() const noexcept
{
  Real largest = 0;
  for (const Real term :
       {kinetic_start, kinetic, strain, plastic, friction, damping, carried_away, resampled, gravity, loads, walls, waves, size})
    largest = std::max(largest, std::abs(term));
  return largest;
}

namespace {

/// The momentum of the particles; the absolute values are summed over particles.
template <int D>
ForceAndMoment<D> momentum_of(const RunView<D>& view)
{
  return sum_particles<ForceAndMoment<D>>(view, [](const auto& p) { return ForceAndMoment<D>::at(p.x(), p.mass() * p.v()); });
}

}  // namespace

template <int D>
Real MomentumNow<D>::linear_defect() const noexcept
{
  return share((end.linear - start.linear - given.linear).norm(), start.size + given.size);
}

template <int D>
Real MomentumNow<D>::angular_defect() const noexcept
{
  return share(forces.norm(), start.turn + given.turn);
}

template <int D>
Real MomentumNow<D>::angular_loss() const noexcept
{
  return share(lost.norm(), start.turn + given.turn);
}

template <int D>
void BalanceHistory<D>::see(const RunView<D>& view, RunEvent event)
{
  if (event == RunEvent::stage_begins) {
    if (!begun_) {
      kinetic_begin_ = totals(view).kinetic;
      plastic_begin_ = view.state.energy.plastic_start;
      start_ = momentum_of(view);
    } else {
      before_.gravity += stage_.gravity, before_.loads += stage_.loads, before_.walls += stage_.walls;
      before_.waves += stage_.waves;
      before_.friction += stage_.friction, before_.damping += stage_.damping, before_.internal += stage_.internal;
      before_.carried_away += stage_.carried_away, before_.resampled += stage_.resampled;
      before_.plastic_deleted += stage_.plastic_deleted;
      transfer_before_ += stage_.transfer(kinetic_end_);
      taken_out_before_ += taken_out_;
      // The difference between the end of one stage and the beginning of the next is due to bodies that appeared or vanished.
      const Real came = view.state.energy.kinetic_start - (kinetic_end_ - taken_out_);
      (came > 0 ? kinetic_begin_ : before_.carried_away) += std::abs(came);
      before_.plastic_deleted += plastic_end_ - view.state.energy.plastic_start;
    }
    begun_ = true;
    taken_out_ = 0;
  }
  if (event == RunEvent::stage_done) {
    taken_out_ = view.state.energy.set_to_rest;
    kinetic_end_ = totals(view).kinetic + taken_out_;
    plastic_end_ = plastic_work(view);
  }
  stage_ = view.state.energy.at_velocities();
}

template <int D>
EnergyNow BalanceHistory<D>::energy(const RunView<D>& view) const
{
  const EnergyLedger e = view.state.energy.at_velocities();
  EnergyNow now;
  now.kinetic_start = kinetic_begin_;
  now.kinetic = totals(view).kinetic;
  now.plastic = plastic_work(view) - plastic_begin_ + before_.plastic_deleted + e.plastic_deleted;
  now.strain = before_.internal + e.internal - now.plastic;
  now.friction = 0 - before_.friction - e.friction;  // avoids -0
  now.damping = taken_out_before_ + taken_out_ - before_.damping - e.damping;
  now.carried_away = before_.carried_away + e.carried_away;
  now.resampled = before_.resampled + e.resampled;
  now.gravity = before_.gravity + e.gravity;
  now.loads = before_.loads + e.loads;
  now.walls = before_.walls + e.walls;
  now.waves = before_.waves + e.waves;
  now.size = e.largest_seen;
  now.transfer = transfer_before_ + e.transfer(now.kinetic + taken_out_);
  now.defect = now.gravity + now.loads + now.walls - (now.kinetic - now.kinetic_start) - now.strain - now.plastic - now.friction -
               now.damping - now.carried_away - now.resampled - now.transfer;
  return now;
}

template <int D>
MomentumNow<D> BalanceHistory<D>::momentum(const RunView<D>& view) const
{
  const MomentumLedger<D>& given = view.state.momentum;
  ForceAndMoment<D> in_steps = given.loads + given.damping;
  for (const BoundaryCondition<D>& wall : view.state.boundary.conditions())
    in_steps += ForceAndMoment<D>::of(wall.impulse, wall.angular);
  for (const RigidState<D>& rigid : view.state.rigid)
    in_steps += ForceAndMoment<D>::of(rigid.done.impulse, rigid.done.angular);
  MomentumNow<D> now{start_, momentum_of(view), in_steps + given.rest + given.changes + -1 * view.state.mass.carried_away};
  now.forces = given.on_nodes - in_steps.angular;
  now.lost = now.start.angular + now.given.angular + now.forces - now.end.angular;
  return now;
}

template struct MomentumNow<2>;
template struct MomentumNow<3>;
template class BalanceHistory<2>;
template class BalanceHistory<3>;

namespace {

Real term(const EnergyAudit& energy, std::string_view name)
{
  const auto found = std::find_if(energy.terms.begin(), energy.terms.end(), [&](const NamedValue& value) { return value.name == name; });
  return found == energy.terms.end() ? 0 : found->value;
}

Real largest_term(const EnergyAudit& energy)
{
  Real largest = 0;
  for (const char* name : {"gravity_work", "load_work", "wall_work", "kinetic_start", "kinetic", "strain", "plastic", "friction"})
    largest = std::max(largest, std::abs(term(energy, name)));
  return largest;
}

/// The transfer loss, judged only if the plastic work is not small compared with the largest energy term.
std::string transfer_loss(const EnergyAudit& energy)
{
  constexpr Real matters = 0.01;  // relative to the largest term
  const Real largest = largest_term(energy);
  const Real lost = term(energy, "transfer_loss"), plastic = term(energy, "plastic");
  if (!(plastic > matters * largest) || !(lost > most_transfer_loss * plastic))
    return {};
  return fmt::format(
      "particles and nodes lost {:.3g} J between them (transfer_loss), {:.3g} of the plastic work, more than {:.2g} of it: the mesh "
      "resists "
      "the motion as a part of the material would; compare with cells half as large",
      lost, lost / plastic, most_transfer_loss);
}

}  // namespace

std::vector<std::string> failed_accounts(const RunSummary& summary, Real least_energy)
{
  std::vector<std::string> failed;
  const auto judge = [&](std::string_view what, const auto& audit) {
    if (audit && !audit->closure.closes())
      failed.push_back(fmt::format("the balance of {} does not close: {:.2g} of the {} is not accounted for, more than {:.2g}", what,
                                   audit->closure.relative, audit->closure.relative_to, audit->closure.limit));
  };
  judge("mass", summary.mass);
  judge("momentum", summary.momentum);
  judge("angular momentum", summary.angular_momentum);
  if (summary.angular_momentum && summary.angular_momentum->transfer_share > most_angular_loss)
    failed.push_back(
        fmt::format("particles and nodes lost {:.3g} of the angular momentum between them (transfer_loss), more than {:.2g}: bodies "
                    "turn as the mesh allows; compare with cells half as large",
                    summary.angular_momentum->transfer_share, most_angular_loss));
  judge("energy", summary.energy);
  if (!summary.energy || largest_term(*summary.energy) < least_energy)
    return failed;
  if (const std::string what = transfer_loss(*summary.energy); !what.empty())
    failed.push_back(what);
  return failed;
}

}  // namespace talus
