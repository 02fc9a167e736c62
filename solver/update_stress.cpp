#include "solver/update_stress.hpp"

namespace talus {

namespace {

/// The in-plane part of a multiplied by s, in 3-D all of it.
template <int D>
Mat3 scaled_in_plane(Mat3 a, Real s) noexcept
{
  a.template topLeftCorner<D, D>() *= s;
  return a;
}

template <int D, class L>
[[gnu::flatten]] StressSums update_particle(const Mesh<D>& mesh, Batch<L>& batch, Index i, Real dt, bool elastic,
                                            const std::vector<Real>& averaged, Particles<D>& particles, Health& health) noexcept
{
  const auto p = static_cast<std::size_t>(batch.begin + i);
  const Mat3 velocity_gradient = embed<D>(particles.L[p]), F_old = particles.F[p];
  const Sym3 stored = particles.stress[p];
  const Real volume_before = particles.volume[p];
  const Mat3 F = F_old + dt * (velocity_gradient * F_old);
  particles.F[p] = F;
  const Real J = F.determinant();
  if (!(J > 0)) {
    health.report(particles.id[p], std::isfinite(J) ? Trouble::inverted : Trouble::not_finite);
    return {};
  }
  particles.volume[p] = J * particles.volume0[p];
  const Real shrinking = std::max(-particles.L[p].trace(), Real{0});

  Mat3 told_F = F, told_L = velocity_gradient, told_stress = unpack(stored);
  if (batch.averages_volume) {
    const Real ratio = std::pow(averaged[p] / J, Real{1} / D), ratio_before = particles.volume_ratio[p];
    particles.volume_ratio[p] = ratio;
    const Real s = ratio / ratio_before;
    told_F = scaled_in_plane<D>(F, ratio);
    told_L = scaled_in_plane<D>(velocity_gradient, s);
    for (int d = 0; d < D; ++d)
      told_L(d, d) += (s - 1) / dt;
  }
  const Real wave_speed = batch.wave_speed(i, told_F);
  Real q = 0;
  if (batch.viscosity) {
    const Real h = mesh.altitude(particles.cell[p]), density = particles.mass[p] / particles.volume[p];
    told_stress.diagonal().array() += particles.viscous[p];
    q = density * h * shrinking * (batch.viscosity->quadratic * h * shrinking + batch.viscosity->linear * wave_speed);
    particles.viscous[p] = q;
  }
  Mat3 after = batch.update(i, Increment{told_F, told_L, told_stress, dt, q, elastic});
  after.diagonal().array() -= q;
  const Sym3 stress = pack(after);
  if (!std::isfinite(stress.sum()))
    health.report(particles.id[p], Trouble::no_answer);
  particles.stress[p] = stress;
  const Mat3 mean = 0.5 * (volume_before * unpack(stored) + particles.volume[p] * after);
  return {dt * mean.cwiseProduct(velocity_gradient).sum(), crossing_time(mesh, batch, particles, p, wave_speed, shrinking)};
}

}  // namespace

template <int D>
StressSums update_stress(const Mesh<D>& mesh, AnyBatch& material, Real dt, bool elastic, const std::vector<Real>& averaged,
                         Particles<D>& particles, Health& health)
{
  return std::visit(
      [&](auto& batch) {
        return parallel_sum<StressSums>(batch.size(),
                                        [&](Index i) { return update_particle(mesh, batch, i, dt, elastic, averaged, particles, health); });
      },
      material);
}

template StressSums update_stress<2>(const Mesh<2>&, AnyBatch&, Real, bool, const std::vector<Real>&, Particles<2>&, Health&);
template StressSums update_stress<3>(const Mesh<3>&, AnyBatch&, Real, bool, const std::vector<Real>&, Particles<3>&, Health&);

}  // namespace talus
