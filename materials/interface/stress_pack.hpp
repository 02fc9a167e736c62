#pragma once
// The part of a stress update that does not depend on the law, of four particles at a time: deformation, artificial and pore pressures, and what
// the step reports.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/strip_column.hpp"
#include "materials/interface/material.hpp"

namespace talus::detail {

/// The in-plane part of a multiplied by s, in 3-D all of it.
template <int D>
Mat3Of<SimdReal> scaled_in_plane(Mat3Of<SimdReal> a, const SimdReal& s) noexcept
{
  a.topLeftCorner<D, D>() *= s;
  return a;
}

/// StressSums, one particle per lane.
struct StressLanes {
  SimdReal work = 0, crossing = std::numeric_limits<Real>::infinity(), speed = 0;
  StressSums total() const noexcept
  {
    StressSums sums{sum(work.of)};
    for (int lane = 0; lane < pack_size; ++lane)
      sums.crossing = std::min(sums.crossing, crossing[lane]), sums.speed = std::max(sums.speed, speed[lane]);
    return sums;
  }
};

/// a : L, with L in the plane where D is 2.
template <int D>
SimdReal stress_power(const Sym3Of<SimdReal>& a, const MatOf<D>& L) noexcept
{
  SimdReal power = a[0] * L(0, 0) + a[1] * L(1, 1) + a[3] * (L(0, 1) + L(1, 0));
  if constexpr (D == 3)
    power += a[2] * L(2, 2) + a[4] * (L(1, 2) + L(2, 1)) + a[5] * (L(0, 2) + L(2, 0));
  return power;
}

/// Particles i to i + 3 of a strip, or those up to its end, while their stress is updated.  F, L and stress are those that the law sees: see
/// update_stress() of material.hpp.
template <int D>
struct StressPack {
  std::size_t i;
  int count;  ///< particles; lanes beyond repeat the last one
  Mat3Of<SimdReal> F, L, stress;
  SimdReal q = 0, u = 0;  ///< artificial and pore pressure of the step
  SimdReal J, volume_before, volume, shrinking, h;
  MatOf<D> rate;
  Sym3Of<SimdReal> stored;  ///< stress before the step
  MaskOf<SimdReal> good;    ///< not inverted

  /// Deforms the particles.
  [[gnu::always_inline]] StressPack(const Material& material, const StressStrip<D>& strip, std::size_t first) noexcept
      : i(first), count(static_cast<int>(std::min<std::size_t>(pack_size, strip.n - first))), rate(strip.L.load(first))
  {
    const Real dt = strip.dt;
    const Mat3Of<SimdReal> velocity_gradient = embed(rate);
    F = strip.F.load(i);
    F.template topLeftCorner<D, D>() += SimdReal(dt) * (rate * F.template topLeftCorner<D, D>());
    strip.F.store(i, F);
    J = F.determinant();
    good = J > 0;  // false for NaN
    if (!all_of(good))
      for (int lane = 0; lane < count; ++lane)
        if (!good[lane])
          report(strip, lane, std::isfinite(J[lane]) ? Trouble::inverted : Trouble::not_finite);
    volume_before = strip.volume.load(i), volume = J * strip.volume0.load(i);
    strip.volume.store(i, volume);
    shrinking = max(-SimdReal(rate.trace()), 0);
    h = strip.altitude.load(i);
    stored = strip.stress.load(i);
    L = velocity_gradient, stress = unpack(stored);
    if (material.averages_volume) {
      const SimdReal to_average = strip.averaged.load(i) / J, ratio = D == 2 ? sqrt(to_average) : pow(to_average, Real{1} / D);
      const SimdReal s = ratio / strip.volume_ratio.load(i);
      strip.volume_ratio.store(i, ratio);
      F = scaled_in_plane<D>(F, ratio);
      L = scaled_in_plane<D>(velocity_gradient, s);
      for (int d = 0; d < D; ++d)
        L(d, d) += (s - 1) / dt;
    }
  }

  /// Takes the pressures of the last step from the stress, and finds those of this one.
  [[gnu::always_inline]] void find_pressures(const Material& material, const StressStrip<D>& strip, const SimdReal& speed_of_waves) noexcept
  {
    if (material.viscosity) {
      stress.diagonal().array() += strip.viscous.load(i);
      q = strip.mass.load(i) / volume * h * shrinking *
          (material.viscosity->quadratic * h * shrinking + material.viscosity->linear * speed_of_waves);
      strip.viscous.store(i, q);
    }
    if (strip.pore_after) {
      stress.diagonal().array() += strip.pore.load(i);
      u = strip.pore_after.load(i);
      strip.pore.store(i, u);
    }
  }

  /// Stores the answer of the law and reports.
  [[gnu::always_inline]] void take(Mat3Of<SimdReal> after, const Material& material, const StressStrip<D>& strip,
                                   const std::optional<Real>& diffusivity, const SimdReal& speed_of_waves, StressLanes& sums) const noexcept
  {
    after.diagonal().array() -= q + u;
    const Sym3Of<SimdReal> new_stress = talus::pack(after);
    const auto answered = isfinite(SimdReal(new_stress.sum()));
    if (!all_of(answered))
      for (int lane = 0; lane < count; ++lane)
        if (good[lane] && !answered[lane])
          report(strip, lane, Trouble::no_answer);
    strip.stress.store(i, new_stress);

    const SimdReal work = 0.5 * strip.dt * (volume_before * stress_power<D>(stored, rate) + volume * stress_power<D>(new_stress, rate));
    const SimdReal speed = sqrt(SimdReal(strip.v.load(i).squaredNorm()));
    const SimdReal crossing = crossing_time<D>(diffusivity, material.viscosity, h, speed, speed_of_waves, shrinking);
    const auto sound = good && answered, counts = sound && SimdReal(Pack{0, 1, 2, 3}) < static_cast<Real>(count);
    sums.work += where(counts, work, 0);  // lanes beyond the last particle
    sums.crossing = where(counts, min(sums.crossing, crossing), sums.crossing);
    sums.speed = where(counts, max(sums.speed, speed), sums.speed);
  }

 private:
  [[gnu::always_inline]] void report(const StressStrip<D>& strip, int lane, Trouble trouble) const noexcept
  {
    strip.errors->report(strip.id[i + static_cast<std::size_t>(lane)], trouble);
  }
};

}  // namespace talus::detail
