#include "solver/statics/elastic_stiffness.hpp"

#include <algorithm>

#include "materials/interface/varied_law.hpp"

namespace talus {

/// Of the P-wave modulus: the shear modulus of a law that does not tell it, Poisson's ratio being 0.3, and that of a fluid, which has none.
constexpr Real shear_of_unknown = 2.0 / 7, shear_of_fluid = 1e-3;
/// Of the largest stiffness of a node, that of nodes without a filled cell beside them.
constexpr Real least_stiffness = 0.02;

template <int D>
ElasticStiffness<D>::ElasticStiffness(const Mesh<D>& mesh, const State<D>& state)
    : filled_(to_size(mesh.n_cells()), 0), wave_(filled_), shear_(filled_)
{
  const Particles<D>& particles = state.particles;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    const Material& material = state.materials[b];
    const bool fluid = material.law().description().is_fluid;
    for (Index p = state.bodies[b].begin; p < state.bodies[b].end; ++p) {
      const std::size_t i = to_size(p), c = to_size(particles.cell[i]);
      const Real speed = material.wave_speed(p - state.bodies[b].begin, particles.F[i]);
      const Real wave = particles.mass[i] * speed * speed;
      const Real modulus = shear_modulus_of(material, p - state.bodies[b].begin).value_or(shear_of_unknown * wave / particles.volume[i]);
      filled_[c] += particles.volume[i];
      wave_[c] += wave;
      shear_[c] += fluid ? shear_of_fluid * wave : std::min(particles.volume[i] * modulus, wave / 2);
    }
  }
}

template <int D>
auto ElasticStiffness<D>::of_nodes(const Problem<D>& problem, const Unknowns<D>& unknowns) const -> std::vector<OfNode>
{
  const Mesh<D>& mesh = problem.mesh;
  std::vector<Real> diagonal(to_size(mesh.n_nodes()), 0);
  for_each_block(mesh, [&](Index c, std::size_t a, std::size_t b, const Mat<D>& block) {
    if (a == b)
      diagonal[to_size(mesh.cell(c)[a])] += block.trace() / D;
  });
  const Real largest = problem.ranks->max(diagonal.empty() ? 0 : *std::ranges::max_element(diagonal));  // a rank may have no cells
  std::vector<OfNode> all;
  for (const Index n : unknowns.node) {
    const Real stiffness = std::max(diagonal[to_size(n)], least_stiffness * largest);
    all.push_back({stiffness, diagonal[to_size(n)] > 0 ? 0 : stiffness});
  }
  return all;
}

template class ElasticStiffness<2>;
template class ElasticStiffness<3>;

}  // namespace talus
