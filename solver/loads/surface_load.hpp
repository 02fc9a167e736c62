#pragma once
// Loads on surfaces of bodies that cut cells, as a virtual stress.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "core/time_table.hpp"
#include "core/types.hpp"
#include "solver/state/tracked_ids.hpp"

namespace talus {

/// The loaded side next to a particle, found when a run is set up, all in the undeformed body.
template <int D>
struct NearSide {
  Real depth{};                     ///< distance from the side [m]
  Vec<D> normal = Vec<D>::Zero();   ///< outward unit normal N of the side
  Vec<D> carrier = Vec<D>::Zero();  ///< divergence-free field m with m . N = 1 on the side and along free sides beside it [-]
};

/// A traction or pressure on the surface of a body, or on a side of it, wherever it lies in its cells.
///
/// A virtual stress S with S n = t on the side and zero on all others turns the load into forces of nodes:
///
///     f_v = X_v sum_n Z_n D_nv,      Z_n = sum_p N_n V_p S_p
///
/// which are those of a stress with the other sign, so that a body whose stress is S is in equilibrium beside the surface whatever its cells
/// (after the virtual stress boundary of Given, Soga et al. 2024).  Inside of the body they are zero up to quadrature, since S has no
/// divergence; X_v falls there from 1 to 0, so that the far end of S loads nothing.  The theory is in docs/theory/walls.md#surfaces-that-cut-cells.
///
/// Inside, forces of stress and load have the same errors of quadrature, so a load on the whole surface, whose X is 1 everywhere, leaves none.
///
///     pressure on the whole surface or on a closed part of it   S = -p I
///     pressure on a side                                        S = -p (F^-T N) (x) (F m)
///     traction t per initial area, direction fixed              J S = t (x) (F m)
template <int D>
struct SurfaceLoad {
  Index body = none;
  Vec<D> traction = Vec<D>::Zero();  ///< [Pa]
  Real pressure{};                   ///< [Pa], or [N/m^3] with a water level, positive in compression
  std::optional<Table> water_level;  ///< height in time below which the pressure grows [m]; none: it is the same everywhere
  Table table;
  SourceLocation where;
  bool ends_at_walls = false;     ///< no load where the surface lies on the boundary of the mesh
  bool is_closed = false;         ///< the loaded part of the surface has no edge
  Real reach = 0;                 ///< depth at which X has fallen to 0 [m]; 0: X is 1 everywhere
  Real deep = 0;                  ///< depth of the particles that are not near, more than the reach [m]
  TrackedIds near;                ///< particles near the side
  std::vector<NearSide<D>> side;  ///< in the order of their ids

  /// Share of the reach in which X is 1.
  static constexpr Real full_share = 0.4;
  /// X at a depth [m].
  Real cut_off(Real depth) const noexcept
  {
    if (!(reach > 0))
      return 1;
    const Real s = std::clamp((depth / reach - full_share) / (1 - full_share), Real{0}, Real{1});
    return 1 - s * s * (3 - 2 * s);
  }
  /// The largest depth of water above a height [m]; 1 where the pressure is the same everywhere.
  Real largest_height(Real bottom) const noexcept
  {
    return water_level ? std::max(water_level->largest_magnitude() - bottom, Real{0}) : Real{1};
  }
  /// The factor of the load at a place and a time; `ramp` is that of the stage.
  Real factor(const Vec<D>& x, Real time, Real ramp) const noexcept
  {
    return ramp * table(time) * (water_level ? std::max((*water_level)(time)-x[D - 1], Real{0}) : Real{1});
  }
};

/// V S of a particle without the factor [N m, or N with a water level], and its depth [m].
template <int D>
struct VirtualStress {
  Mat<D> tension = Mat<D>::Zero();
  Real depth{};
};
/// F, V_0 and V are those of the particle [-, m^D, m^D].
template <int D>
VirtualStress<D> virtual_stress(const SurfaceLoad<D>& load, std::int64_t id, const Mat<D>& F, Real volume0, Real volume) noexcept
{
  if (!(load.reach > 0))
    return {-load.pressure * volume * Mat<D>::Identity(), 0};
  const auto place = load.near.place(id);
  if (!place)
    return {Mat<D>::Zero(), load.deep};
  const NearSide<D>& side = load.side[*place];
  Mat<D> tension = volume0 * load.traction * (F * side.carrier).transpose();
  if (load.pressure != 0)
    tension -=
        load.pressure * volume *
        (load.is_closed ? Mat<D>(Mat<D>::Identity()) : Mat<D>((F.inverse().transpose() * side.normal) * (F * side.carrier).transpose()));
  return {tension, side.depth};
}

}  // namespace talus
