#include "solver/stress/initial_stress.hpp"

#include <fmt/format.h>

#include "core/parallel/threads.hpp"

namespace talus {

namespace {

/// What lies above a particle.
struct Above {
  Real mass = 0;   ///< per area [kg/m^(D-1)]
  Real depth = 0;  ///< way up to where the last cell with mass ends [m]
};

/// A straight way up from a particle, and what is met on it.
template <int D>
struct Ray {
  Vec<D> x;
  Index cell;  ///< or none beyond the boundary
  Above above;
  Real length;  ///< [m]
  Index row;    ///< of the particle, on its rank
  int rank;
};

/// Follows a ray through cells whose density [kg/m^D] is known here, those that `owns`, up to another or to the boundary.
template <int D, class Owns>
void follow(const Mesh<D>& mesh, std::span<const Real> density, const Vec<D>& up, Owns&& owns, Ray<D>& ray) noexcept
{
  for (Index crossed = 0; ray.cell != none && owns(ray.cell); ++crossed) {
    const auto B = mesh.barycentric(ray.cell, ray.x);
    const auto& gradient = mesh.gradients(ray.cell);
    Real way = std::numeric_limits<Real>::infinity();
    std::size_t exit = 0;
    for (std::size_t k = 0; k <= D; ++k) {
      const Real rate = gradient[k].dot(up);
      if (rate < 0 && std::max(B[k], Real{0}) / -rate < way) {
        way = std::max(B[k], Real{0}) / -rate;
        exit = k;
      }
    }
    ray.length += way;
    if (const Real here = density[static_cast<std::size_t>(ray.cell)]; here > 0) {
      ray.above.mass += here * way;
      ray.above.depth = ray.length;
    }
    ray.x += way * up;
    ray.cell = crossed < mesh.n_cells() ? mesh.neighbours(ray.cell)[exit] : none;  // a straight line meets each cell once
  }
}

/// What is above each particle.  Rays that leave the blocks of a rank go on at the next one's.
template <int D>
std::vector<Above> look_up(const Mesh<D>& mesh, const Subdomain& subdomain, Communicator& ranks, std::span<const Real> density,
                           const Vec<D>& up, const Particles<D>& particles)
{
  const auto owns = [&](Index cell) { return subdomain.alone() || subdomain.owns_cell(cell); };
  const auto n_ranks = static_cast<std::size_t>(ranks.size());
  std::vector<Above> above(particles.id.size());
  std::vector<Ray<D>> here;
  for (std::size_t p = 0; p < above.size(); ++p)
    here.push_back({particles.x[p], particles.cell[p], {}, 0, static_cast<Index>(p), ranks.rank()});
  std::vector<std::vector<Ray<D>>> home(n_ranks);
  for (std::int64_t travelling = 1; travelling > 0;) {
    std::vector<std::vector<Ray<D>>> out(n_ranks);
    for (Ray<D>& ray : here) {
      follow(mesh, density, up, owns, ray);
      if (ray.cell == none) {
        home[static_cast<std::size_t>(ray.rank)].push_back(ray);
      } else {
        const int next = subdomain.rank_of_block[static_cast<std::size_t>(ray.cell / block_cells)];
        ray.cell = subdomain.whole_cell(ray.cell);
        out[static_cast<std::size_t>(next)].push_back(ray);
      }
    }
    here.clear();
    for (const std::vector<Ray<D>>& from : exchange_rows(ranks, out))
      here.insert(here.end(), from.begin(), from.end());
    for (Ray<D>& ray : here)
      ray.cell = subdomain.local_cell(ray.cell);
    travelling = ranks.sum(static_cast<std::int64_t>(here.size()));
  }
  for (const std::vector<Ray<D>>& back : exchange_rows(ranks, home))
    for (const Ray<D>& ray : back)
      above[static_cast<std::size_t>(ray.row)] = ray.above;
  return above;
}

/// Pressures that are part of the stress and not of what the law made of it [Pa].
template <int D>
Real beside_law(const Particles<D>& particles, std::size_t p) noexcept
{
  return (particles.viscous.empty() ? 0 : particles.viscous[p]) + (particles.pore.empty() ? 0 : particles.pore[p]);
}

/// What lies above each particle; nothing where none of them asks, or nothing has a weight.
template <int D>
std::vector<Above> weight_above(const Mesh<D>& mesh, const Subdomain& subdomain, Communicator& ranks, const Vec<D>& gravity,
                                std::span<const StartStress> start, const CellOrder& order, const Particles<D>& particles)
{
  const Real g = gravity.norm();
  if (!(g > 0) || std::all_of(start.begin(), start.end(), [](const StartStress& one) { return one.given.has_value(); }))
    return {};
  const Vec<D> up = -gravity / g;
  std::vector<Real> density(static_cast<std::size_t>(mesh.n_cells()), 0.0);
  for (const Index row : order.row) {
    const auto p = static_cast<std::size_t>(row);
    density[static_cast<std::size_t>(particles.cell[p])] += particles.mass[p] / mesh.volume(particles.cell[p]);
  }
  return look_up(mesh, subdomain, ranks, density, up, particles);
}

}  // namespace

template <int D>
void set_start_stress(const Mesh<D>& mesh, const Subdomain& subdomain, Communicator& ranks, const Vec<D>& gravity,
                      std::span<const StartStress> start, const CellOrder& order, const std::vector<Body>& bodies,
                      std::vector<Material>& materials, Particles<D>& particles,
                      const std::type_identity_t<std::function<Real(const Vec<D>&)>>& on_ground)
{
  const Real g = gravity.norm();
  const std::vector<Above> above = weight_above(mesh, subdomain, ranks, gravity, start, order, particles);
  Vec3 up3 = Vec3::Zero();
  if (g > 0)
    up3.head<D>() = -gravity / g;
  const Mat3 along = up3 * up3.transpose();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const auto& [k0, given] = start[b];
    if (!given && !(g > 0))
      continue;
    for (Index row = bodies[b].begin; row < bodies[b].end; ++row) {
      const auto p = static_cast<std::size_t>(row);
      const Real u = particles.pore.empty() ? 0 : particles.pore[p];
      Mat3 stress;
      if (given) {
        stress = *given;
      } else {
        const Real ratio = k0(above[p].depth);
        const Real water = on_ground ? on_ground(particles.x[p] + above[p].depth * up3.head<D>()) : 0;
        stress = (u - g * above[p].mass - water) * (ratio * Mat3::Identity() + (1 - ratio) * along);
      }
      if (!materials[b].prestress(row - bodies[b].begin, stress))
        throw SceneErrors(
            bodies[b].where,
            fmt::format("law \"{}\" of body \"{}\" cannot start from a stress; leave initial_stress out and let the loads grow (ramp)",
                        materials[b].law().name(), bodies[b].name));
      stress.diagonal().array() -= u;
      particles.stress.set(p, pack(stress));
    }
  }
}

template <int D>
void start_from_stress(const Body& body, Material& material, Particles<D>& particles)
{
  parallel_for(body.size(), [&](Index i) {
    const auto p = static_cast<std::size_t>(body.begin + i);
    Mat3 stress = unpack(Sym3(particles.stress[p]));
    stress.diagonal().array() += beside_law(particles, p);
    material.prestress(i, stress);
    particles.F.set(p, Mat3::Identity());
    particles.volume0.set(p, particles.volume[p]);
    if (!particles.volume_ratio.empty())
      particles.volume_ratio.set(p, 1);
  });
}

template <int D>
StressFit fit_stress(const Body& body, const Material& material, Real dt, bool take_over, Particles<D>& particles)
{
  const ConstitutiveLaw& law = material.law();
  // A law that starts from a stress moves on by dt L, another finds its stress from F and the rate of that step.
  const bool moves_on = law.description().starts_from_stress;
  const auto width = static_cast<std::size_t>(law.description().history_width);
  return parallel_sum<StressFit>(body.size(), [&](Index i) {
    const auto p = static_cast<std::size_t>(body.begin + i);
    const Sym3 before = particles.stress[p];
    Mat3 F = particles.F[p], L_there = Mat3::Zero(), stress = unpack(before);
    if (material.averages_volume && !particles.volume_ratio.empty())
      F.topLeftCorner<D, D>() *= particles.volume_ratio[p];
    L_there.topLeftCorner<D, D>() = particles.L[p];
    const Real q = particles.viscous.empty() ? 0 : particles.viscous[p], others = beside_law(particles, p);
    stress.diagonal().array() += others;
    std::vector<Real> history(material.history.row(i), material.history.row(i) + width);
    Mat3 answer = law.update(Increment{F, L_there, stress, moves_on ? 0 : dt, q, moves_on}, history.data());
    answer.diagonal().array() -= others;
    if (const Sym3 after = pack(answer); take_over && after.allFinite())
      particles.stress.set(p, after);
    return StressFit{unpack(before).norm(), (answer - unpack(before)).norm()};
  });
}

template void start_from_stress<2>(const Body&, Material&, Particles<2>&);
template void start_from_stress<3>(const Body&, Material&, Particles<3>&);
template StressFit fit_stress<2>(const Body&, const Material&, Real, bool, Particles<2>&);
template StressFit fit_stress<3>(const Body&, const Material&, Real, bool, Particles<3>&);
template void set_start_stress<2>(const Mesh<2>&, const Subdomain&, Communicator&, const Vec<2>&, std::span<const StartStress>,
                                  const CellOrder&, const std::vector<Body>&, std::vector<Material>&, Particles<2>&,
                                  const std::function<Real(const Vec<2>&)>&);
template void set_start_stress<3>(const Mesh<3>&, const Subdomain&, Communicator&, const Vec<3>&, std::span<const StartStress>,
                                  const CellOrder&, const std::vector<Body>&, std::vector<Material>&, Particles<3>&,
                                  const std::function<Real(const Vec<3>&)>&);

}  // namespace talus
