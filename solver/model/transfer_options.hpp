#pragma once
// Options of the transfer of momentum between particles and nodes.
#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/types.hpp"

namespace talus {

enum class Scheme : std::uint8_t {
  flip,   ///< particles take the nodes' increments                      [Brackbill & Ruppel 1986]
  apic,   ///< affine field C = B D^-1 from the weights' second moment   [Jiang et al. 2015]
  tpic,   ///< affine field C = L, the kernel's own velocity gradient    [Nakamura et al. 2023]
  aflip,  ///< increments as flip, affine field as tpic                  [affine FLIP, Fei et al. 2021, ACM Trans. Graph. 40]
};

struct TransferOptions {
  Scheme scheme = Scheme::flip;
  bool musl = true;                           ///< momentum returns to the nodes before L is computed   [Sulsky, Zhou & Schreyer 1995]
  std::optional<Real> pic_damping_time;       ///< flip, aflip: in each step the fraction dt/time of the velocity comes from the nodes [s]
  std::optional<Real> pic_damping_crossings;  ///< the same time in units of the shortest wave transit time of a cell [-]

  bool affine() const noexcept { return scheme != Scheme::flip; }
  bool increments() const noexcept { return scheme == Scheme::flip || scheme == Scheme::aflip; }
  /// Whether the affine field is stored separately from L: it is that of the step's own velocities while L is that of remapped ones, or it
  /// differs from L.
  bool own_affine_field() const noexcept { return scheme == Scheme::apic || (affine() && musl); }
  /// The fraction of the nodes' velocity in a step of length dt [s]; `crossing` [s] is the shortest wave transit time of a cell, 0 if
  /// unknown.  It is equal for all particles: a fraction that differs between cells would not conserve momentum.
  Real pic_share(Real dt, Real crossing) const noexcept
  {
    if (pic_damping_crossings)
      return crossing > 0 ? std::min(dt / (*pic_damping_crossings * crossing), Real{1}) : Real{0};
    return pic_damping_time ? std::min(dt / *pic_damping_time, Real{1}) : Real{0};
  }
};

}  // namespace talus
