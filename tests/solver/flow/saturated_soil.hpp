#pragma once
// Boxes of saturated soil.
#include <gtest/gtest.h>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::saturated_soil {

using testing::add_body;
using testing::rubber;
using testing::unit_box;

inline constexpr Real weight = 1e4;  // of water [N/m^3]

/// A box of saturated soil.
template <int D, class K = Projected<D>>
Model<D> saturated(
    Mesh<D> mesh, const FlowOfBody& pores, const std::function<bool(const Vec<D>&)>& inside,
    const std::function<Vec<D>(const Vec<D>&)>& velocity = [](const Vec<D>&) { return Vec<D>(Vec<D>::Zero()); })
{
  auto m = make_model<K>(std::move(mesh));
  add_body<D>(m, "soil", rubber(1e6, 0.2, 2000), D + 1, inside, velocity);
  m.problem.water = {
      .table = std::vector<Real>(static_cast<std::size_t>(m.problem.mesh.n_nodes()), -1), .drained = {1}, .unit_weight = weight};
  m.problem.flow.bodies = {pores}, m.problem.flow.surface_drains = false, m.problem.flow.unit_weight = weight;
  return m;
}
template <int D>
bool everywhere(const Vec<D>&)
{
  return true;
}
inline FlowOfBody pores(Real permeability, Real bulk_modulus)
{
  return {.flows = true, .porosity = 0.4, .permeability = permeability, .bulk_modulus = bulk_modulus, .retention = {}};
}
template <int D>
std::vector<Index> nodes_on(const Mesh<D>& mesh, const std::string& facets)
{
  std::vector<Index> nodes;
  const std::vector<Facet> all = mesh.facet_set(facets).value();
  for (const Facet facet : all)
    for (const Index n : mesh.nodes_of(facet))
      nodes.push_back(n);
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}
/// Holds all nodes, so that only water moves.
template <int D>
void hold_everything(Model<D>& m)
{
  std::vector<Index> all(static_cast<std::size_t>(m.problem.mesh.n_nodes()));
  std::iota(all.begin(), all.end(), 0);
  m.state.boundary.add({.name = "all", .kind = Fixed<D>{}}, m.problem.mesh, all);
}
/// Makes the model ready, with this pressure and gradient of its water.
template <int D>
void begin(Model<D>& m, auto&& pressure, const Vec<D>& gradient)
{
  m.state.boundary.finalize();
  make_ready(m);
  m.state.stage.flows = true;
  auto& particles = m.state.particles;
  for (std::size_t p = 0; p < particles.id.size(); ++p) {
    particles.pore.set(p, pressure(particles.x[p])), particles.water.set(p, particles.pore[p]);
    particles.stress.set(p, add_diagonal(particles.stress[p], -particles.pore[p]));
    particles.water_gradient.set(p, gradient);
  }
}
template <int D>
void make_steps(Model<D>& m, int n, Real dt)
{
  for (int i = 0; i < n; ++i)
    make_step(m, dt);
  end_sweeps(m);
  EXPECT_LE(m.state.flow.residual, FlowLedger::tolerance);
}
template <int D>
Real rms(const Model<D>& m, auto&& exact)
{
  Real sum = 0;
  const auto& particles = m.state.particles;
  for (std::size_t p = 0; p < particles.id.size(); ++p)
    sum += std::pow(particles.water[p] - exact(particles.x[p]), 2);
  return std::sqrt(sum / static_cast<Real>(particles.id.size()));
}

}  // namespace talus::saturated_soil
