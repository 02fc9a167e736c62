#include "solver/ledger.hpp"

#include "core/parallel.hpp"

namespace talus {

template <int D>
Totals<D> totals(const Particles<D>& particles)
{
  return parallel_sum<Totals<D>>(particles.size(), [&](Index row) {
    const auto p = static_cast<std::size_t>(row);
    const Real m = particles.mass[p];
    Vec3 x = Vec3::Zero(), v = Vec3::Zero();
    for (int d = 0; d < D; ++d) {
      x[d] = particles.x[p][d];
      v[d] = particles.v[p][d];
    }
    const Vec3 spin(x[1] * v[2] - x[2] * v[1], x[2] * v[0] - x[0] * v[2], x[0] * v[1] - x[1] * v[0]);
    return Totals<D>{m, 0.5 * m * particles.v[p].squaredNorm(), m * particles.v[p], m * spin, m * particles.x[p]};
  });
}

template Totals<2> totals<2>(const Particles<2>&);
template Totals<3> totals<3>(const Particles<3>&);

}  // namespace talus
