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

/// Particles of the pack that begins at i; lanes beyond repeat the last one.
template <int D>
int lanes_of(const StressStrip<D>& strip, std::size_t i) noexcept
{
  return static_cast<int>(std::min<std::size_t>(pack_size, strip.n - i));
}

/// Reports particles of the pack that begins at i whose volume is not above zero.
template <int D>
[[gnu::noinline, gnu::cold]] void report_inverted(const StressStrip<D>& strip, std::size_t i, SimdReal J) noexcept
{
  for (int lane = 0; lane < lanes_of(strip, i); ++lane)
    if (!(J[lane] > 0))  // true for NaN
      strip.errors->report(strip.id[i + static_cast<std::size_t>(lane)], std::isfinite(J[lane]) ? Trouble::inverted : Trouble::not_finite);
}

/// Reports those for whose deformation the law has no answer: their sum of stresses is not finite.
template <int D>
[[gnu::noinline, gnu::cold]] void report_no_answer(const StressStrip<D>& strip, std::size_t i, SimdReal J, SimdReal sum_of_stress) noexcept
{
  for (int lane = 0; lane < lanes_of(strip, i); ++lane)
    if (J[lane] > 0 && !std::isfinite(sum_of_stress[lane]))
      strip.errors->report(strip.id[i + static_cast<std::size_t>(lane)], Trouble::no_answer);
}

// The parts of a stress update, of particles i to i + 3 of a strip or those up to its end.  They are functions of a few local variables, all
// inlined: with the same numbers as members of an object, or references to them in one, compilers keep them in memory, and the update takes 10 to
// 15 % longer.

/// Deforms particles by `rate`; returns F.
template <int D>
[[gnu::always_inline]] inline Mat3Of<SimdReal> move(const StressStrip<D>& strip, std::size_t i, const MatOf<D>& rate) noexcept
{
  Mat3Of<SimdReal> F = strip.F.load(i);
  F.template topLeftCorner<D, D>() += SimdReal(strip.dt) * (rate * F.template topLeftCorner<D, D>());
  strip.F.store(i, F);
  return F;
}

/// Their volume for J = det F; reports where that is not above zero.
template <int D>
[[gnu::always_inline]] inline void take_volume(const StressStrip<D>& strip, std::size_t i, const SimdReal& J) noexcept
{
  if (!all_of(J > 0))
    report_inverted(strip, i, J);
  strip.volume.store(i, J * strip.volume0.load(i));
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

/// Stores the stress with the answer of the law, and reports where there is none.  Returns which particles are sound.
template <int D>
[[gnu::always_inline]] inline SimdReal::Mask take_stress(const StressStrip<D>& strip, std::size_t i, const SimdReal& J,
                                                         const Sym3Of<SimdReal>& stress) noexcept
{
  const SimdReal sum_of_stress = stress.sum();
  const auto answered = isfinite(sum_of_stress);
  if (!all_of(answered))
    report_no_answer(strip, i, J, sum_of_stress);
  strip.stress.store(i, stress);
  return J > 0 && answered;
}

/// Work of the stress in the step [J]; `before` and `volume_before` are those at its begin.
template <int D>
[[gnu::always_inline]] inline SimdReal work_of(const StressStrip<D>& strip, std::size_t i, const MatOf<D>& rate,
                                               const Sym3Of<SimdReal>& before, const SimdReal& volume_before,
                                               const Sym3Of<SimdReal>& stress) noexcept
{
  return 0.5 * strip.dt * (volume_before * stress_power<D>(before, rate) + strip.volume.load(i) * stress_power<D>(stress, rate));
}

/// Adds sound particles to what the step reports.
template <int D>
[[gnu::always_inline]] inline void count(const Material& material, const StressStrip<D>& strip, std::size_t i, const SimdReal::Mask& sound,
                                         const SimdReal& work, const SimdReal& speed_of_waves, const SimdReal& shrinking,
                                         const std::optional<Real>& diffusivity, StressLanes& sums) noexcept
{
  const SimdReal speed = sqrt(SimdReal(strip.v.load(i).squaredNorm()));
  const SimdReal crossing = crossing_time<D>(diffusivity, material.viscosity, strip.altitude.load(i), speed, speed_of_waves, shrinking);
  const auto counts = sound && SimdReal(Pack{0, 1, 2, 3}) < static_cast<Real>(lanes_of(strip, i));
  sums.work += where(counts, work, 0);  // lanes beyond the last particle
  sums.crossing = where(counts, min(sums.crossing, crossing), sums.crossing);
  sums.speed = where(counts, max(sums.speed, speed), sums.speed);
}

}  // namespace talus::detail
