// The balance of water over a step.
#include "solver/flow/flow_system.hpp"

namespace talus {

namespace {

/// Volumes of water [m^D] and energy [J] over a step.
struct FlowSums {
  Real inflow{}, drained{}, stored{}, squeezed{}, seepage{};
  FlowSums& operator+=(const FlowSums& other) noexcept
  {
    inflow += other.inflow, drained += other.drained, stored += other.stored, squeezed += other.squeezed, seepage += other.seepage;
    return *this;
  }
};

}  // namespace

template <int D>
void FlowSystem<D>::record(const FlowModel<D>& m, const FlowCells<D>& cells, const FlowStep<D>& step, const std::vector<Real>& change,
                           const std::vector<Real>& pressure, FlowLedger& ledger) const
{
  ExactSums<FlowSums> sums;
  add_ranges(m.field.nodes.in_use.own(), sums, [&](Index u) {
    FlowSums one;
    if (!sees_water(u))
      return one;
    Real lifted = 0;  // dt k/gamma w^2
    for (const Index c : m.mesh.cells_of_node()[u])
      lifted += step.dt * cells[c].mobility * step.weight_in(c).squaredNorm() / (D + 1);
    auto k = to_size(m.mesh.ring_of_node().begin[to_size(u)]);
    Real darcy = 0;
    one.squeezed = squeezed_[to_size(u)];
    one.stored = m.flow.any_retention() ? storage_.content(u) - storage_.stored(m.mesh, cells, change, u) : 0;
    for (const Index n : m.mesh.ring_of_node()[u]) {
      one.stored += (matrix_[k] - step.dt * darcy_[k]) * change[to_size(n)];
      one.squeezed += step.dt * divergence_[k].dot(velocity_[to_size(n)]);
      darcy += step.dt * darcy_[k] * pressure[to_size(n)];
      ++k;
    }
    one.inflow = at_[to_size(u)] == NodePressure::given ? 0 : inflow_[to_size(u)];
    const Real needed = one.stored + one.squeezed + darcy - weight_[to_size(u)];  // to flow in at the node
    one.drained = at_[to_size(u)] == NodePressure::given ? -needed : 0;
    one.seepage = pressure[to_size(u)] * (darcy - 2 * weight_[to_size(u)]) + lifted;
    return one;
  });
  m.ranks.sum(sums);
  const FlowSums all = sums.value();
  ledger.inflow += all.inflow, ledger.drained += all.drained, ledger.stored += all.stored;
  ledger.squeezed += all.squeezed, ledger.seepage += all.seepage;
}

template void FlowSystem<2>::record(const FlowModel<2>&, const FlowCells<2>&, const FlowStep<2>&, const std::vector<Real>&,
                                    const std::vector<Real>&, FlowLedger&) const;
template void FlowSystem<3>::record(const FlowModel<3>&, const FlowCells<3>&, const FlowStep<3>&, const std::vector<Real>&,
                                    const std::vector<Real>&, FlowLedger&) const;

}  // namespace talus
