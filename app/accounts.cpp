#include "app/accounts.hpp"

#include <algorithm>

namespace talus {

Real EnergyNow::largest_term() const noexcept
{
  Real largest = 0;
  for (const Real term : {kinetic_start, kinetic, strain, plastic, friction, damping, gravity, loads, walls})
    largest = std::max(largest, std::abs(term));
  return largest;
}

namespace {

/// Force of gravity and of all tractions in the last step [N].
template <int D>
Vec<D> outer_force(const Frame<D>& frame)
{
  const Real time = frame.clock.time, ramp = frame.stage.ramp(time);
  Vec<D> force = (frame.mass.start - frame.mass.deleted) * frame.loads.gravity(time, ramp);
  for (std::size_t p = 0; p < frame.particles.applied.size(); ++p)
    force += frame.particles.applied[p];
  for (const auto& load : frame.loads.on_mesh)
    for (std::size_t k = 0; k < load.node.size(); ++k)
      if (frame.nodes.sum[static_cast<std::size_t>(load.node[k])].mass > 0)
        force += ramp * load.table(time) * (load.measure[k] * load.traction - load.pressure * load.area[k]);
  return force;
}

}  // namespace

template <int D>
void Accounts<D>::see(const Frame<D>& frame, Moment moment)
{
  if (moment == Moment::stage_begins) {
    if (!begun_) {
      const Totals<D> now = totals(frame.particles);
      kinetic_begin_ = now.kinetic;
      plastic_begin_ = frame.energy.plastic_start;
      momentum_start_ = now.momentum;
      for (std::size_t p = 0; p < frame.particles.id.size(); ++p)
        momentum_at_start_ += frame.particles.mass[p] * frame.particles.v[p].norm();
    } else {
      before_.gravity += stage_.gravity, before_.loads += stage_.loads, before_.walls += stage_.walls;
      before_.friction += stage_.friction, before_.damping += stage_.damping, before_.internal += stage_.internal;
      transfer_before_ += stage_.transfer(kinetic_end_);
      taken_out_before_ += taken_out_;
    }
    begun_ = true;
    taken_out_ = 0;
    damped_ = damped_ || frame.stage.damping > 0;
  }
  if (moment == Moment::step_done && !damped_) {
    const Vec<D> impulse = frame.clock.dt * outer_force(frame);
    loads_impulse_ += impulse;
    loads_impulse_size_ += impulse.norm();
  }
  if (moment == Moment::stage_done) {
    taken_out_ = frame.energy.set_to_rest;
    kinetic_end_ = totals(frame.particles).kinetic + taken_out_;
  }
  stage_ = frame.energy;
}

template <int D>
EnergyNow Accounts<D>::energy(const Frame<D>& frame) const
{
  const EnergyLedger& e = frame.energy;
  EnergyNow now;
  now.kinetic_start = kinetic_begin_;
  now.kinetic = totals(frame.particles).kinetic;
  now.plastic = plastic_work(frame) - plastic_begin_;
  now.strain = before_.internal + e.internal - now.plastic;
  now.friction = 0 - before_.friction - e.friction;  // 0 - 0 is not -0
  now.damping = taken_out_before_ + taken_out_ - before_.damping - e.damping;
  now.gravity = before_.gravity + e.gravity;
  now.loads = before_.loads + e.loads;
  now.walls = before_.walls + e.walls;
  now.transfer = transfer_before_ + e.transfer(now.kinetic + taken_out_);
  now.defect = now.gravity + now.loads + now.walls - (now.kinetic - now.kinetic_start) - now.strain - now.plastic - now.friction -
               now.damping - now.transfer;
  return now;
}

template <int D>
Vec<D> Accounts<D>::impulse(const Frame<D>& frame) const
{
  Vec<D> total = loads_impulse_;
  for (const Wall<D>& wall : frame.walls.walls())
    total += wall.impulse;
  return total;
}

template <int D>
Real Accounts<D>::momentum_scale(const Frame<D>& frame) const
{
  Real scale = momentum_at_start_ + loads_impulse_size_;
  for (const Wall<D>& wall : frame.walls.walls())
    scale += wall.impulse.norm();
  return scale;
}

template class Accounts<2>;
template class Accounts<3>;

}  // namespace talus
