#pragma once
// The block `transfer` of a scene: how momentum travels between particles and nodes.
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/error.hpp"
#include "core/fields.hpp"

namespace talus {

enum class Scheme : std::uint8_t {
  flip,    ///< particles take the nodes' increments                      [Brackbill & Ruppel 1986]
  apic,    ///< affine field C = B D^-1 from the weights' second moment   [Jiang et al. 2015]
  tpic,    ///< affine field C = L, the kernel's own velocity gradient    [Nakamura et al. 2023]
  aflip,   ///< increments as flip, affine field as tpic                  [affine FLIP, Fei et al. 2021, ACM Trans. Graph. 40]
  saflip,  ///< affine field from the velocities of the nodes, increments by the transpose: symmetric affine FLIP
};
constexpr std::array<std::string_view, 5> enum_names(Scheme) { return {"flip", "apic", "tpic", "aflip", "saflip"}; }

struct TransferOptions {
  Scheme scheme = Scheme::aflip;
  std::optional<bool> musl{};                    ///< see uses_musl()
  std::optional<Real> pic_damping_time{};        ///< flip, aflip: each step takes the share dt/time of the velocity from the nodes [s]
  std::optional<Real> pic_damping_crossings{};   ///< the same, time counted in the shortest in which a wave crosses a cell [-]
  std::optional<Real> pic_damping_fall_times{};  ///< the same, time counted in sqrt(h/g), see fall_time() in app/setup [-]
  SourceLocation where{};
  static constexpr auto fields()
  {
    return std::tuple{
        optional_choice("scheme", &TransferOptions::scheme,
                        "flip (increments), apic (affine, own matrix), tpic (affine, velocity gradient), aflip (increments, affine) or "
                        "saflip (increments, "
                        "affine, keeps the energy of elastic bodies; projected only)"),
        optional("musl", &TransferOptions::musl, any, "-",
                 "map momentum back to the nodes before the velocity gradient is taken; default true for flip, aflip and saflip, false "
                 "otherwise"),
        optional("pic_damping_time", &TransferOptions::pic_damping_time, positive, "s",
                 "flip, aflip and saflip: share dt/time of the nodes' velocity in each step; default none"),
        optional("pic_damping_crossings", &TransferOptions::pic_damping_crossings, positive, "-",
                 "the same, time counted in the shortest in which a wave crosses a cell (that of time.cfl); default 25 for aflip, but see "
                 "pic_damping_fall_times, and for saflip in stages that seek rest"),
        optional("pic_damping_fall_times", &TransferOptions::pic_damping_fall_times, positive, "-",
                 "the same, time counted in sqrt(h/g), h the median altitude of the cells in which bodies are placed and g the largest "
                 "gravity; default 1 "
                 "for aflip under gravity where a body flows (its law dissipates), so that stiffness does not change how far it runs, "
                 "except in stages that seek rest (geostatic, or with local damping); where it is given, it holds in all stages")};
  }
  void check(std::vector<std::string>& problems) const
  {
    const int given = (pic_damping_time ? 1 : 0) + (pic_damping_crossings ? 1 : 0) + (pic_damping_fall_times ? 1 : 0);
    if (given > 0 && !increments())
      problems.emplace_back(
          "pic_damping_time, pic_damping_crossings and pic_damping_fall_times are for schemes flip, aflip and saflip only");
    if (is_symmetric() && !uses_musl())
      problems.emplace_back("saflip maps momentum back to the nodes: leave musl out");
    if (given > 1)
      problems.emplace_back("give one of pic_damping_time, pic_damping_crossings and pic_damping_fall_times");
  }

  /// Particles carry an affine field.
  bool affine() const noexcept { return scheme != Scheme::flip && scheme != Scheme::saflip; }
  bool increments() const noexcept { return scheme == Scheme::flip || scheme == Scheme::aflip || scheme == Scheme::saflip; }
  /// The affine field is that of the nodes' own velocities, and increments come back by the transpose of what it adds.
  bool is_symmetric() const noexcept { return scheme == Scheme::saflip; }
  /// Momentum goes back to the nodes before L is taken [Sulsky, Zhou & Schreyer 1995].
  bool uses_musl() const noexcept { return musl.value_or(increments()); }
  /// The affine field is kept beside L: it is that of the step's own velocities while L is of remapped ones, or it is not L at all.
  bool own_affine_field() const noexcept { return scheme == Scheme::apic || (affine() && uses_musl()); }
  /// Share of the nodes' velocity in a step of length dt [s]; `crossing` [s] is the shortest time in which a wave crosses a cell, 0 if not
  /// known.  Where both measures are set, stages that seek rest use that of waves, which they have to damp.  One share for all particles:
  /// one that differed from cell to cell would not keep the momentum.
  Real pic_share(Real dt, Real crossing, bool seeks_rest) const noexcept
  {
    if (pic_damping_time && !(seeks_rest && pic_damping_crossings))
      return std::min(dt / *pic_damping_time, Real{1});
    return pic_damping_crossings && crossing > 0 ? std::min(dt / (*pic_damping_crossings * crossing), Real{1}) : Real{0};
  }
  /// These options, with the damping that a scheme has unless another is given (measured: docs/development/kernels.md).  `fall` is sqrt(h/g)
  /// [s], 0 without gravity; `flows` says whether a body has a law that dissipates.
  TransferOptions with_damping(Real fall, bool flows) const noexcept
  {
    TransferOptions all = *this;
    if (scheme == Scheme::aflip && !pic_damping_time && !pic_damping_crossings && !pic_damping_fall_times) {
      all.pic_damping_crossings = 25;
      if (fall > 0 && flows)
        all.pic_damping_fall_times = 1;
    }
    if (is_symmetric() && !pic_damping_time && !pic_damping_crossings && !pic_damping_fall_times) {
      all.pic_damping_crossings = 25;  // in stages that seek rest, and in no others
      all.pic_damping_time = std::numeric_limits<Real>::infinity();
    }
    if (all.pic_damping_fall_times)
      all.pic_damping_time = *all.pic_damping_fall_times * fall;
    return all;
  }
};

}  // namespace talus
