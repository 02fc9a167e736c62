#pragma once
// Deformation and stress of every particle at the end of the step.
#include "core/health.hpp"
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

/// F_p <- (I + dt L_p) F_p, sigma_p = law(F_p, L_p, history).  One dispatch per body, then a plain typed loop.
template <int D>
StressSums update_stress(const Mesh<D>& mesh, AnyBatch& material, Real dt, bool elastic, Particles<D>& particles, Health& health)
{
  return std::visit(
      [&](auto& batch) {
        return parallel_sum<StressSums>(
            batch.size(), [&](Index i) __attribute__((flatten))->StressSums {
              const auto p = static_cast<std::size_t>(batch.begin + i);
              const Mat3 L = embed<D>(particles.L[p]), F_old = particles.F[p];
              const Mat3 before = unpack(particles.stress[p]);
              const Real volume_before = particles.volume[p];
              const Mat3 F = F_old + dt * (L * F_old);
              particles.F[p] = F;
              const Real J = F.determinant();
              if (!(J > 0)) {
                health.report(particles.id[p], std::isfinite(J) ? Trouble::inverted : Trouble::not_finite);
                return {};
              }
              const Mat3 after = batch.update(i, Increment{F, L, before, dt, elastic});
              const Sym3 stress = pack(after);
              if (!std::isfinite(stress.sum()))
                health.report(particles.id[p], Trouble::no_answer);
              particles.stress[p] = stress;
              particles.volume[p] = J * particles.volume0[p];
              const Mat3 mean = 0.5 * (volume_before * before + particles.volume[p] * after);
              return {dt * mean.cwiseProduct(L).sum(),
                      mesh.altitude(particles.cell[p]) / (batch.law.wave_speed(F) + particles.v[p].norm())};
            });
      },
      material);
}

}  // namespace talus
