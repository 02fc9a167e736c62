#pragma once
// How momentum travels between particles and nodes: a value, not a class hierarchy.
#include <cstdint>
#include <optional>

#include "core/types.hpp"

namespace talus {

enum class Scheme : std::uint8_t {
  flip,  ///< particles take the nodes' increments                      [Brackbill & Ruppel 1986]
  apic,  ///< affine field C = B D^-1 from the weights' second moment   [Jiang et al. 2015]
  tpic,  ///< affine field C = L, the kernel's own velocity gradient    [Nakamura et al. 2023]
};

struct Transfer {
  Scheme scheme = Scheme::flip;
  bool musl = true;                      ///< momentum goes back to the nodes before L is taken   [Sulsky, Zhou & Schreyer 1995]
  std::optional<Real> pic_damping_time;  ///< flip: each step takes the share dt/time from plain PIC [s]

  bool affine() const noexcept { return scheme != Scheme::flip; }
  /// Share of plain PIC in a step of length dt.
  Real pic_share(Real dt) const noexcept { return pic_damping_time ? std::min(dt / *pic_damping_time, Real{1}) : Real{0}; }
};

}  // namespace talus
