#pragma once
// Small models made in memory, without files: shared by the solver's tests.
#include <functional>

#include "kernels/kernels.hpp"
#include "materials/interface/constitutive_law_of.hpp"
#include "materials/laws.hpp"
#include "mesh/generate/generate.hpp"
#include "mesh/quadrature.hpp"
#include "solver/advance.hpp"
#include "solver/stable_step.hpp"
#include "solver/stages.hpp"
#include "solver/stress/average_volume.hpp"
#include "solver/transfer/transfer_of.hpp"

namespace talus::testing {

/// Fills the cells whose centroid `inside` accepts with `per_cell` particles of `law`, as one more body of the model.
template <int D, class L>
void add_body(
    Model<D>& m, const std::string& name, const L& law, int per_cell, const std::function<bool(const Vec<D>&)>& inside,
    const std::function<Vec<D>(const Vec<D>&)>& velocity = [](const Vec<D>&) { return Vec<D>(Vec<D>::Zero()); })
{
  auto& p = m.state.particles;
  const Index begin = p.size();
  const auto points = seeding_points<D>(per_cell).value();
  for (Index c = 0; c < m.problem.mesh.n_cells(); ++c) {
    Vec<D> centre = Vec<D>::Zero();
    for (const Index n : m.problem.mesh.cell(c))
      centre += m.problem.mesh.node(n) / (D + 1);
    if (!inside(centre))
      continue;
    for (const auto& B : points) {
      Vec<D> x = Vec<D>::Zero();
      for (std::size_t k = 0; k <= D; ++k)
        x += B[k] * m.problem.mesh.node(m.problem.mesh.cell(c)[k]);
      p.id.push_back(p.size());
      p.cell.push_back(c);
      p.x.push_back(x);
      p.v.push_back(velocity(x));
      p.L.push_back(Mat<D>::Zero());
      p.F.push_back(Mat3::Identity());
      p.stress.push_back(Sym3::Zero());
      const Real volume = m.problem.mesh.volume(c) / per_cell;
      p.volume0.push_back(volume);
      p.mass.push_back(law.density * volume);
    }
  }
  m.state.bodies.push_back({name, begin, p.size(), {}});
  m.state.materials.push_back(make_material(law, begin, p.size(), name));
}

/// The transfer of a model whose kernel is known.
template <class K, int D>
TransferOf<D, K>& transfer_of(Model<D>& m)
{
  return dynamic_cast<TransferOf<D, K>&>(*m.transfer);
}

/// Calls f(columns, number of particles) for every strip.
template <int D, class F>
void for_each_strip(const ParticleStrips<D>& strips, F&& f)
{
  for (std::size_t key = 0; key < strips.keys(); ++key)
    for (const Strip& strip : strips.strips(key))
      f(strips.columns(strip), static_cast<std::size_t>(strip.n));
}

/// Adds mass, momentum and force of the particles, which are in columns, to the nodes.
template <int D>
void sum_on_nodes(Model<D>& m)
{
  begin_sweeps(m);
  m.work.strips->send_leavers(m.problem.subdomain, m.work.migration);
  m.transfer->particles_to_nodes(m);
  m.transfer->assemble_nodes(m);
  end_sweeps(m);
}

/// Velocity, velocity gradient and position of the particles from the motion of the nodes, without MUSL; stress and deformation stay.
template <int D>
void read_nodes(Model<D>& m, Real dt)
{
  m.problem.transfer.musl = false;
  const auto stress = m.state.particles.stress;
  const auto F = m.state.particles.F;
  begin_sweeps(m);
  m.work.stress_sums.assign(m.work.strips->keys(), {});
  m.transfer->nodes_to_particles(m, Kick{}, dt, {});
  end_sweeps(m);
  m.state.particles.stress = stress, m.state.particles.F = F;
}

/// Deformation and stress of all particles from their velocity gradients, without averaged volumes; the sums over blocks are in
/// work.stress_sums.
template <class K, int D>
void update_all_stress(Model<D>& m, Real dt)
{
  begin_sweeps(m);
  m.work.stress_sums.assign(m.work.strips->keys(), {});
  for (Index block = 0; block < m.work.strips->blocks(); ++block)
    BlockSweep<D, K>(m, transfer_of<K>(m).fields(), block).advance({.updates = true}, dt, 0);
  end_sweeps(m);
}

/// Every row of a column, f(row) -> its value, in order.
template <class Column, class F>
void set_each(Column& column, F&& f)
{
  for (std::size_t p = 0; p < column.size(); ++p)
    column.set(p, f(p));
}

/// Seeds the affine field too, so that a rigid or linear motion starts exact.
template <int D>
void set_velocity(Model<D>& m, const Mat<D>& A, const Vec<D>& b)
{
  for (std::size_t p = 0; p < m.state.particles.id.size(); ++p) {
    m.state.particles.v.set(p, A * m.state.particles.x[p] + b);
    m.state.particles.L.set(p, A);
    if (!m.state.particles.C.empty())
      m.state.particles.C.set(p, A);
  }
}

inline Stage test_stage(Real duration)
{
  Stage stage;
  stage.name = "test";
  stage.duration = duration;
  return stage;
}

/// Steps of the stable size until `end`.
template <int D>
void run_until(Model<D>& m, Real end, Real cfl = 0.4)
{
  run_stage(m, test_stage(end - m.state.clock.time), StepLimits{.cfl = cfl}, [](const auto&, RunEvent) {});
}

/// A condition on the facets of a set of the mesh, such as "y_min".
template <int D>
void close_off(Model<D>& m, const std::string& facets, const AnyCondition<D>& kind)
{
  m.state.boundary.add({.name = facets, .kind = kind}, m.problem.mesh, *m.problem.mesh.facet_set(facets));
}

inline NeoHookean rubber(Real youngs_modulus, Real poisson_ratio, Real density)
{
  NeoHookean law;
  law.youngs_modulus = youngs_modulus;
  law.poisson_ratio = poisson_ratio;
  law.density = density;
  return law;
}

template <int D>
Mesh<D> unit_box(Index cells, Real jitter, std::uint64_t seed = 1)
{
  std::array<Index, D> n;
  n.fill(cells);
  return Mesh<D>(jittered(box<D>(Vec<D>::Zero(), Vec<D>::Ones(), n), jitter, seed));
}

}  // namespace talus::testing
