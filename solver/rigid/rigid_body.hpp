#pragma once
// Rigid bodies: what no step changes of them, and their motion.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/fields.hpp"
#include "core/time_table.hpp"
#include "mesh/geometry/facet_surface.hpp"
#include "solver/state/step_sums.hpp"

namespace talus {

/// The cross product of an angular velocity [rad/s] with an arm; in 2-D only its last component counts.
template <int D>
Vec<D> turned_arm(const Vec3& spin, const Vec<D>& arm) noexcept
{
  if constexpr (D == 2)
    return {-spin[2] * arm[1], spin[2] * arm[0]};
  else
    return {spin[1] * arm[2] - spin[2] * arm[1], spin[2] * arm[0] - spin[0] * arm[2], spin[0] * arm[1] - spin[1] * arm[0]};
}

/// What facets are: the surface of a solid, or a sheet without thickness.
enum class FacetsOf : std::uint8_t { solid, sheet };

/// How far apart the points of its surface are at most at which a rigid body of facets is felt by others, for the radius around it [m].
constexpr Real spacing_of_samples(Real radius) noexcept { return radius / 8; }

/// The surface of a rigid body, about its centre of mass: a disk or ball of a radius, or facets.
template <int D>
class RigidShape {
 public:
  explicit RigidShape(Real radius) : surface_(Ball{radius}), radius_(radius) {}
  /// The centre of mass is the origin.  Contacts with other rigid bodies and walls are sought at points of the surface, of which there are
  /// eight or more over its radius.
  explicit RigidShape(FacetSurface<D> facets, FacetsOf of = FacetsOf::solid) : surface_(std::move(facets)), of_(of)
  {
    for (const Vec<D>& corner : this->facets()->corners())
      radius_ = std::max(radius_, corner.norm());
    samples_ = this->facets()->samples(spacing_of_samples(radius_));
  }
  SurfaceDistance<D> distance(const Vec<D>& x) const
  {
    if (const Ball* ball = std::get_if<Ball>(&surface_)) {
      const Real r = x.norm();
      return {r - ball->radius, r > 0 ? Vec<D>(x / r) : Vec<D>(Vec<D>::Unit(D - 1)), false, Vec<D>::Zero()};
    }
    return facets()->distance(x);
  }
  /// Whether it has material on both sides, that in front and that behind; see SideOfSheet.
  bool is_sheet() const noexcept { return of_ == FacetsOf::sheet; }
  bool is_ball() const noexcept { return std::holds_alternative<Ball>(surface_); }
  const FacetSurface<D>* facets() const noexcept { return std::get_if<FacetSurface<D>>(&surface_); }
  Real radius() const noexcept { return radius_; }                          ///< of the ball around the centre that holds it [m]
  const std::vector<Vec<D>>& samples() const noexcept { return samples_; }  ///< points of facets

 private:
  struct Ball {
    Real radius;
  };
  std::variant<Ball, FacetSurface<D>> surface_;
  FacetsOf of_ = FacetsOf::solid;
  Real radius_ = 0;
  std::vector<Vec<D>> samples_;
};

/// A prescribed motion: that of the centre, and the rotation about it.
template <int D>
struct RigidMotion {
  Vec<D> velocity = Vec<D>::Zero();  ///< [m/s]
  Vec3 spin = Vec3::Zero();          ///< [rad/s]
  Table table;                       ///< factor of both in time
};

template <int D>
struct RigidBody {
  std::string name;
  std::shared_ptr<const RigidShape<D>> shape;
  Real mass{};                           ///< [kg], of unit thickness in 2-D
  Mat3 inertia = Mat3::Zero();           ///< about its centre, in the axes of the scene at the start [kg m^2]
  Real friction{};                       ///< Coulomb's coefficient with all that it touches [-]
  std::optional<RigidMotion<D>> motion;  ///< nothing: it moves freely
  bool is_free() const noexcept { return !motion; }
};

/// Place and motion of a rigid body, and what it has done since the start of the run.
template <int D>
struct RigidState {
  Vec<D> x = Vec<D>::Zero();     ///< its centre of mass [m]
  Mat3 turn = Mat3::Identity();  ///< its rotation since the start
  Vec<D> v = Vec<D>::Zero();     ///< of the centre [m/s]; half a step behind places, as velocities of particles are
  Vec3 spin = Vec3::Zero();      ///< angular velocity [rad/s]
  RigidSums<D> done;
  static constexpr auto fields()
  {
    return std::tuple{saved("x", &RigidState::x), saved("turn", &RigidState::turn), saved("v", &RigidState::v),
                      saved("spin", &RigidState::spin), saved("done", &RigidState::done)};
  }

  /// The velocity that it has at a place [m/s].
  Vec<D> velocity_at(const Vec<D>& place) const noexcept { return v + turned_arm<D>(spin, place - x); }
  Vec<D> arm_in_body(const Vec<D>& place) const noexcept { return turn.template topLeftCorner<D, D>().transpose() * (place - x); }
  Vec<D> in_scene(const Vec<D>& along) const noexcept { return turn.template topLeftCorner<D, D>() * along; }
  SurfaceDistance<D> distance(const RigidShape<D>& shape, const Vec<D>& place) const
  {
    const SurfaceDistance<D> there = shape.distance(arm_in_body(place));
    return {there.distance, in_scene(there.normal), there.on_rim, in_scene(there.rim_normal)};
  }
  /// The tensor of inertia in the axes of the scene [kg m^2].
  Mat3 inertia(const RigidBody<D>& body) const noexcept { return turn * body.inertia * turn.transpose(); }
  Real kinetic(const RigidBody<D>& body) const noexcept { return 0.5 * body.mass * v.squaredNorm() + 0.5 * spin.dot(inertia(body) * spin); }
};

/// A wall of the mesh that rigid bodies touch.
template <int D>
struct RigidWall {
  std::string name;
  FacetSurface<D> surface;  ///< its front is inside the mesh
};

/// The rigid bodies of a scene, and the walls that they touch.
template <int D>
struct RigidScene {
  std::vector<RigidBody<D>> bodies;
  std::vector<RigidWall<D>> walls;
  bool any_sheet() const noexcept
  {
    return std::ranges::any_of(bodies, [](const RigidBody<D>& body) { return body.shape->is_sheet(); });
  }
};

/// Begins a step: gravity [m/s^2] acts on free bodies over `kick` [s], others get their velocity of the time `mid` [s].
template <int D>
void begin_step(const RigidScene<D>& scene, const Vec<D>& gravity, Real kick, Real mid, std::vector<RigidState<D>>& states);
/// Local damping of free bodies, whose velocities were those of `before` at the beginning of the step: see damping_of().
template <int D>
void damp(const RigidScene<D>& scene, Real damping, const std::vector<RigidState<D>>& before, std::vector<RigidState<D>>& states);
/// Ends it: bodies move and turn over dt [s].  The angular momentum of a body is kept.
template <int D>
void move(const RigidScene<D>& scene, Real dt, std::vector<RigidState<D>>& states);
/// The largest speed of a point of their surfaces [m/s].
template <int D>
Real fastest(const RigidScene<D>& scene, const std::vector<RigidState<D>>& states);

}  // namespace talus
