#include "solver/rigid/rigid_body.hpp"

#include <Eigen/Geometry>

#include "solver/state/integrate.hpp"

namespace talus {

template <int D>
void begin_step(const RigidScene<D>& scene, const Vec<D>& gravity, Real kick, Real mid, std::vector<RigidState<D>>& states)
{
  for (std::size_t r = 0; r < states.size(); ++r) {
    RigidState<D>& state = states[r];
    if (const auto& motion = scene.bodies[r].motion) {
      const Real factor = motion->table(mid);
      state.v = factor * motion->velocity, state.spin = factor * motion->spin;
    } else {
      state.v += kick * gravity;
    }
  }
}

template <int D>
void damp(const RigidScene<D>& scene, Real damping, const std::vector<RigidState<D>>& before, std::vector<RigidState<D>>& states)
{
  for (std::size_t r = 0; r < states.size(); ++r) {
    if (!scene.bodies[r].is_free())
      continue;
    states[r].v += damping_of<D>(states[r].v - before[r].v, before[r].v, damping);
    states[r].spin += damping_of<3>(states[r].spin - before[r].spin, before[r].spin, damping);
  }
}

namespace {

/// A rotation followed by one with an angular velocity [rad/s] over a time [s].
Mat3 turned(const Mat3& turn, const Vec3& spin, Real time)
{
  const Real rate = spin.norm();
  if (rate == 0)
    return turn;
  const Eigen::AngleAxis<Real> by(rate * time, Eigen::Matrix<Real, 3, 1>(spin / rate));
  return Eigen::Quaternion<Real>(Eigen::Matrix<Real, 3, 3>(by.toRotationMatrix() * turn)).normalized().toRotationMatrix();
}

}  // namespace

template <int D>
void move(const RigidScene<D>& scene, Real dt, std::vector<RigidState<D>>& states)
{
  for (std::size_t r = 0; r < states.size(); ++r) {
    RigidState<D>& state = states[r];
    const RigidBody<D>& body = scene.bodies[r];
    state.x += dt * state.v;
    if (D == 2 || !body.is_free()) {
      state.turn = turned(state.turn, state.spin, dt);
      continue;
    }
    const Vec3 angular_momentum = state.inertia(body) * state.spin;
    RigidState<D> middle = state;
    middle.turn = turned(state.turn, state.spin, dt / 2);
    state.turn = turned(state.turn, middle.inertia(body).inverse() * angular_momentum, dt);
    state.spin = state.inertia(body).inverse() * angular_momentum;
  }
}

template <int D>
Real fastest(const RigidScene<D>& scene, const std::vector<RigidState<D>>& states)
{
  Real most = 0;
  for (std::size_t r = 0; r < states.size(); ++r)
    most = std::max(most, states[r].v.norm() + states[r].spin.norm() * scene.bodies[r].shape->radius());
  return most;
}

#define TALUS_INSTANTIATE(D)                                                                                      \
  template void begin_step(const RigidScene<D>&, const Vec<D>&, Real, Real, std::vector<RigidState<D>>&);         \
  template void damp(const RigidScene<D>&, Real, const std::vector<RigidState<D>>&, std::vector<RigidState<D>>&); \
  template void move(const RigidScene<D>&, Real, std::vector<RigidState<D>>&);                                    \
  template Real fastest(const RigidScene<D>&, const std::vector<RigidState<D>>&);
TALUS_INSTANTIATE(2)
TALUS_INSTANTIATE(3)
#undef TALUS_INSTANTIATE

}  // namespace talus
