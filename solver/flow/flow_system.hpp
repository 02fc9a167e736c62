#pragma once
// The linear system of the pore pressure in one step.
#include <functional>

#include "solver/flow/coarse_pressure.hpp"
#include "solver/flow/pore_pressure.hpp"
#include "solver/flow/pore_storage.hpp"
#include "solver/flow/rain.hpp"

namespace talus {

/// One step of the pore pressure p and of the velocities, of the u-p form for saturated pores [Zienkiewicz & Shiomi 1984]:
///     (n/K) dp/dt + alpha div v = div( k/gamma (grad p - w) ),     rho dv/dt = div(sigma' - alpha p I) + rho g
/// The forces that the velocities v of the nodes have felt are those of the pressure p0 at the beginning of the step.  The pressure p1 at its
/// end, and the velocities v1 that it leaves, are those of
///     S (p1 - p0) + dt (B^T v1 + H p1 - G) = dt Q,      v1 = v + kick M^-1 C B (p1 - p0)
/// on the linear shape functions of the mesh: the fractional step of Chorin [1968] in the form of changes of pressure, with the operator
/// B^T M^-1 C B in the place of a Laplacian.  So v1 has exactly the divergence that the water allows, whatever its stiffness, and waves of the
/// water do not limit the step.  B p are the nodal forces of a pressure, C leaves free what boundary conditions do, H and G are Darcy's law, Q
/// flows in through boundaries.  S contains the compressibility of the water and the projection of pressures within cells [Dohrmann & Bochev
/// 2004; Zhao & Choo 2020], scaled by the stiffness of the skeleton: without it pressures alternate from node to node where nothing drains.
///
/// Solved by conjugate gradients.  Rows are summed in a fixed order and dot products are exact over blocks, so that the result does not depend
/// on threads and ranks.
template <int D>
class FlowSystem {
 public:
  explicit FlowSystem(const Mesh<D>& mesh);
  /// Of one of several ranks.  Collective.
  FlowSystem(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& subdomain, const OwnNodes& own);

  /// Forgets what stages before have left at nodes that are not in use any more.
  void begin_stage();
  /// Finds rows, given pressures and how velocities answer, for the pressures p0 at nodes that see water.  Collective.
  void prepare(const FlowModel<D>& m, const FlowCells<D>& cells, const FlowStep<D>& step, const std::vector<Real>& pressure);
  /// Finds p1 - p0; adds the iterations and the residual to the ledger.  Collective.
  std::vector<Real>& solve(const FlowModel<D>& m, const FlowStep<D>& step, FlowLedger& ledger);
  /// Solves the system again, until what pores take up is that of the pressures found.  find_contents() returns the cells with the contents
  /// of the changes of pressure that solve() has returned.  Collective.
  void solve_for_contents(const FlowModel<D>& m, const FlowStep<D>& step, FlowLedger& ledger,
                          const std::function<const FlowCells<D>&()>& find_contents);
  /// Gives the nodes the velocities that a change of pressure makes, and boundaries what they take of its forces.  Collective.
  void change_velocities(const FlowModel<D>& m, const FlowStep<D>& step, std::vector<Real>& change, ExactSums<Real>& work);
  /// Adds what has flowed over the step to the balance, with the pressures of its end.  Collective.
  void record(const FlowModel<D>& m, const FlowCells<D>& cells, const FlowStep<D>& step, const std::vector<Real>& change,
              const std::vector<Real>& pressure, FlowLedger& ledger) const;
  /// Sends values of own nodes to the ranks that use them.
  template <class Value>
  void send(std::vector<Value>& values)
  {
    copies_.send(values, Numbers{});
    copies_.take(values, Numbers{});
  }

 private:
  void find_rows(const FlowModel<D>& m, const FlowCells<D>& cells, const FlowStep<D>& step);
  void find_given_pressures(const FlowModel<D>& m, const FlowCells<D>& cells, const FlowStep<D>& step, const std::vector<Real>& pressure);
  void find_responses(const FlowModel<D>& m, const FlowStep<D>& step);
  void find_right_side(const FlowModel<D>& m, const FlowCells<D>& cells, const FlowStep<D>& step, const std::vector<Real>& pressure);
  void take_contents(const FlowModel<D>& m, const FlowCells<D>& cells, const FlowStep<D>& step, bool slopes);
  void find_residual(const FlowModel<D>& m, const FlowStep<D>& step);
  void iterate(const FlowModel<D>& m, const FlowStep<D>& step, bool again, FlowLedger& ledger);
  Real precondition(const FlowModel<D>& m);
  void prepare_coarse(const FlowModel<D>& m, const FlowStep<D>& step);
  /// The force of pressures x on a node of this rank [N].
  Vec<D> force_at(const Mesh<D>& mesh, Index n, const std::vector<Real>& x) const;
  /// All such forces, and the changes of velocity by them.
  void push(const FlowModel<D>& m, std::vector<Real>& x);
  /// image_ = (S + dt H + dt kick B^T M^-1 C B) x.
  Real multiply(const FlowModel<D>& m, Real dt, std::vector<Real>& x);
  bool sees_water(Index n) const noexcept { return at_[static_cast<std::size_t>(n)] != NodePressure::nothing; }
  bool is_unknown(Index n) const noexcept { return at_[static_cast<std::size_t>(n)] == NodePressure::unknown; }

  HaloExchange copies_;
  std::vector<NodePressure> at_, around_;     ///< around_: of the nodes of other ranks too
  std::vector<Real> change_, right_, given_;  ///< p1 - p0; the right-hand side; given changes
  std::vector<Real> before_;                  ///< change_ before the system was solved last
  std::vector<Real> weight_, inflow_;         ///< dt G and dt Q
  std::vector<Real> squeezed_;                ///< dt B^T v, of the velocities that the step found
  Real begin_{};                              ///< norm of the residual without a change of pressure
  std::vector<Real> residual_, direction_, image_, conditioned_, diagonal_;
  SparseRows<Real> matrix_, darcy_;       ///< S + dt H, and H, by the entries of rings of nodes
  SparseRows<Vec<D>> push_, divergence_;  ///< B, and B^T
  std::vector<Mat<D>> free_;              ///< C
  std::vector<Real> lightness_;           ///< kick / m of nodes with a motion of their own [s/kg], else 0
  std::vector<Vec<D>> force_, velocity_;
  PoreStorage<D> storage_;
  Rain<D> rain_;
  CoarsePressure<D> coarse_;
};

extern template class FlowSystem<2>;
extern template class FlowSystem<3>;

}  // namespace talus
