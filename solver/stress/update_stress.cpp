#include "solver/stress/update_stress.hpp"

#include <chrono>

namespace talus {

namespace {

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
SimdReal stress_power(const Sym3Of<SimdReal>& a, const Eigen::Matrix<SimdReal, D, D, Eigen::DontAlign>& L) noexcept
{
  SimdReal power = a[0] * L(0, 0) + a[1] * L(1, 1) + a[3] * (L(0, 1) + L(1, 0));
  if constexpr (D == 3)
    power += a[2] * L(2, 2) + a[4] * (L(1, 2) + L(2, 1)) + a[5] * (L(0, 2) + L(2, 0));
  return power;
}

template <int D, class L, class S>
[[gnu::flatten]] void update_bunch(const Mesh<D>& mesh, Batch<L>& batch, const ParticlePackOf<S>& pack, Real dt, bool elastic,
                                   const std::vector<Real>& averaged, const std::optional<PoreWater>& pore, Particles<D>& particles,
                                   ParticleErrors& health, StressLanes& sums) noexcept
{
  const auto rate = pack.load(particles.L);
  const Mat3Of<SimdReal> velocity_gradient = embed(rate);
  Mat3Of<SimdReal> F = pack.load(particles.F);
  F.template topLeftCorner<D, D>() += SimdReal(dt) * (rate * F.template topLeftCorner<D, D>());
  pack.store(F, particles.F);
  const SimdReal J = F.determinant();
  const auto good = J > 0;  // false for NaN
  if (!all_of(good))
    for (int lane = 0; lane < pack.count; ++lane)
      if (!good[lane])
        health.report(particles.id[pack.p[lane]], std::isfinite(J[lane]) ? Trouble::inverted : Trouble::not_finite);
  const SimdReal volume_before = pack.load(particles.volume), volume = J * pack.load(particles.volume0);
  pack.store(volume, particles.volume);
  const SimdReal shrinking = max(-SimdReal(rate.trace()), 0);
  const SimdReal h = pack.lanes([&](std::size_t p) { return mesh.altitude(particles.cell[p]); });

  const Sym3Of<SimdReal> stored = pack.load(particles.stress);
  Mat3Of<SimdReal> told_F = F, told_L = velocity_gradient, told_stress = unpack(stored);
  if (batch.averages_volume) {
    const SimdReal to_average = pack.load(averaged) / J, ratio = D == 2 ? sqrt(to_average) : pow(to_average, Real{1} / D);
    const SimdReal s = ratio / pack.load(particles.volume_ratio);
    pack.store(ratio, particles.volume_ratio);
    told_F = scaled_in_plane<D>(F, ratio);
    told_L = scaled_in_plane<D>(velocity_gradient, s);
    for (int d = 0; d < D; ++d)
      told_L(d, d) += (s - 1) / dt;
  }
  Index i[pack_size];
  for (int lane = 0; lane < pack_size; ++lane)
    i[lane] = static_cast<Index>(pack.p[lane]) - batch.begin;
  const SimdReal wave_speed = batch.wave_speed(i, pack.count, told_F);
  SimdReal q = 0;
  if (batch.viscosity) {
    told_stress.diagonal().array() += pack.load(particles.viscous);
    q = pack.load(particles.mass) / volume * h * shrinking *
        (batch.viscosity->quadratic * h * shrinking + batch.viscosity->linear * wave_speed);
    pack.store(q, particles.viscous);
  }
  SimdReal u = 0;
  if (pore) {
    told_stress.diagonal().array() += pack.load(particles.pore);
    u = pack.lanes([&](std::size_t p) { return pore->pressure(mesh, particles.cell[p], particles.x[p]); });
    pack.store(u, particles.pore);
  }
  Mat3Of<SimdReal> after = batch.update(i, pack.count, {told_F, told_L, told_stress, dt, q, elastic});
  after.diagonal().array() -= q + u;
  const Sym3Of<SimdReal> stress = talus::pack(after);
  const auto answered = isfinite(SimdReal(stress.sum()));
  if (!all_of(answered))
    for (int lane = 0; lane < pack.count; ++lane)
      if (good[lane] && !answered[lane])
        health.report(particles.id[pack.p[lane]], Trouble::no_answer);
  pack.store(stress, particles.stress);

  const SimdReal work = 0.5 * dt * (volume_before * stress_power<D>(stored, rate) + volume * stress_power<D>(stress, rate));
  const SimdReal speed = sqrt(SimdReal(pack.load(particles.v).squaredNorm()));
  const SimdReal crossing = crossing_time<D>(batch, h, speed, wave_speed, shrinking);
  const auto sound = good && answered, counts = sound && SimdReal(Pack{0, 1, 2, 3}) < static_cast<Real>(pack.count);
  sums.work += where(counts, work, 0);  // lanes that repeat a particle change no extreme
  sums.crossing = where(sound, min(sums.crossing, crossing), sums.crossing);
  sums.speed = where(sound, max(sums.speed, speed), sums.speed);
}

}  // namespace

template <int D>
StressSums update_stress(const Mesh<D>& mesh, AnyBatch& material, std::span<const Index> rows, Real dt, bool elastic,
                         const std::vector<Real>& averaged, const std::optional<PoreWater>& pore, Particles<D>& particles,
                         ParticleErrors& health)
{
  const auto begin = std::chrono::steady_clock::now();
  StressLanes lanes;
  std::visit(
      [&](auto& batch) {
        in_numbers_of(particles, [&]<class S>(S) {
          for_each_bunch<S>(
              rows,
              [&](const ParticlePackOf<S>& pack) {
                update_bunch(mesh, batch, pack, dt, elastic, averaged, pore, particles, health, lanes);
              },
              [&](std::size_t p) {
                Prefetch<S>::row(p, particles.F, particles.stress, particles.volume, particles.volume0, particles.mass);
              });
        });
      },
      material);
  StressSums sums = lanes.total();
  sums.seconds = std::chrono::duration<Real>(std::chrono::steady_clock::now() - begin).count();
  return sums;
}

template StressSums update_stress<2>(const Mesh<2>&, AnyBatch&, std::span<const Index>, Real, bool, const std::vector<Real>&,
                                     const std::optional<PoreWater>&, Particles<2>&, ParticleErrors&);
template StressSums update_stress<3>(const Mesh<3>&, AnyBatch&, std::span<const Index>, Real, bool, const std::vector<Real>&,
                                     const std::optional<PoreWater>&, Particles<3>&, ParticleErrors&);

}  // namespace talus
