#pragma once
// Deformation and stress of every particle at the end of the step.
#include "core/particle_errors.hpp"
#include "core/particles.hpp"
#include "materials/batch.hpp"
#include "mesh/mesh.hpp"
#include "solver/loads/water.hpp"
#include "solver/state/particle_pack.hpp"

namespace talus {

/// What the particles of a body report of a step.
struct StressSums {
  Real work = 0;                                          ///< stress power times dt [J], trapezoidal in the Kirchhoff stress
  Real crossing = std::numeric_limits<Real>::infinity();  ///< shortest altitude of a particle's cell / (wave speed + |v|) [s]
  Real speed = 0;                                         ///< of the fastest particle [m/s]
  Real seconds = 0;                                       ///< of a processor
  /// All but the work.
  void take_extremes(const StressSums& other) noexcept
  {
    crossing = std::min(crossing, other.crossing);
    speed = std::max(speed, other.speed);
    seconds += other.seconds;
  }
};

/// F_p <- (I + dt L_p) F_p, sigma_p = law(F_p, L_p, history) - (q_p + u_p) I for the particles of a body in `rows`, four at a time.
///
/// A body that averages its volume (`averaged` holds the new ratios, see average_volume) tells its law F and I + dt L with their
/// in-plane volume ratio replaced; F_p itself stays what the motion made it.  q_p is the artificial viscous pressure of a body that
/// has one:  q = rho h |d| (quadratic h |d| + linear c) where the volume shrinks at the rate d = tr L, h the altitude of the cell
/// (von Neumann & Richtmyer 1950; linear term of Landshoff 1955).  u_p is the pressure of `pore` water where the particle is now, so
/// that the law sees effective stress; without pore water the law sees all there is.
///
/// The crossing counts viscosity nu and q by the damping of the wave of one cell: speed = Q + sqrt(Q^2 + c^2) with
/// Q = D nu / h + quadratic h |d| + linear c, exact for a chain of equal cells.
template <int D>
StressSums update_stress(const Mesh<D>& mesh, AnyBatch& material, std::span<const Index> rows, Real dt, bool elastic,
                         const std::vector<Real>& averaged, const std::optional<PoreWater>& pore, Particles<D>& particles,
                         ParticleErrors& health);

extern template StressSums update_stress<2>(const Mesh<2>&, AnyBatch&, std::span<const Index>, Real, bool, const std::vector<Real>&,
                                            const std::optional<PoreWater>&, Particles<2>&, ParticleErrors&);
extern template StressSums update_stress<3>(const Mesh<3>&, AnyBatch&, std::span<const Index>, Real, bool, const std::vector<Real>&,
                                            const std::optional<PoreWater>&, Particles<3>&, ParticleErrors&);

/// Altitude h [m] / (effective wave speed + |v|) of a particle [s].  `shrinking` is max(-tr L, 0) [1/s].  T is Real or Lanes.
template <int D, class L, class T>
T crossing_time(const Batch<L>& batch, const T& h, const T& speed_of_particle, const T& wave_speed, const T& shrinking) noexcept
{
  using std::sqrt;
  T damping = 0;
  bool damped = false;
  if constexpr (requires { batch.law.diffusivity(batch.constants); }) {
    damping += D * batch.law.diffusivity(batch.constants) / h;
    damped = true;
  }
  if (batch.viscosity) {
    damping += where(shrinking > 0, T(batch.viscosity->quadratic * h * shrinking + batch.viscosity->linear * wave_speed), T(0));
    damped = true;
  }
  const T speed = damped ? T(damping + sqrt(T(damping * damping + wave_speed * wave_speed))) : wave_speed;
  return h / (speed + speed_of_particle);
}

}  // namespace talus
