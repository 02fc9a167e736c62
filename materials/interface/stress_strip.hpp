#pragma once
// Particles of one body side by side, and what their law needs to update their stress.
#include <algorithm>
#include <limits>
#include <span>

#include "core/particle_errors.hpp"
#include "core/particles.hpp"
#include "core/strip_column.hpp"

namespace talus {

/// What the particles of a body report of a step.
struct StressSums {
  Real work = 0;                                          ///< stress power times dt [J], trapezoidal in the Kirchhoff stress
  Real crossing = std::numeric_limits<Real>::infinity();  ///< shortest altitude of a particle's cell / (wave speed + |v|) [s]
  Real speed = 0;                                         ///< of the fastest particle [m/s]
  Real seconds = 0;                                       ///< processor time [s]
  /// Combines everything but the work.
  void take_extremes(const StressSums& other) noexcept
  {
    crossing = std::min(crossing, other.crossing);
    speed = std::max(speed, other.speed);
    seconds += other.seconds;
  }
};

/// Particles of a body side by side, what a law reads of the mesh and of the step, and where it writes.  Columns have room for whole packs;
/// the last particle is repeated behind it, see StripColumn::pad().
template <int D>
struct StressStrip {
  std::size_t n = 0;     ///< particles
  Real dt = 0;           ///< [s]
  bool elastic = false;  ///< a stage that suspends yielding
  Real time = 0;         ///< at the end of the step [s]
  StripColumn<Vec<D>> x{}, v{};
  StripColumn<Mat<D>> L{};
  StripColumn<Mat3> F{};
  StripColumn<Sym3> stress{};
  StripColumn<Real> mass{}, volume0{}, volume{};
  StripColumn<Real> altitude{};                  ///< least altitude of the cell of the particle [m]
  StripColumn<Real> viscous{};                   ///< of a material with bulk viscosity
  StripColumn<Real> averaged{}, volume_ratio{};  ///< of a material that averages its volume: the averaged ratio, see AveragedBodies
  StripColumn<Real> pore{}, pore_after{};        ///< pore pressure before and after the step [Pa]; empty where there is none
  StripIds id{};
  StripColumn<Real> history{};  ///< of the law: component(k) is the array of its number k
  ParticleErrors* errors = nullptr;
};

}  // namespace talus
