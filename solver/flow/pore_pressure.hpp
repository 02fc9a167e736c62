#pragma once
// The pressure of water that flows through pores, at the nodes: found once in each step, together with the velocities that it changes.
#include "solver/boundary/velocity_field.hpp"
#include "solver/flow/flow_cells.hpp"

namespace talus {

/// The times and loads of one step.
template <int D>
struct FlowStep {
  Real end{};                      ///< time of its end [s]
  Real dt{}, kick{};               ///< its length, and the time over which forces act [s]
  Vec<D> weight = Vec<D>::Zero();  ///< of water [N/m^3]
};
/// What it took.
struct FlowSolution {
  int iterations = 0;
  Real residual = 0;  ///< over the right-hand side, in the norm of the preconditioner [-]
};

/// One step of the pore pressure p and of the velocities, of the u-p form for saturated pores [Zienkiewicz & Shiomi 1984]:
///     (n/K) dp/dt + alpha div v = div( k/gamma (grad p - w) ),     rho dv/dt = div(sigma' - alpha p I) + rho g
/// The forces that the velocities v of the nodes have felt are those of the pressure p0 at the beginning of the step.  The pressure p1 at its
/// end, and the velocities v1 that it leaves, are those of
///     S (p1 - p0) + dt (B^T v1 + H p1 - G) = dt Q,      v1 = v + kick M^-1 C B (p1 - p0)
/// on the linear shape functions of the mesh: the fractional step of Chorin [1968] in the form of differences of pressure, which is exact in
/// the sense that v1 has no divergence that the water does not allow, for water of any stiffness.  So waves of the water do not limit the step.
/// B p are the nodal forces of a pressure, C leaves free what boundary conditions allow, H and G are Darcy's law, Q flows in through boundaries.
/// S contains the compressibility of the water and the projection of pressures within cells [Dohrmann & Bochev 2004; Zhao & Choo 2020],
/// scaled by the stiffness of the skeleton: without it pressures alternate from node to node where nothing drains.
///
/// Solved by conjugate gradients, preconditioned by the diagonal.  Rows are summed in a fixed order and dot products are exact over blocks, so
/// that the result does not depend on threads and ranks.
template <int D>
class PorePressure {
 public:
  explicit PorePressure(const Mesh<D>& mesh);
  /// Of one of several ranks.  Collective.
  PorePressure(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& subdomain, const OwnNodes& own);

  /// Sums the particles, solves, changes the velocities, and adds the reactions of boundaries to theirs.  Collective.
  FlowSolution advance(const Mesh<D>& mesh, const Flow& flow, const std::vector<Material>& materials, const ParticleStrips<D>& strips,
                       const OwnNodes& own, Communicator& ranks, const FlowStep<D>& step, BoundaryConditions<D>& conditions,
                       VelocityField<D>& field, FlowLedger& ledger, ExactSums<Real>& work);

  /// The pressure [Pa] of the material that was at x at the beginning of the step, in a cell with particles, and its gradient [Pa/m].
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
  enum class At : std::uint8_t { nothing, unknown, given };
  using NodeVectors = std::vector<Vec<D>>;

  void find_pressures(const Mesh<D>& mesh, const NodesInUse& in_use, const OwnNodes& own);
  void find_rows(const Mesh<D>& mesh, const NodesInUse& in_use, const OwnNodes& own, const FlowStep<D>& step);
  void find_boundaries(const Mesh<D>& mesh, const Flow& flow, const OwnNodes& own, const FlowStep<D>& step);
  void find_responses(const Mesh<D>& mesh, const OwnNodes& own, const FlowStep<D>& step, const BoundaryConditions<D>& conditions,
                      const VelocityField<D>& field);
  /// The force of pressures x on a node of this rank [N].
  Vec<D> force_at(const Mesh<D>& mesh, Index n, const std::vector<Real>& x) const;
  /// All such forces, and the changes of velocity by them.
  void push(const Mesh<D>& mesh, const OwnNodes& own, std::vector<Real>& x, VelocityField<D>& field);
  /// y = (S + dt kick B^T M^-1 C B + dt H) x.
  void multiply(const Mesh<D>& mesh, const OwnNodes& own, Real dt, std::vector<Real>& x, VelocityField<D>& field, std::vector<Real>& y);
  Real dot(Communicator& ranks, const NodesInUse& in_use, const std::vector<Real>& x, const std::vector<Real>& y);
  FlowSolution solve(const Mesh<D>& mesh, const OwnNodes& own, Communicator& ranks, Real dt, VelocityField<D>& field);
  void change_velocities(const Mesh<D>& mesh, const OwnNodes& own, const FlowStep<D>& step, BoundaryConditions<D>& conditions,
                         VelocityField<D>& field, ExactSums<Real>& work);
  void record(const Mesh<D>& mesh, Communicator& ranks, const OwnNodes& own, const FlowStep<D>& step, VelocityField<D>& field,
              FlowLedger& ledger);
  bool is_free(Index n) const noexcept { return at_[static_cast<std::size_t>(n)] == At::unknown; }

  FlowCells<D> cells_;
  HaloExchange copies_;
  std::vector<Real> pressure_;  ///< at the beginning of the step, then at its end
  std::vector<At> at_;
  std::vector<Real> change_, right_, given_;  ///< p1 - p0; the right-hand side; given changes
  std::vector<Real> weight_, inflow_;         ///< dt G and dt Q
  std::vector<Real> squeezed_;                ///< dt B^T v, of the velocities that the step found
  std::vector<Real> residual_, direction_, image_, conditioned_, diagonal_;
  SparseRows<Real> matrix_, darcy_;       ///< S + dt H, and H, by the entries of rings of nodes
  SparseRows<Vec<D>> push_, divergence_;  ///< B, and B^T
  std::vector<Mat<D>> free_;              ///< C
  std::vector<Real> lightness_;           ///< kick / m of nodes with a motion of their own [s/kg], else 0
  NodeVectors force_, velocity_;
};

extern template class PorePressure<2>;
extern template class PorePressure<3>;

}  // namespace talus
