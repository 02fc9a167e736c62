#pragma once
// Velocities of poorly filled nodes for the gradient: extrapolated from well-filled nodes, along the surface of the material only.
#include <span>

#include "core/types.hpp"

namespace talus {

/// A node from which the velocity of another is extrapolated.
template <int D>
struct ExtensionSource {
  Vec<D> arm;  ///< from the node that is extended [m]
  Real fill;   ///< share of the volume of its linear shape function that is filled with material, at most 1 [-]
};

/// The tangential extension E of one node v: the velocity that stands for v_v in velocity gradients,
///
///     (E u)_v = n n.u_v + (1 - n n) [own u_v + sum_m (value + slope.r_m) w_m u_m]
///
/// with the normal n of the surface, the arms r_m of its sources and of itself, and the weights w_m = fill_m^2 (h / r_m)^4 (fill_v^2 for
/// itself).  The sum is the value at v of a linear field fitted with these weights, so that linear fields are kept.
///
/// Averaged gradients at a poorly filled node read nodes beyond the surface, whose velocities are those of the few particles near them, not
/// a continuation of the motion inside: a beam whose surface cuts cells is too soft.  Extending the normal component as well would heat a
/// body at rest and let bodies feel each other earlier.
template <int D>
struct ExtensionRow {
  Vec<D> normal = Vec<D>::Zero();
  Real own = 1;
  Real value = 0;
  Vec<D> slope = Vec<D>::Zero();  ///< [1/m]
  Real size = 0;                  ///< h, the distance of the node from its neighbours [m]

  bool extends() const noexcept { return own < 1; }
  /// The part of a vector along the surface.
  Vec<D> tangential(const Vec<D>& u) const noexcept { return u - normal.dot(u) * normal; }
  /// The weight in the sum [-]; the node itself has the arm 0.
  Real coefficient(const ExtensionSource<D>& source) const noexcept { return (value + slope.dot(source.arm)) * weight(source); }
  Real weight(const ExtensionSource<D>& source) const noexcept
  {
    const Real r2 = source.arm.squaredNorm(), ratio = r2 > 0 ? size * size / r2 : 1;
    return source.fill * source.fill * ratio * ratio;
  }
};

/// The filling that counts, from the volume of particles over that of the linear shape function.  It is full from 7/8 on, as the filling
/// varies inside a body too, and has 256 levels, so that rows stay as they are while it hardly changes.  With 32 levels a cantilever loses
/// 1.2 to 1.4 times the energy.
Real extension_fill(Real filled);

/// Nodes that are filled this far are not extended.
inline constexpr Real well_filled = 0.4;

/// The row of a node with this fill and size [m].  `sources` are those of the `around` nodes near it that are filled at all, itself among them
/// if it is; `outwards` is a direction out of the material there, of any length.  The row does not extend() where the node is well filled or its
/// sources do not tell a linear field, as around single particles and films.
template <int D>
ExtensionRow<D> extension_row(Real fill, Real size, std::span<const ExtensionSource<D>> sources, std::size_t around,
                              const Vec<D>& outwards);

}  // namespace talus
