#include "solver/initial_stress.hpp"

#include <fmt/format.h>

#include "core/parallel.hpp"

namespace talus {

template <int D>
Real mass_above(const Mesh<D>& mesh, std::span<const Real> density, Vec<D> x, Index c, const Vec<D>& up) noexcept
{
  Real mass = 0;
  for (Index crossed = 0; c != none && crossed <= mesh.n_cells(); ++crossed) {  // a straight line meets each cell once
    const auto B = mesh.barycentric(c, x);
    const auto& gradient = mesh.gradients(c);
    Real way = std::numeric_limits<Real>::infinity();
    std::size_t exit = 0;
    for (std::size_t k = 0; k <= D; ++k) {
      const Real rate = gradient[k].dot(up);
      if (rate < 0 && std::max(B[k], Real{0}) / -rate < way) {
        way = std::max(B[k], Real{0}) / -rate;
        exit = k;
      }
    }
    mass += density[static_cast<std::size_t>(c)] * way;
    x += way * up;
    c = mesh.neighbours(c)[exit];
  }
  return mass;
}

template <int D>
void set_k0_stress(const Mesh<D>& mesh, const Vec<D>& gravity, Real k0, const std::vector<Body>& bodies, std::vector<AnyBatch>& materials,
                   Particles<D>& particles)
{
  const Real g = gravity.norm();
  if (!(g > 0))
    return;
  const Vec<D> up = -gravity / g;
  std::vector<Real> density(static_cast<std::size_t>(mesh.n_cells()), 0.0);
  for (std::size_t p = 0; p < particles.id.size(); ++p)
    density[static_cast<std::size_t>(particles.cell[p])] += particles.mass[p] / mesh.volume(particles.cell[p]);

  Vec3 up3 = Vec3::Zero();
  up3.head<D>() = up;
  const Mat3 shape = k0 * Mat3::Identity() + (1 - k0) * up3 * up3.transpose();
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (Index row = bodies[b].begin; row < bodies[b].end; ++row) {
      const auto p = static_cast<std::size_t>(row);
      const Mat3 stress = -g * mass_above(mesh, density, particles.x[p], particles.cell[p], up) * shape;
      if (!prestress(materials[b], row - bodies[b].begin, stress))
        throw SceneErrors(
            bodies[b].where,
            fmt::format("law \"{}\" of body \"{}\" cannot start from a K0 stress; leave initial_stress out and let gravity grow (ramp)",
                        law_name(materials[b]), bodies[b].name));
      particles.stress.set(p, pack(stress));
    }
}

template Real mass_above<2>(const Mesh<2>&, std::span<const Real>, Vec<2>, Index, const Vec<2>&) noexcept;
template Real mass_above<3>(const Mesh<3>&, std::span<const Real>, Vec<3>, Index, const Vec<3>&) noexcept;
template void set_k0_stress<2>(const Mesh<2>&, const Vec<2>&, Real, const std::vector<Body>&, std::vector<AnyBatch>&, Particles<2>&);
template void set_k0_stress<3>(const Mesh<3>&, const Vec<3>&, Real, const std::vector<Body>&, std::vector<AnyBatch>&, Particles<3>&);

}  // namespace talus
