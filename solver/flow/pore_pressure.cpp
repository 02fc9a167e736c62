#include "solver/flow/pore_pressure.hpp"

#include "solver/flow/flow_system.hpp"

namespace talus {

template <int D>
PorePressure<D>::PorePressure(const Mesh<D>& mesh)
    : pressure_(to_size(mesh.n_nodes())),
      trial_(pressure_.size()),
      last_(pressure_.size()),
      seen_(pressure_.size()),
      cells_(mesh),
      system_(std::make_unique<FlowSystem<D>>(mesh))
{}

template <int D>
PorePressure<D>::PorePressure(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& subdomain, const OwnNodes& own)
    : pressure_(to_size(mesh.n_nodes())),
      trial_(pressure_.size()),
      last_(pressure_.size()),
      seen_(pressure_.size()),
      cells_(ranks, mesh, subdomain),
      system_(std::make_unique<FlowSystem<D>>(ranks, mesh, subdomain, own))
{}

template <int D>
PorePressure<D>::PorePressure(PorePressure&&) noexcept = default;
template <int D>
PorePressure<D>& PorePressure<D>::operator=(PorePressure&&) noexcept = default;
template <int D>
PorePressure<D>::~PorePressure() = default;

/// The mean of what the particles around say of the pressure at each node, which is exact for linear pressures.
template <int D>
void PorePressure<D>::read_particles(const Mesh<D>& mesh, const OwnNodes& own, const NodesInUse& in_use)
{
  in_use.for_each([&](Index n) {
    Real weight = 0, sum = 0;
    if (own.has(n))
      for (const Index c : mesh.cells_of_node()[n]) {
        const auto a = static_cast<std::size_t>(std::ranges::find(mesh.cell(c), n) - mesh.cell(c).begin());
        weight += cells_[c].weight[a], sum += cells_[c].pressure[a];
      }
    seen_[to_size(n)] = weight > 0 ? 1 : 0;
    pressure_[to_size(n)] = weight > 0 ? sum / weight : 0;
  });
}

template <int D>
void PorePressure<D>::advance(const FlowModel<D>& m, const std::vector<Material>& materials, const ParticleStrips<D>& strips,
                              const FlowStep<D>& step, FlowLedger& ledger, ExactSums<Real>& work)
{
  const NodesInUse& in_use = m.field.nodes.in_use;
  cells_.sum(m.mesh, m.flow, materials, strips, m.flow.pace(step.end));
  read_particles(m.mesh, m.own, in_use);
  system_->send(pressure_);
  system_->send(seen_);
  const bool retains = m.flow.any_retention();
  if (retains) {
    cells_.find_contents(m.mesh, m.flow, strips, pressure_, pressure_);
    in_use.for_each([&](Index n) { last_[to_size(n)] = pressure_[to_size(n)]; });
  }
  system_->prepare(m, cells_, step, pressure_);
  std::vector<Real>& change = system_->solve(m, step, ledger);
  if (retains)
    system_->solve_for_contents(m, step, ledger, [&]() -> const FlowCells<D>& {
      in_use.for_each([&](Index n) { trial_[to_size(n)] = pressure_[to_size(n)] + change[to_size(n)]; });
      cells_.find_contents(m.mesh, m.flow, strips, trial_, last_);
      in_use.for_each([&](Index n) { last_[to_size(n)] = trial_[to_size(n)]; });
      return cells_;
    });
  system_->change_velocities(m, step, change, work);
  in_use.for_each([&](Index n) { pressure_[to_size(n)] += change[to_size(n)]; });
  system_->send(pressure_);
  system_->record(m, cells_, step, change, pressure_, ledger);
  ledger.begun = true;
}

template <int D>
void PorePressure<D>::begin_stage()
{
  std::ranges::fill(seen_, std::uint8_t{0});
  system_->begin_stage();
}

template class PorePressure<2>;
template class PorePressure<3>;

}  // namespace talus
