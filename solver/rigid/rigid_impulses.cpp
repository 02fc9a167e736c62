// Impulses between material and rigid bodies, and the motion of bodies that follows from them.
#include <Eigen/LU>

#include "solver/rigid/rigid_nodes.hpp"

namespace talus {

namespace {

/// Velocity of the centre, then angular velocity: three numbers in 2-D, six in 3-D.
template <int D>
inline constexpr int motions = D == 2 ? 3 : 6;
template <int D>
using Twist = Eigen::Matrix<Real, motions<D>, 1>;
template <int D>
using TwistSlope = Eigen::Matrix<Real, motions<D>, motions<D>>;

template <int D>
Twist<D> twist(const Vec<D>& linear, const Vec3& angular)
{
  Twist<D> all;
  all.template head<D>() = linear;
  if constexpr (D == 2)
    all[2] = angular[2];
  else
    all.template tail<3>() = angular;
  return all;
}
template <int D>
Vec3 angular_part(const Twist<D>& all)
{
  if constexpr (D == 2)
    return {0, 0, all[2]};
  else
    return all.template tail<3>();
}
/// The matrix that gives the velocity at an arm from the centre: its transpose gives force and moment.
template <int D>
Eigen::Matrix<Real, D, motions<D>> at_arm(const Vec<D>& arm)
{
  Eigen::Matrix<Real, D, motions<D>> all;
  all.template leftCols<D>().setIdentity();
  if constexpr (D == 2)
    all.col(2) << -arm[1], arm[0];
  else
    all.template rightCols<3>() << 0, arm[2], -arm[1], -arm[2], 0, arm[0], arm[1], -arm[0], 0;
  return all;
}
template <int D>
TwistSlope<D> inertia_of(const RigidBody<D>& body, const RigidState<D>& state)
{
  TwistSlope<D> all = TwistSlope<D>::Zero();
  all.template topLeftCorner<D, D>().diagonal().setConstant(body.mass);
  if constexpr (D == 2)
    all(2, 2) = body.inertia(2, 2);
  else
    all.template bottomRightCorner<3, 3>() = state.inertia(body);
  return all;
}

/// A mass at a node beside a rigid body.
template <int D>
struct Mass {
  Vec<D> v;                          ///< at the place of contact [m/s]
  Real along_normal, along_tangent;  ///< what resists an impulse [kg]; zero where a boundary condition holds it: nothing is exchanged there
};

/// The impulse on the material [N s] if the rigid body has velocity u at the place of contact, and its derivative by u.
template <int D>
struct Impulse {
  Vec<D> pressed = Vec<D>::Zero(), rubbed = Vec<D>::Zero();
  Mat<D> slope = Mat<D>::Zero();
  bool sticks = false;
};

template <int D>
Impulse<D> impulse_of(const Mass<D>& mass, const Vec<D>& normal, Real friction, const Vec<D>& u)
{
  Impulse<D> by;
  const Vec<D> relative = mass.v - u;
  const Real approach = -relative.dot(normal);
  if (!(approach > 0) || !(mass.along_normal > 0))
    return by;
  const Mat<D> outward = normal * normal.transpose(), across = Mat<D>::Identity() - outward;
  by.pressed = mass.along_normal * approach * normal;
  by.slope = mass.along_normal * outward;
  const Vec<D> sliding = relative + approach * normal;
  const Real speed = sliding.norm(), most = friction * mass.along_normal * approach, wanted = mass.along_tangent * speed;
  by.sticks = friction > 0 && wanted <= most;
  if (by.sticks) {
    by.rubbed = -mass.along_tangent * sliding;
    by.slope += mass.along_tangent * across;
  } else if (speed > 0 && most > 0) {
    const Vec<D> way = sliding / speed;
    by.rubbed = -most * way;
    by.slope += -friction * mass.along_normal * way * normal.transpose() + most / speed * (across - way * way.transpose());
  }
  return by;
}

/// What resists an impulse along a change of velocity `push` at a node; zero where a boundary condition holds it, which then no impulse moves.
template <int D>
Real resistance(const BoundaryConditions<D>& conditions, NodeOfField at, Real time, Real mass, const Vec<D>& v, const Vec<D>& push)
{
  if (!conditions.binds(at.node) || push.isZero(0))
    return mass;
  const Vec<D> change = conditions.held(at, time, v + push) - v;
  const Real admitted = change.dot(push) / push.squaredNorm();
  constexpr Real least = 1e-6;
  return admitted > least ? mass / admitted : 0;
}

/// Sums over the nodes that touch a body: impulse and moment on the material, and their derivative by the motion of the body.
template <int D>
struct Response {
  std::array<Real, motions<D>> impulse{};
  std::array<Real, motions<D> * motions<D>> slope{};
};

/// Newton's method takes some steps, as nodes begin to touch, to slide and to part.
constexpr int most_steps = 40;
constexpr Real tolerance = 1e-11;  ///< of the momentum that remains, relative to that exchanged

}  // namespace

template <int D>
void RigidNodes<D>::act(const Kick& kick, Communicator& ranks, const RigidScene<D>& scene, BoundaryConditions<D>& conditions,
                        std::span<RigidState<D>> states, std::span<VelocityField<D>> fields, ExactSums<BoundaryWork>& work)
{
  std::size_t begin = 0;
  for (std::size_t r = 0; r < n_bodies_; ++r) {
    std::size_t end = begin;
    while (end < nodes_.size() && nodes_[end].rigid == static_cast<Index>(r))
      ++end;
    const std::span<RigidNode<D>> touching = std::span(nodes_).subspan(begin, end - begin);
    begin = end;
    const RigidBody<D>& body = scene.bodies[r];
    RigidState<D>& state = states[r];
    std::vector<Mass<D>> masses;
    for (const RigidNode<D>& at : touching) {
      const Nodes<D>& nodes = fields[static_cast<std::size_t>(at.field)].nodes;
      const auto n = static_cast<std::size_t>(at.node);
      const Vec<D> v = nodes.motion[n].v, at_place = v - at.offset, relative = at_place - state.velocity_at(at.touch.place);
      const Vec<D> sliding = relative - relative.dot(at.touch.normal) * at.touch.normal;
      const auto along = [&](const Vec<D>& push) {
        return resistance(conditions, nodes.of_field(at.node), kick.to, nodes.sum[n].mass, v, push);
      };
      masses.push_back({at_place, along(at.touch.normal * std::max(relative.norm(), Real{1e-12})), along(-sliding)});
    }
    const auto by_node = [&](std::size_t k, const Twist<D>& q) {
      const Vec<D> arm = touching[k].touch.place - state.x;
      return impulse_of<D>(masses[k], touching[k].touch.normal, body.friction,
                           q.template head<D>() + turned_arm<D>(angular_part<D>(q), arm));
    };

    const Twist<D> before = twist<D>(state.v, state.spin);
    Twist<D> q = before, after = before;
    if (body.is_free()) {
      const TwistSlope<D> inertia = inertia_of(body, state), per_inertia = inertia.inverse();
      Twist<D> reaction = Twist<D>::Zero();
      TwistSlope<D> slope;
      const auto respond = [&](const Twist<D>& to) {
        ExactSums<Response<D>> sum;
        for (std::size_t k = 0; k < touching.size(); ++k) {
          const Impulse<D> by = by_node(k, to);
          if (by.pressed.isZero(0))
            continue;
          const auto arm = at_arm<D>(touching[k].touch.place - state.x);
          Response<D> one;
          Eigen::Map<Twist<D>>(one.impulse.data()) = arm.transpose() * (by.pressed + by.rubbed);
          Eigen::Map<TwistSlope<D>>(one.slope.data()) = arm.transpose() * by.slope * arm;
          sum.add(one);
        }
        ranks.sum(sum);
        const Response<D> all = sum.value();
        reaction = Eigen::Map<const Twist<D>>(all.impulse.data());
        slope = inertia + Eigen::Map<const TwistSlope<D>>(all.slope.data());
        return Twist<D>(inertia * (to - before) + reaction);
      };
      // In the norm of kinetic energy, in which motion and rotation can be compared.
      const auto size = [&](const Twist<D>& momentum) { return std::sqrt(std::abs(momentum.dot(per_inertia * momentum))); };
      Twist<D> left = respond(q);
      for (int step = 0; step < most_steps && size(left) > tolerance * size(reaction); ++step) {
        const Twist<D> change = -slope.partialPivLu().solve(left), from = q;
        const Real wrong = size(left);
        Real share = 1;
        for (int halving = 0; halving < 6; ++halving, share /= 2) {
          q = from + share * change;
          left = respond(q);
          if (size(left) < wrong)
            break;
        }
      }
      after = before - per_inertia * reaction;  // momentum is exact wherever the method has ended
      state.v = after.template head<D>(), state.spin = angular_part<D>(after);
    }
    for (std::size_t k = 0; k < touching.size(); ++k) {
      RigidNode<D>& at = touching[k];
      const Impulse<D> by = by_node(k, q);
      if (by.pressed.isZero(0))
        continue;
      at.pressed = by.pressed, at.rubbed = by.rubbed, at.sticks = by.sticks;
      at.u = at_arm<D>(at.touch.place - state.x) * (0.5 * (before + after));
      Nodes<D>& nodes = fields[static_cast<std::size_t>(at.field)].nodes;
      const auto n = static_cast<std::size_t>(at.node);
      const Vec<D> change = (by.pressed + by.rubbed) / nodes.sum[n].mass;
      nodes.motion[n].v += change, nodes.motion[n].change += change;
      conditions.apply(nodes.of_field(at.node), kick, nodes.sum[n].mass, nodes.motion[n], work);
    }
  }
}

template <int D>
void RigidNodes<D>::hold(Real time, const BoundaryConditions<D>& conditions, std::span<const RigidState<D>> states,
                         std::span<VelocityField<D>> fields) const
{
  for (const RigidNode<D>& at : nodes_) {
    if (at.pressed.isZero(0))
      continue;
    Nodes<D>& nodes = fields[static_cast<std::size_t>(at.field)].nodes;
    NodeMotion<D>& remapped = nodes.remapped[static_cast<std::size_t>(at.node)];
    if (!at.sticks && !at.rubbed.isZero(0)) {
      remapped.v = remapped.change;
      continue;
    }
    const Vec<D> u = states[static_cast<std::size_t>(at.rigid)].velocity_at(at.touch.place) + at.offset, relative = remapped.v - u;
    if (const Real approach = -relative.dot(at.touch.normal); approach > 0)
      remapped.v = conditions.held(nodes.of_field(at.node), time, at.sticks ? u : Vec<D>(remapped.v + approach * at.touch.normal));
  }
}

template <int D>
void RigidNodes<D>::add_sums(const Mesh<D>& mesh, std::span<const RigidState<D>> states, std::span<const VelocityField<D>> fields,
                             std::span<ExactSums<RigidSums<D>>> sums) const
{
  for (const RigidNode<D>& at : nodes_) {
    if (at.pressed.isZero(0))
      continue;
    const RigidState<D>& state = states[static_cast<std::size_t>(at.rigid)];
    const NodeMotion<D>& motion = fields[static_cast<std::size_t>(at.field)].nodes.motion[static_cast<std::size_t>(at.node)];
    const Vec<D> relative = motion.v - 0.5 * motion.change - at.u, impulse = at.pressed + at.rubbed;
    sums[static_cast<std::size_t>(at.rigid)].add(
        {impulse, moment<D>(mesh.node(at.node), impulse), moment<D>(at.touch.place - state.x, impulse), impulse.dot(at.u),
         at.pressed.dot(relative) + at.rubbed.dot(at.offset), at.rubbed.dot(relative - at.offset)});
  }
}

#define TALUS_INSTANTIATE(D)                                                                                                           \
  template void RigidNodes<D>::act(const Kick&, Communicator&, const RigidScene<D>&, BoundaryConditions<D>&, std::span<RigidState<D>>, \
                                   std::span<VelocityField<D>>, ExactSums<BoundaryWork>&);                                             \
  template void RigidNodes<D>::hold(Real, const BoundaryConditions<D>&, std::span<const RigidState<D>>, std::span<VelocityField<D>>)   \
      const;                                                                                                                           \
  template void RigidNodes<D>::add_sums(const Mesh<D>&, std::span<const RigidState<D>>, std::span<const VelocityField<D>>,             \
                                        std::span<ExactSums<RigidSums<D>>>) const;
TALUS_INSTANTIATE(2)
TALUS_INSTANTIATE(3)
#undef TALUS_INSTANTIATE

}  // namespace talus
