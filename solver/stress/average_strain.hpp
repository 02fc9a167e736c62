#pragma once
// Plastic strain or damage averaged over a length of the material, after which strength softens or ends: see materials/parts/softening_length.hpp
// and materials/johnson_cook.hpp.
#include "core/types.hpp"
#include "materials/interface/material.hpp"
#include "solver/stress/node_patch_sums.hpp"

namespace talus {

/// Bodies of one material whose plastic strain p, or the damage that it does, is averaged as if they were one, and the sums over them.
///
/// The mean m of  m - a^2 lap m = p  is approached in time by
///     m'' + 2 w m' = w^2 (p - m + a^2 lap m),    w = c / a,
/// critically damped, c the speed of sound at rest: news of softening travel as fast as sound, the delay 2 a / c does not depend on the mesh,
/// and no system of equations is solved.  On the linear shape functions of the mesh, with masses as weights, no flux through surfaces:
///     C_v = sum_p m_p N_v,   m_v = sum_p m_p m N_v / C_v,   R_v = sum_p m_p N_v (p - m) - a^2 sum_p m_p (grad m) . grad N_v,
///     m' <- (m' + dt w^2 sum_v N_v R_v / C_v) / (1 + 2 w dt),   m <- m + dt m'
/// at the places of the particles after their move.  As rates are interpolated, nothing is smeared by motion.  C_v is replaced by a multiple of
/// dt^2 c^2 sum_p m_p |grad N_v|^2 where it is smaller, which keeps all modes stable at nodes that see little material (mass scaling) and
/// does not change the mean that is approached.
template <int D>
class AveragedStrain {
 public:
  std::vector<Index> groups;  ///< of particles, see ParticleStrips

  explicit AveragedStrain(const Mesh<D>& mesh) : content_(mesh), flow_(mesh) {}
  AveragedStrain(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& subdomain)
      : content_(ranks, mesh, subdomain), flow_(ranks, mesh, subdomain)
  {}

  /// One step of the means of all particles.  `law` is that of the groups.  Collective.
  void advance(const Mesh<D>& mesh, const ConstitutiveLaw& law, const ParticleStrips<D>& strips, Real dt)
  {
    const StrainAveraging averaging = law.strain_averaging().value();
    const Real speed = law.wave_speed(Mat3::Identity()), frequency = speed / averaging.length;
    sum(mesh, averaging, strips);
    const Real area = averaging.length * averaging.length, scaling = 0.5 * (D + 1) * dt * dt * speed * speed;
    parallel_for_uneven(strips.blocks(), [&](Index block) {
      for_each_cell_of(strips, std::span<const Index>(groups), block, [&](Index c, auto&& runs) {
        std::array<Real, D + 1> change;
        for (std::size_t a = 0; a <= D; ++a) {
          const auto& [mass, mean, missing] = content_[mesh.cell(c)[a]].sum;
          const auto& [flow, stiffness] = flow_[mesh.cell(c)[a]].sum;
          change[a] = mass > 0 ? dt * frequency * frequency * (missing + area * flow) / std::max(mass, scaling * stiffness) : 0;
        }
        runs([&](const ParticlesInCell<D>& run) {
          Real* const mean = run.history.component(averaging.mean);
          Real* const rate = run.history.component(averaging.rate);
          for_each_linear_value(mesh, c, change, run, [&](std::size_t p, Real here) {
            rate[p] = (rate[p] + here) / (1 + 2 * frequency * dt);
            mean[p] += dt * rate[p];
          });
        });
      });
    });
  }

 private:
  void sum(const Mesh<D>& mesh, const StrainAveraging& averaging, const ParticleStrips<D>& strips)
  {
    content_.gather(strips, groups, [&](Index c, const ParticlesInCell<D>& run, auto& corners) {
      const Real* const strain = run.history.component(averaging.strain);
      const Real* const mean = run.history.component(averaging.mean);
      for_each_shape(mesh, c, run, [&](std::size_t p, const Pack& shape) {
        const Pack mass = run.columns.mass.of(p) * shape;
        corners[0] += mass;
        corners[1] += mass * mean[p];
        corners[2] += mass * (std::min(strain[p], averaging.largest) - mean[p]);
      });
    });
    flow_.gather(strips, groups, [&](Index c, const ParticlesInCell<D>& run, auto& corners) {
      const std::optional<Vec<D>> slope = gradient_of_mean(mesh, c, content_);
      if (!slope)
        return;
      Real mass = 0;
      for (std::size_t p = run.begin; p < run.end; ++p)
        mass += run.columns.mass.of(p);
      for (std::size_t a = 0; a <= D; ++a) {
        const Vec<D>& gradient = mesh.gradients(c)[a];
        corners[0][static_cast<int>(a)] -= mass * slope->dot(gradient);
        corners[1][static_cast<int>(a)] += mass * gradient.squaredNorm();
      }
    });
  }

  NodePatchSums<D, 3> content_;  ///< C, sum of m_p m N, sum of m_p N (p - m)
  NodePatchSums<D, 2> flow_;     ///< -sum of m_p (grad m) . grad N, sum of m_p |grad N|^2
};

}  // namespace talus
