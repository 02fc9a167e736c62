#include "solver/statics/load_increment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/statics/without_remap.hpp"
#include "solver/step/step_parts.hpp"

namespace talus {

template <int D>
LoadIncrement<D>::LoadIncrement(Model<D>& m, Real dt, bool keeps_jump_stress) : m_(m), dt_(dt), time_(m.state.clock.time)
{
  end_sweeps(m_);
  before_ = m_.state;
  order_ = m_.work.order;
  const WithoutRemap remap(m_.problem.transfer);
  begin_sweeps(m_);
  m_.work.sums.clear();
  if (!find_forces(ActiveNodes::by_mass))
    return;
  m_.work.walls.find(m_.problem.mesh, *m_.work.strips, m_.work.fields);
  sound_ = true;
  unknowns_ = Unknowns<D>(m_.problem, nodes());
  // The columns have particles in the cells of the increment before; a trial without motion sorts them into those where they lie.
  move(std::vector<Real>(unknowns_.size(), 0), Then::locate);
  end_sweeps(m_);
  set_stiffness(keeps_jump_stress && m_.problem.columns.jump_stress);
  restore();
}

template <int D>
void LoadIncrement<D>::restore()
{
  m_.work.strips.reset();
  m_.state = before_;
  m_.work.order = order_;
}

/// Sums the forces of the particles, as they are, at the nodes; false where some of them cannot take part.
template <int D>
bool LoadIncrement<D>::find_forces(ActiveNodes active)
{
  if (!locate_particles(m_))
    return false;
  m_.work.strips->send_leavers(m_.problem.subdomain, m_.work.migration);
  m_.transfer->particles_to_nodes(m_);
  m_.transfer->assemble_nodes(m_);
  apply_nodal_loads(m_);
  m_.work.fields.front().small_mass_nodes.lump(m_.problem.mesh, m_.problem.own, nodes(), active);
  return true;
}

/// The stiffness of the nodes, and that of displacements that averaged gradients do not see, of the particles in the columns.
template <int D>
void LoadIncrement<D>::set_stiffness(bool keeps_jump_stress)
{
  const Problem<D>& problem = m_.problem;
  elastic_ = ElasticStiffness<D>(problem.mesh, m_.state, m_.transfer->averages_gradients());
  jumps_.set_stiffness(problem, elastic_, keeps_jump_stress);
  jumps_.for_each_cell(problem.mesh, [&](Index c, Real stiffness) {
    if (problem.subdomain.alone() || problem.subdomain.owns_cell(c))
      elastic_.support(c, stiffness);
  });
  stiffness_ = elastic_.of_nodes(problem, unknowns_);
}

/// Forces against displacements that averaged gradients do not see, at nodes with a motion of their own [N].
template <int D>
std::vector<Vec<D>> LoadIncrement<D>::jump_forces(At at)
{
  std::vector<Vec<D>> forces = jumps_.find(m_.problem, at);
  m_.work.fields.front().small_mass_nodes.give(
      m_.problem.own, [](Index, const Vec<D>& force) { return force; }, forces);
  return forces;
}

/// Those that a step has: none where particles have no stress against jumps.
template <int D>
std::vector<Vec<D>> LoadIncrement<D>::jump_forces_in_steps(At at)
{
  return m_.problem.columns.jump_stress ? jump_forces(at) : std::vector<Vec<D>>(to_size(m_.problem.mesh.n_nodes()), Vec<D>::Zero());
}

/// Which changes of displacement the conditions leave free, as they were in the last trial.
template <int D>
void LoadIncrement<D>::set_constraints()
{
  free_.clear();
  for (const Index n : unknowns_.node)
    free_.push_back(m_.state.boundary.free_changes(nodes().of_field(n), nodes().motion[to_size(n)].v));
}

/// The entries of the preconditioner: elastic stiffness of what the conditions leave free, and that of the nodes of the rest.
template <int D>
void LoadIncrement<D>::add_stiffness(const std::function<void(std::int64_t, std::int64_t, Real)>& add) const
{
  const Mesh<D>& mesh = m_.problem.mesh;
  const auto add_block = [&](Index i, Index j, const Mat<D>& block) {
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b)
        add(unknowns_.first(i) + a, unknowns_.first(j) + b, unknowns_.length / force_ * block(a, b));
  };
  /// Calls f(node, share) for the nodes with unknowns that move a node.
  const auto for_each_mover = [&](Index n, auto&& f) {
    if (unknowns_.has(n))
      f(n, Real{1});
    else
      m_.work.fields.front().small_mass_nodes.for_each_host(n, [&](Index host, Real share) {
        if (unknowns_.has(host))
          f(host, share);
      });
  };
  const auto freedom = [&](Index n) -> Mat<D> {
    const Index k = unknowns_.row[to_size(n)];
    return k != none ? free_[to_size(k)] : m_.state.boundary.free_changes(nodes().of_field(n), Vec<D>::Zero());
  };
  elastic_.for_each_block(mesh, [&](Index a, Index b, const Mat<D>& block) {
    for_each_mover(a, [&](Index i, Real share_i) {
      for_each_mover(b, [&](Index j, Real share_j) { add_block(i, j, share_i * share_j * freedom(i) * block); });
    });
  });
  for (std::size_t k = 0; k < unknowns_.node.size(); ++k)
    add_block(unknowns_.node[k], unknowns_.node[k], stiffness_[k].all * (Mat<D>::Identity() - free_[k]) + stiffness_[k].beyond * free_[k]);
}

/// The displacements of all nodes in a trial.
template <int D>
std::vector<Vec<D>> LoadIncrement<D>::displacements()
{
  std::vector<Vec<D>> u(to_size(m_.problem.mesh.n_nodes()), Vec<D>::Zero());
  nodes().in_use.for_each([&](Index n) { u[to_size(n)] = dt_ * nodes().motion[to_size(n)].v; });
  unknowns_.send(u);
  return u;
}

/// Moves the particles from where the increment begins; then finds the forces on the nodes, or stays there.  False where a particle cannot
/// follow.
template <int D>
bool LoadIncrement<D>::move(std::span<const Real> x, Then then)
{
  restore();
  ++evaluations_;
  Workspace<D>& work = m_.work;
  const WithoutRemap remap(m_.problem.transfer);
  begin_sweeps(m_);
  work.sums.clear();
  const auto give_up = [&] {
    work.errors.clear();
    return false;
  };
  if (!find_forces(ActiveNodes::as_before))
    return give_up();
  nodes().in_use.for_each([&](Index n) { nodes().motion[to_size(n)] = {}; });
  for (std::size_t k = 0; k < unknowns_.node.size(); ++k)
    nodes().motion[to_size(unknowns_.node[k])].v = displacement(x, k) / dt_;
  const Kick kick{time_, time_ + dt_ / 2};
  work.fields.front().small_mass_nodes.extrapolate(m_.problem.own, kick, m_.state.boundary, nodes(), work.sums.beyond_nodes);
  if (then == Then::stay)
    record_work(x);
  else if (then == Then::forces)
    jumps_.take_displacements(m_.problem.mesh, displacements());
  m_.transfer->send_motion(m_);
  clear_particle_sums(m_);
  find_renewed_bodies(m_);
  m_.transfer->nodes_to_particles(m_, kick, dt_, between_parts(m_, dt_));
  if (then == Then::locate)
    jumps_.take_start(m_.problem, *work.strips, m_.state.empty_cells);
  else if (then == Then::forces)
    jumps_.take_stress(m_.problem, *work.strips);
  else if (m_.problem.columns.jump_stress)
    jumps_.store(m_.problem, *work.strips, m_.state.empty_cells);
  m_.state.boundary = before_.boundary;  // without the impulses of masses, which have no inertia here
  work.sums.beyond_nodes.clear();
  work.errors.take(m_.problem.ranks->min(work.errors.word()));
  if (then == Then::locate)
    work.errors.clear();
  if (then != Then::forces)
    return true;
  if (work.errors.worst())
    return give_up();
  m_.state.clock.time += dt_;
  work.sums.on_mesh.clear();
  if (!find_forces(ActiveNodes::as_before))
    return give_up();
  jump_ = jump_forces(At::end);
  return true;
}

template <int D>
bool LoadIncrement<D>::find_residual(std::span<const Real> x, std::span<Real> f)
{
  if (!move(x, Then::forces))
    return false;
  const Real end = time_ + dt_;
  const Vec<D> gravity = m_.problem.loads.gravity(end, m_.state.stage.ramp(end));
  const Real middle = time_ + dt_ / 2;  // whose velocity a boundary has in all of the increment
  const Kick kick{middle, middle};
  reaction_.resize(unknowns_.node.size());
  weight_.resize(unknowns_.node.size());
  for (std::size_t k = 0; k < unknowns_.node.size(); ++k) {
    const Index n = unknowns_.node[k];
    const NodeSum<D>& sum = nodes().sum[to_size(n)];
    weight_[k] = sum.mass * gravity;
    const Vec<D> u = displacement(x, k), r = sum.force + weight_[k] + jump_[to_size(n)];
    const Real s = stiffness_[k].all;
    NodeMotion<D>& motion = nodes().motion[to_size(n)];
    motion.change = r / (s * dt_);
    motion.v = u / dt_ + motion.change;
    const Vec<D> pushed = motion.v;
    m_.state.boundary.apply(nodes().of_field(n), kick, s * dt_ * dt_, motion, m_.work.sums.at_nodes);
    reaction_[k] = s * dt_ * (motion.v - pushed);
    Eigen::Map<Vec<D>>(f.data() + k * D) = -(r + reaction_[k]) / force_;
  }
  return true;
}

template <int D>
Real LoadIncrement<D>::norm(std::span<const Real> f) const
{
  ExactSums<Real> squares;
  for (const Real one : f)
    squares.add(one * one);
  m_.problem.ranks->sum(squares);
  return std::sqrt(squares.value());
}

/// The residual where nothing moves, and the size of the loads: weight, reactions and what is out of balance then.
template <int D>
bool LoadIncrement<D>::find_loads(std::span<Real> f)
{
  force_ = 1;
  if (!find_residual(std::vector<Real>(f.size(), 0), f))
    return false;
  std::vector<Real> loads(f.size());
  imbalance_ = loads_ = norm(f);
  for (const std::vector<Vec<D>>* all : {&reaction_, &weight_}) {
    for (std::size_t k = 0; k < unknowns_.node.size(); ++k)
      Eigen::Map<Vec<D>>(loads.data() + k * D) = (*all)[k];
    loads_ = std::max(loads_, norm(loads));
  }
  return true;
}

template <int D>
std::optional<Real> LoadIncrement<D>::imbalance_at_start()
{
  std::vector<Real> f(unknowns_.size());
  const bool is_found = find_loads(f);
  restore();
  return is_found ? std::optional(loads_ > 0 ? imbalance_ / loads_ : 0) : std::nullopt;
}

/// Newton's method, from x on.
template <int D>
NonlinearResult LoadIncrement<D>::iterate(NonlinearSolver& solver, int most_iterations, Real tolerance, std::span<Real> x)
{
  const NonlinearEquations equations{.unknowns = x.size(),
                                     .block = D,
                                     .residual = [this](std::span<const Real> at, std::span<Real> to) { return find_residual(at, to); },
                                     .add_preconditioner = [this](const auto& add) { add_stiffness(add); },
                                     .tolerance = tolerance,
                                     .most_iterations = most_iterations};
  return solver.solve(equations, x);
}

/// The displacements for which the ground would be in balance if it did not yield: from there on it is known where it does.  Without motion all
/// that is about to yield is on the edge, where differences of trials are no derivative.
template <int D>
void LoadIncrement<D>::find_elastic_guess(NonlinearSolver& solver, int most_iterations, Real tolerance, std::span<Real> x)
{
  std::ranges::fill(x, 0);
  const bool was = std::exchange(before_.stage.elastic, true);
  iterate(solver, most_iterations, tolerance, x);
  before_.stage.elastic = was;
}

template <int D>
std::optional<std::string> LoadIncrement<D>::solve(NonlinearSolver& solver, const EquilibriumOptions& options)
{
  std::vector<Real> x(unknowns_.size(), 0), f(x.size());
  if (!find_loads(f)) {
    restore();
    return "the state that it begins with has particles that cannot be placed";
  }
  set_constraints();
  const auto is_held = [](const Mat<D>& free) { return free != Mat<D>::Identity(); };
  if (m_.problem.ranks->sum(static_cast<std::int64_t>(std::ranges::count_if(free_, is_held))) == 0) {
    restore();
    return "no boundary holds the bodies: give one of type fixed, roller or friction where they touch it";
  }
  NonlinearResult result;
  result.converged = true;
  if (loads_ > 0) {
    const Real tolerance_of_guess = std::max(options.residual, 0.01 * imbalance_ / loads_);
    force_ = loads_;
    result = iterate(solver, options.most_iterations, options.residual, x);
    if (!result.converged && result.iterations < options.most_iterations && !before_.stage.elastic) {
      find_elastic_guess(solver, options.most_iterations, tolerance_of_guess, x);
      result = iterate(solver, options.most_iterations, options.residual, x);
    }
  }
  if (!result.converged) {
    without_solution_ = true;
    std::string why = fmt::format("{} after {} iterations, unbalanced force {:.3g} of the loads; {}", result.reason, result.iterations,
                                  result.norm, place_of_failure(x, f));
    restore();
    return why;
  }
  accept(x);
  SolveLedger& solve = m_.state.solve;
  solve.last_residual = result.norm;
  solve.last_iterations = result.iterations, solve.last_linear_iterations = result.linear_iterations;
  solve.iterations += result.iterations, solve.linear_iterations += result.linear_iterations, solve.evaluations += evaluations_;
  return std::nullopt;
}

template <int D>
void LoadIncrement<D>::skip()
{
  const Real left = loads_ > 0 ? imbalance_ / loads_ : 0;
  accept(std::vector<Real>(unknowns_.size(), 0));
  m_.state.solve.last_residual = left;
  m_.state.solve.last_iterations = m_.state.solve.last_linear_iterations = 0;
}

/// Where the nodes move most, in words: there a mechanism begins.  Where none has moved, where the forces f [N] are least in balance.
template <int D>
std::string LoadIncrement<D>::place_of_failure(std::span<const Real> x, std::span<const Real> f) const
{
  const auto largest = [&](std::span<const Real> values, Real unit, const char* what, const char* of_unit) {
    Real most = 0;
    Vec<D> where = Vec<D>::Zero();
    for (std::size_t k = 0; k < unknowns_.node.size(); ++k)
      if (const Real size = unit * Eigen::Map<const Vec<D>>(values.data() + k * D).norm(); size > most)
        most = size, where = m_.problem.mesh.node(unknowns_.node[k]);
    const Real of_all = m_.problem.ranks->max(most);  // also of ranks on which nothing moves
    const bool is_here = most > 0 && most == of_all;
    return m_.problem.ranks->first(
        is_here ? fmt::format("{} is at ({:.5g}), {:.3g} {}", what, fmt::join(where.begin(), where.end(), ", "), most, of_unit) : "");
  };
  const std::string moves = largest(x, unknowns_.length, "what moves most", "m");
  return moves.empty() ? largest(f, 1, "the largest unbalanced force", "N") : moves;
}

template class LoadIncrement<2>;
template class LoadIncrement<3>;

}  // namespace talus
