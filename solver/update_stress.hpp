#pragma once
// Deformation and stress of every particle at the end of the step.
#include "core/health.hpp"
#include "core/particles.hpp"
#include "materials/batch.hpp"
#include "mesh/mesh.hpp"

namespace talus {

/// What the particles of a body report of a step.
struct StressSums {
  Real work = 0;                                          ///< stress power times dt [J], trapezoidal in the Kirchhoff stress
  Real crossing = std::numeric_limits<Real>::infinity();  ///< shortest altitude of a particle's cell / (wave speed + |v|) [s]
  StressSums& operator+=(const StressSums& other) noexcept
  {
    work += other.work;
    crossing = std::min(crossing, other.crossing);
    return *this;
  }
};

/// F_p <- (I + dt L_p) F_p, sigma_p = law(F_p, L_p, history) - q_p I.  One dispatch per body, then a plain typed loop.
///
/// A body that averages its volume (`averaged` holds the new ratios, see average_volume) tells its law F and I + dt L with their
/// in-plane volume ratio replaced; F_p itself stays what the motion made it.  q_p is the artificial viscous pressure of a body that
/// has one:  q = rho h |d| (quadratic h |d| + linear c) where the volume shrinks at the rate d = tr L, h the altitude of the cell
/// (von Neumann & Richtmyer 1950; linear term of Landshoff 1955).
///
/// The crossing counts viscosity nu and q by the damping of the wave of one cell: speed = Q + sqrt(Q^2 + c^2) with
/// Q = D nu / h + quadratic h |d| + linear c, exact for a chain of equal cells.
template <int D>
StressSums update_stress(const Mesh<D>& mesh, AnyBatch& material, Real dt, bool elastic, const std::vector<Real>& averaged,
                         Particles<D>& particles, Health& health);

extern template StressSums update_stress<2>(const Mesh<2>&, AnyBatch&, Real, bool, const std::vector<Real>&, Particles<2>&, Health&);
extern template StressSums update_stress<3>(const Mesh<3>&, AnyBatch&, Real, bool, const std::vector<Real>&, Particles<3>&, Health&);

/// Altitude / (effective wave speed + |v|) of a particle [s].  `shrinking` is max(-tr L, 0) [1/s].
template <int D, class L>
Real crossing_time(const Mesh<D>& mesh, const Batch<L>& batch, const Particles<D>& particles, std::size_t p, Real wave_speed,
                   Real shrinking) noexcept
{
  const Real h = mesh.altitude(particles.cell[p]);
  Real speed = wave_speed;
  Real damping = 0;
  if constexpr (requires { batch.law.diffusivity(batch.constants); })
    damping += D * batch.law.diffusivity(batch.constants) / h;
  if (batch.viscosity && shrinking > 0)
    damping += batch.viscosity->quadratic * h * shrinking + batch.viscosity->linear * wave_speed;
  if (damping > 0)
    speed = damping + std::sqrt(damping * damping + wave_speed * wave_speed);
  return h / (speed + particles.v[p].norm());
}

}  // namespace talus
