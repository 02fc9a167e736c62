#include "solver/statics/elastic_stiffness.hpp"

#include <algorithm>

#include "kernels/node_operators.hpp"
#include "materials/interface/varied_law.hpp"

namespace talus {

/// Of the P-wave modulus: the shear modulus of a law that does not tell it, Poisson's ratio being 0.3, and that of a fluid, which has none.
constexpr Real shear_of_unknown = 2.0 / 7, shear_of_fluid = 1e-3;
/// Lame's first constant over the shear modulus from which on it counts by nodes where volumes are averaged: Poisson's ratio 0.4.  Below,
/// cells do as well and couple fewer nodes.  In 3-D too many are coupled: each with up to 369 by averaged gradients, in the plane with 61.
constexpr Real least_ratio = 4;
/// Of the largest stiffness of a node, that of nodes without a filled cell beside them.
constexpr Real least_stiffness = 0.02;

template <int D>
ElasticStiffness<D>::ElasticStiffness(const Mesh<D>& mesh, const State<D>& state, bool averages_gradients)
    : filled_(to_size(mesh.n_cells()), 0), wave_(filled_), shear_(filled_), averaged_(filled_)
{
  const Particles<D>& particles = state.particles;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    const Material& material = state.materials[b];
    const bool fluid = material.law().description().is_fluid, by_nodes = D == 2 && material.averages_volume;
    for (Index p = state.bodies[b].begin; p < state.bodies[b].end; ++p) {
      const std::size_t i = to_size(p), c = to_size(particles.cell[i]);
      const Real speed = material.wave_speed(p - state.bodies[b].begin, particles.F[i]);
      const Real wave = particles.mass[i] * speed * speed;
      const Real modulus = shear_modulus_of(material, p - state.bodies[b].begin).value_or(shear_of_unknown * wave / particles.volume[i]);
      const Real shear = fluid ? shear_of_fluid * wave : std::min(particles.volume[i] * modulus, wave / 2);
      const Real averaged = by_nodes && wave - 2 * shear > least_ratio * shear ? wave - 2 * shear : 0;
      filled_[c] += particles.volume[i];
      wave_[c] += wave - averaged;
      averaged_[c] += averaged;
      shear_[c] += shear;
    }
  }
  if (averages_gradients && std::ranges::any_of(averaged_, [](Real stiffness) { return stiffness > 0; }))
    gradients_ = averaged_gradients(mesh);
}

template <int D>
Real ElasticStiffness<D>::dilatation_around(const Mesh<D>& mesh, Index v, std::vector<std::pair<Index, Vec<D>>>& derivatives) const
{
  Real volume = 0, stiffness = 0;
  for (const Index c : mesh.cells_of_node()[v])
    volume += filled_[to_size(c)], stiffness += averaged_[to_size(c)] / (D + 1);
  if (!(stiffness > 0))
    return 0;
  /// Adds to the entry of a node.
  const auto add = []<class T>(std::vector<std::pair<Index, T>>& entries, Index n, const T& more) {
    if (const auto at = std::ranges::find(entries, n, &std::pair<Index, T>::first); at != entries.end())
      at->second += more;
    else
      entries.emplace_back(n, more);
  };
  derivatives.clear();
  std::vector<std::pair<Index, Real>> shares;  // of the averages at nodes
  for (const Index c : mesh.cells_of_node()[v])
    for (std::size_t a = 0; a <= D && filled_[to_size(c)] > 0; ++a) {
      const Index n = mesh.cell(c)[a];
      const Real share = filled_[to_size(c)] / volume;
      if (gradients_.empty())
        add(derivatives, n, Vec<D>(share * mesh.gradients(c)[a]));
      else
        add(shares, n, share * (n == v ? 2 : 1) / (D + 2));
    }
  for (const auto& [u, share] : shares) {
    auto entry = to_size(mesh.ring_of_node().begin[to_size(u)]);
    for (const Index n : mesh.ring_of_node()[u])
      add(derivatives, n, Vec<D>(share * gradients_[entry++]));
  }
  return stiffness;
}

template <int D>
auto ElasticStiffness<D>::of_nodes(const Problem<D>& problem, const Unknowns<D>& unknowns) const -> std::vector<OfNode>
{
  const Mesh<D>& mesh = problem.mesh;
  std::vector<Real> diagonal(to_size(mesh.n_nodes()), 0);
  for_each_block(mesh, [&](Index i, Index j, const Mat<D>& block) {
    if (i == j)
      diagonal[to_size(i)] += block.trace() / D;
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
