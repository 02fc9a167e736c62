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

/// Reports the particle in a lane of the pack that begins at i.
template <int D>
[[gnu::always_inline]] inline void report(const StressStrip<D>& strip, std::size_t i, int lane, Trouble trouble) noexcept
{
  strip.errors->report(strip.id[i + static_cast<std::size_t>(lane)], trouble);
}

/// Particles of the pack that begins at i; lanes beyond repeat the last one.
template <int D>
int lanes_of(const StressStrip<D>& strip, std::size_t i) noexcept
{
  return static_cast<int>(std::min<std::size_t>(pack_size, strip.n - i));
}

// The parts of a stress update, of particles i to i + 3 of a strip or those up to its end.  They are functions of local variables, all inlined: as
// members of one object the same numbers were kept in memory, and the update took 15 % longer.

/// Deforms particles i to i + 3 of a strip, or those up to its end: F by `rate`, and the volume.  Returns det F; not above 0 where it reports.
template <int D>
[[gnu::always_inline]] inline SimdReal deform(const StressStrip<D>& strip, std::size_t i, const MatOf<D>& rate,
                                              Mat3Of<SimdReal>& F) noexcept
{
  F = strip.F.load(i);
  F.template topLeftCorner<D, D>() += SimdReal(strip.dt) * (rate * F.template topLeftCorner<D, D>());
  strip.F.store(i, F);
  const SimdReal J = F.determinant();
  const auto good = J > 0;  // false for NaN
  if (!all_of(good))
    for (int lane = 0; lane < lanes_of(strip, i); ++lane)
      if (!good[lane])
        report(strip, i, lane, std::isfinite(J[lane]) ? Trouble::inverted : Trouble::not_finite);
  strip.volume.store(i, J * strip.volume0.load(i));
  return J;
}

/// F and L as the law sees them, where bodies average their volume: see update_stress() of material.hpp.
template <int D>
[[gnu::always_inline]] inline void average_volume(const StressStrip<D>& strip, std::size_t i, const SimdReal& J, Mat3Of<SimdReal>& F,
                                                  Mat3Of<SimdReal>& L) noexcept
{
  const SimdReal to_average = strip.averaged.load(i) / J, ratio = D == 2 ? sqrt(to_average) : pow(to_average, Real{1} / D);
  const SimdReal s = ratio / strip.volume_ratio.load(i);
  strip.volume_ratio.store(i, ratio);
  F = scaled_in_plane<D>(F, ratio);
  L = scaled_in_plane<D>(L, s);
  for (int d = 0; d < D; ++d)
    L(d, d) += (s - 1) / strip.dt;
}

/// Artificial and pore pressures of a step.
struct StepPressures {
  SimdReal viscous = 0, pore = 0;
};
/// Takes those of the last step from `stress`, and returns those of this one.
template <int D>
[[gnu::always_inline]] inline StepPressures find_pressures(const Material& material, const StressStrip<D>& strip, std::size_t i,
                                                           const SimdReal& shrinking, const SimdReal& speed_of_waves,
                                                           Mat3Of<SimdReal>& stress) noexcept
{
  StepPressures pressures;
  if (material.viscosity) {
    stress.diagonal().array() += strip.viscous.load(i);
    const SimdReal h = strip.altitude.load(i);
    pressures.viscous = strip.mass.load(i) / strip.volume.load(i) * h * shrinking *
                        (material.viscosity->quadratic * h * shrinking + material.viscosity->linear * speed_of_waves);
    strip.viscous.store(i, pressures.viscous);
  }
  if (strip.pore_after) {
    stress.diagonal().array() += strip.pore.load(i);
    pressures.pore = strip.pore_after.load(i);
    strip.pore.store(i, pressures.pore);
  }
  return pressures;
}

/// What a step has found before the law answers.
template <int D>
struct DeformedPack {
  const MatOf<D>& rate;
  const Sym3Of<SimdReal>& stored;  ///< stress before the step
  const SimdReal &J, &volume_before, &shrinking, &speed_of_waves;
  const StepPressures& pressures;
};

/// Stores the answer of the law and reports.
template <int D>
[[gnu::always_inline]] inline void take_answer(Mat3Of<SimdReal> after, const Material& material, const StressStrip<D>& strip, std::size_t i,
                                               const DeformedPack<D>& found, const std::optional<Real>& diffusivity,
                                               StressLanes& sums) noexcept
{
  after.diagonal().array() -= found.pressures.viscous + found.pressures.pore;
  const Sym3Of<SimdReal> stress = talus::pack(after);
  const auto good = found.J > 0, answered = isfinite(SimdReal(stress.sum()));
  if (!all_of(answered))
    for (int lane = 0; lane < lanes_of(strip, i); ++lane)
      if (good[lane] && !answered[lane])
        report(strip, i, lane, Trouble::no_answer);
  strip.stress.store(i, stress);

  const SimdReal work =
      0.5 * strip.dt *
      (found.volume_before * stress_power<D>(found.stored, found.rate) + strip.volume.load(i) * stress_power<D>(stress, found.rate));
  const SimdReal speed = sqrt(SimdReal(strip.v.load(i).squaredNorm()));
  const SimdReal crossing =
      crossing_time<D>(diffusivity, material.viscosity, strip.altitude.load(i), speed, found.speed_of_waves, found.shrinking);
  const auto sound = good && answered, counts = sound && SimdReal(Pack{0, 1, 2, 3}) < static_cast<Real>(lanes_of(strip, i));
  sums.work += where(counts, work, 0);  // lanes beyond the last particle
  sums.crossing = where(counts, min(sums.crossing, crossing), sums.crossing);
  sums.speed = where(counts, max(sums.speed, speed), sums.speed);
}

}  // namespace talus::detail
