#pragma once
// The pressure of water that flows through pores, at the nodes.
#include <memory>

#include "solver/boundary/velocity_field.hpp"
#include "solver/flow/flow_cells.hpp"

namespace talus {

/// The times and loads of one step.
template <int D>
struct FlowStep {
  Real end{};                      ///< time of its end [s]
  Real dt{}, kick{};               ///< its length, and the time over which forces act [s]
  Vec<D> weight = Vec<D>::Zero();  ///< of water, as gravity acts on it [N/m^3]
  std::vector<Vec<D>> forces{};    ///< of place, on the water in each cell [N/m^3]; empty where a scene has none

  /// What acts on the water in a cell [N/m^3].
  Vec<D> weight_in(Index cell) const noexcept { return forces.empty() ? weight : Vec<D>(weight + forces[static_cast<std::size_t>(cell)]); }
};
/// What a step needs of the run.
template <int D>
struct FlowModel {
  const Mesh<D>& mesh;
  const Flow& flow;
  const OwnNodes& own;
  Communicator& ranks;
  BoundaryConditions<D>& conditions;
  VelocityField<D>& field;
};

template <int D>
class FlowSystem;

/// The pressures at the nodes, which FlowSystem finds once in each step.
template <int D>
class PorePressure {
 public:
  explicit PorePressure(const Mesh<D>& mesh);
  /// Of one of several ranks.  Collective.
  PorePressure(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& subdomain, const OwnNodes& own);
  PorePressure(PorePressure&&) noexcept;
  PorePressure& operator=(PorePressure&&) noexcept;
  ~PorePressure();

  /// Finds the pressures at the end of a step from those of the particles, and changes the velocities of the nodes accordingly; adds the
  /// reactions of boundaries to theirs, the water to its balance and the work on the nodes [J] to `work`.  Collective.
  void advance(const FlowModel<D>& m, const std::vector<Material>& materials, const ParticleStrips<D>& strips, const FlowStep<D>& step,
               FlowLedger& ledger, ExactSums<Real>& work);

  /// Forgets what stages before have left at nodes that are not in use any more.
  void begin_stage();

  /// Whether all vertices of a cell have seen water; not so in a cell that its first particles have just entered.
  bool knows(const Mesh<D>& mesh, Index cell) const noexcept
  {
    return std::ranges::all_of(mesh.cell(cell), [&](Index n) { return seen_[static_cast<std::size_t>(n)] != 0; });
  }
  /// The pressure [Pa] of the material that was at x at the beginning of the step, in a cell that is known, and its gradient [Pa/m].
  Real at(const Mesh<D>& mesh, Index cell, const Vec<D>& x) const noexcept
  {
    const auto shape = mesh.barycentric(cell, x);
    Real p = 0;
    for (std::size_t a = 0; a <= D; ++a)
      p += shape[a] * pressure_[static_cast<std::size_t>(mesh.cell(cell)[a])];
    return p;
  }
  Vec<D> gradient(const Mesh<D>& mesh, Index cell) const noexcept
  {
    Vec<D> slope = Vec<D>::Zero();
    for (std::size_t a = 0; a <= D; ++a)
      slope += pressure_[static_cast<std::size_t>(mesh.cell(cell)[a])] * mesh.gradients(cell)[a];
    return slope;
  }

 private:
  void read_particles(const Mesh<D>& mesh, const OwnNodes& own, const NodesInUse& in_use);

  std::vector<Real> pressure_, trial_, last_;  ///< [Pa]; trial_: while pores that drain are found; last_: those before
  std::vector<std::uint8_t> seen_;             ///< nodes of cells with water
  FlowCells<D> cells_;
  std::unique_ptr<FlowSystem<D>> system_;
};

extern template class PorePressure<2>;
extern template class PorePressure<3>;

}  // namespace talus
