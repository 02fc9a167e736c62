#pragma once
// How momentum travels between particles and nodes: what a scene chooses.
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
  bool musl = true;                           ///< momentum goes back to the nodes before L is taken   [Sulsky, Zhou & Schreyer 1995]
  std::optional<Real> pic_damping_time;       ///< flip, aflip: each step takes the share dt/time of the velocity from the nodes [s]
  std::optional<Real> pic_damping_crossings;  ///< the same, time counted in the shortest in which a wave crosses a cell [-]

  bool affine() const noexcept { return scheme != Scheme::flip; }
  bool increments() const noexcept { return scheme == Scheme::flip || scheme == Scheme::aflip; }
  /// The affine field is kept beside L: it is that of the step's own velocities while L is of remapped ones, or it is not L at all.
  bool own_affine_field() const noexcept { return scheme == Scheme::apic || (affine() && musl); }
  /// Share of the nodes' velocity in a step of length dt [s]; `crossing` [s] is the shortest time in which a wave crosses a cell, 0 if not
  /// known.  One share for all particles: one that differed from cell to cell would not keep the momentum.
  Real pic_share(Real dt, Real crossing) const noexcept
  {
    if (pic_damping_crossings)
      return crossing > 0 ? std::min(dt / (*pic_damping_crossings * crossing), Real{1}) : Real{0};
    return pic_damping_time ? std::min(dt / *pic_damping_time, Real{1}) : Real{0};
  }
};

}  // namespace talus
