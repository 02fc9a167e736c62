#pragma once
// One increment of a stage without inertia: the displacements of the nodes that bring stress, loads and boundary conditions into balance.
#include <optional>
#include <string>

#include "core/nonlinear_solver.hpp"
#include "solver/model/model.hpp"
#include "solver/options/equilibrium_options.hpp"
#include "solver/statics/elastic_stiffness.hpp"
#include "solver/statics/jump_forces.hpp"
#include "solver/statics/unknowns.hpp"

namespace talus {

/// The equations of an increment of length dt [s].  The unknowns are the displacements u of the nodes with a motion of their own; a trial
/// moves the particles from where they are by u, as a step with the velocities u / dt does, lets their laws find the stress, and sums
/// forces r at the same nodes, with the weights of the new positions.  So the state that is found is in balance for the kernel of the steps
/// that follow.
///
/// Boundary conditions act on u as on the velocities of a step:  f(u) = s (u - B(u + r(u) / s))  with the stiffness s of a node, B setting
/// prescribed velocities, planes and Coulomb friction.  Of a free node f = -r; of a held one u is that of the boundary; where it presses on
/// a wall, f = 0 is Signorini's and Coulomb's conditions (the natural map of Alart & Curnier, Comput. Methods Appl. Mech. Engrg. 92, 1991).
template <int D>
class LoadIncrement {
 public:
  /// The particles must be at rest; `keeps_jump_stress` as in EquilibriumOptions.  Collective.
  LoadIncrement(Model<D>& m, Real dt, bool keeps_jump_stress);
  /// False where the state that it begins with has particles that cannot take part; their errors are in the workspace.
  bool is_sound() const noexcept { return sound_; }

  /// How far from balance the particles are where they lie, over the loads [-]; nothing where they cannot be placed.  The model stays as it
  /// is.  Collective.
  std::optional<Real> imbalance_at_start();
  /// Nothing where it was solved: the model is then at its end, with its balances.  Otherwise why not, and the model as it was.
  /// Collective.
  std::optional<std::string> solve(NonlinearSolver& solver, const EquilibriumOptions& options);
  /// Whether solve() has failed because Newton's method found nothing, so that skip() is possible.
  bool is_without_solution() const noexcept { return without_solution_; }
  /// Ends it with particles where they are.  Collective.
  void skip();

 private:
  enum class Then : std::uint8_t { forces, stay, locate };  ///< locate: stay, for the cells of the particles and their stress

  void restore();
  bool find_forces(ActiveNodes active);
  void set_stiffness(bool keeps_jump_stress);
  std::vector<Vec<D>> displacements();
  using At = typename JumpForces<D>::At;
  std::vector<Vec<D>> jump_forces(At at);
  std::vector<Vec<D>> jump_forces_in_steps(At at);
  void set_constraints();
  void add_stiffness(const std::function<void(std::int64_t, std::int64_t, Real)>& add) const;
  bool move(std::span<const Real> x, Then then);
  bool find_residual(std::span<const Real> x, std::span<Real> f);
  bool find_loads(std::span<Real> f);
  NonlinearResult iterate(NonlinearSolver& solver, int most_iterations, Real tolerance, std::span<Real> x);
  void find_elastic_guess(NonlinearSolver& solver, int most_iterations, Real tolerance, std::span<Real> x);
  void accept(std::span<const Real> x);
  /// Of the forces of jumps in the last trial those that pass with it.
  Vec<D> passing_jump(Index n) const noexcept { return jump_[to_size(n)] - jump_behind_[to_size(n)]; }
  Vec<D> left_over(std::span<const Real> f, std::size_t k) const;
  void find_net_acceleration(std::span<const Real> f);
  void record_work(std::span<const Real> x);
  void record_particle_loads();
  std::string place_of_failure(std::span<const Real> x, std::span<const Real> f) const;
  Real norm(std::span<const Real> f) const;

  Nodes<D>& nodes() noexcept { return m_.work.fields.front().nodes; }
  const Nodes<D>& nodes() const noexcept { return m_.work.fields.front().nodes; }
  Vec<D> displacement(std::span<const Real> x, std::size_t k) const noexcept
  {
    return unknowns_.length * Eigen::Map<const Vec<D>>(x.data() + k * D);
  }

  Model<D>& m_;
  Real dt_, time_;   ///< length and beginning [s]
  State<D> before_;  ///< at its beginning, the particles in their columns
  CellOrder order_;
  bool sound_ = false, without_solution_ = false;

  Unknowns<D> unknowns_;
  ElasticStiffness<D> elastic_;
  std::vector<typename ElasticStiffness<D>::OfNode> stiffness_;  ///< of each node with unknowns, s above
  JumpForces<D> jumps_;
  std::vector<Vec<D>> jump_;         ///< by node: their forces in the last trial [N]
  std::vector<Vec<D>> jump_behind_;  ///< by node: those that steps behind it have [N]
  Real force_ = 1;                   ///< unit of residuals [N]
  Real loads_ = 0, imbalance_ = 0;   ///< size of the loads, and what is out of balance where nothing moves [N]
  // Of each node with unknowns.
  std::vector<Mat<D>> free_;               ///< changes of displacement that its conditions leave free
  std::vector<Vec<D>> reaction_, weight_;  ///< in the last trial [N]
  std::int64_t evaluations_ = 0;
};

extern template class LoadIncrement<2>;
extern template class LoadIncrement<3>;

}  // namespace talus
