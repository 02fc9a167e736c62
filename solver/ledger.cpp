#include "solver/ledger.hpp"

#include "core/parallel.hpp"

namespace talus {

template <int D>
Totals<D> totals(const Particles<D>& particles)
{
  return parallel_sum<Totals<D>>(particles.size(), [&](Index row) {
    const auto p = static_cast<std::size_t>(row);
    const Real m = particles.mass[p];
    const Vec<D> x = particles.x[p], v = particles.v[p];
    return Totals<D>{m, 0.5 * m * v.squaredNorm(), m * v, m * moment<D>(x, v), m * x};
  });
}

template Totals<2> totals<2>(const Particles<2>&);
template Totals<3> totals<3>(const Particles<3>&);

}  // namespace talus
