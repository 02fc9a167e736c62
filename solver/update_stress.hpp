#pragma once
// Deformation and stress of every particle at the end of the step.
#include "core/health.hpp"
#include "materials/batch.hpp"

namespace talus {

/// F_p <- (I + dt L_p) F_p, sigma_p = law(F_p, L_p, history).  Returns the stress power times dt [J], trapezoidal in the Kirchhoff
/// stress over the step.  One dispatch per body, then a plain typed loop.
template <int D>
Real update_stress(AnyBatch& material, Real dt, bool elastic, Particles<D>& particles, Health& health)
{
  return std::visit(
      [&](auto& batch) {
        return parallel_sum<Real>(batch.size(), [&](Index i) {
          const auto p = static_cast<std::size_t>(batch.begin + i);
          const Mat3 L = embed<D>(particles.L[p]);
          const Mat3 before = unpack(particles.stress[p]);
          const Real J_before = particles.F[p].determinant();
          const Mat3 F = (Mat3::Identity() + dt * L) * particles.F[p];
          particles.F[p] = F;
          const Real J = F.determinant();
          if (!(J > 0)) {
            health.report(particles.id[p], std::isfinite(J) ? Trouble::inverted : Trouble::not_finite);
            return Real{0};
          }
          const Mat3 after = batch.update(i, Increment{F, L, before, dt, elastic});
          const Sym3 stress = pack(after);
          if (!stress.allFinite())
            health.report(particles.id[p], Trouble::no_answer);
          particles.stress[p] = stress;
          return 0.5 * dt * particles.volume0[p] * (J_before * before + J * after).cwiseProduct(L).sum();
        });
      },
      material);
}


}  // namespace talus
