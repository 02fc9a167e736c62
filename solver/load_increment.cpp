#include "solver/load_increment.hpp"

#include <fmt/format.h>

#include <cmath>

#include "solver/state/integrate.hpp"
#include "solver/step_parts.hpp"

namespace talus {

namespace {

/// While it lives, particles take their strain from the velocities of the nodes themselves, which are those of a trial.
class WithoutRemap {
 public:
  explicit WithoutRemap(TransferOptions& options) : options_(options), before_(options)
  {
    options_.scheme = Scheme::flip;
    options_.musl = false;
    options_.pic_damping_time = options_.pic_damping_crossings = options_.pic_damping_fall_times = std::nullopt;
  }
  WithoutRemap(const WithoutRemap&) = delete;
  WithoutRemap& operator=(const WithoutRemap&) = delete;
  ~WithoutRemap() { options_ = before_; }

 private:
  TransferOptions& options_;
  TransferOptions before_;
};

/// Of the P-wave modulus, the shear modulus of a law that does not tell it, Poisson's ratio being 0.3; of a fluid, for the preconditioner alone.
/// Of the shear stiffness, that of displacements that averaged gradients do not see.  With less, linear systems take more iterations; with more, what
/// it holds takes more repetitions to come into balance: a column of 4, 8, 16 cells across is out of balance by .053, .021, .014 of its weight
/// with 1, by .0060, .0058, .0032 with .1, by .0012, .0013, .0010 with .02 and 16 to 38 iterations.
constexpr Real stiffness_of_jumps = 0.02;
/// Of the largest stiffness of a node, that of nodes without a filled cell beside them.
constexpr Real least_stiffness = 0.02;
constexpr Real shear_of_unknown = 2.0 / 7, shear_of_fluid = 1e-3;

}  // namespace

template <int D>
LoadIncrement<D>::LoadIncrement(Model<D>& m, Real dt, Real loads_ahead)
    : m_(m), dt_(dt), time_(m.state.clock.time), loads_from_(time_ + loads_ahead)
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
  list_unknowns();
  set_stiffness();
  m_.work.strips.reset();
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

template <int D>
void LoadIncrement<D>::list_unknowns()
{
  const Mesh<D>& mesh = m_.problem.mesh;
  Real length = std::numeric_limits<Real>::infinity();
  nodes().in_use.for_each_ascending([&](Index n) {
    if (m_.problem.own.has(n) && nodes().active[to_size(n)] != 0)
      node_.push_back(n);
  });
  for (const Index n : node_)
    for (const Index c : mesh.cells_of_node()[n])
      length = std::min(length, mesh.altitude(c));
  length_ = m_.problem.ranks->min(length);
  Communicator& ranks = *m_.problem.ranks;
  std::vector<std::int64_t> counts(to_size(ranks.size()), 0);
  counts[to_size(ranks.rank())] = static_cast<std::int64_t>(node_.size());
  ranks.sum(std::span(counts));
  std::int64_t first = 0;
  for (int r = 0; r < ranks.rank(); ++r)
    first += counts[to_size(r)];
  number_.assign(to_size(mesh.n_nodes()), 0);
  for (std::size_t k = 0; k < node_.size(); ++k)
    number_[to_size(node_[k])] = static_cast<Real>(first + static_cast<std::int64_t>(k) + 1);
  if (m_.problem.subdomain.alone())
    return;
  copies_ = copies_of_nodes(ranks, m_.problem.subdomain, MessageTag::equations, spread_by_rings(mesh, m_.problem.own.owned, rings_held));
  copies_.send(number_, Numbers{});
  copies_.take(number_, Numbers{});
}

/// The elastic stiffness of the cells, and of each node the mean of the diagonal of its own.
template <int D>
void LoadIncrement<D>::set_stiffness()
{
  const Mesh<D>& mesh = m_.problem.mesh;
  std::vector<Vec3> of_cell(to_size(mesh.n_cells()), Vec3::Zero());  // times P-wave modulus, times shear modulus, volume
  const Particles<D>& particles = before_.particles;
  for (std::size_t b = 0; b < before_.bodies.size(); ++b) {
    const Material& material = before_.materials[b];
    const bool fluid = material.law().description().is_fluid;
    for (Index p = before_.bodies[b].begin; p < before_.bodies[b].end; ++p) {
      const std::size_t i = to_size(p);
      const Real speed = material.wave_speed(p - before_.bodies[b].begin, particles.F[i]);
      const Real wave = particles.mass[i] * speed * speed;  // volume times P-wave modulus
      const Real known = particles.volume[i] * material.law().shear_modulus().value_or(shear_of_unknown * wave / particles.volume[i]);
      of_cell[to_size(particles.cell[i])] += Vec3(wave, fluid ? shear_of_fluid * wave : std::min(known, wave / 2), particles.volume[i]);
    }
  }
  if (!m_.problem.subdomain.alone()) {
    HaloExchange cells = copies_of_cells(*m_.problem.ranks, m_.problem.subdomain, MessageTag::cells, mesh.n_cells());
    std::vector<Vec3> all = of_cell;
    cells.send(all, Numbers{});
    cells.take(all, Numbers{});
    set_jumps(all);
  } else {
    set_jumps(of_cell);
  }
  std::vector<Real> diagonal(to_size(mesh.n_nodes()), 0);
  Real largest = 0;
  for (Index c = 0; c < mesh.n_cells(); ++c) {
    const Real compress = of_cell[to_size(c)][0], shear = of_cell[to_size(c)][1];
    if (!(compress > 0))
      continue;
    cells_.push_back({c, {compress, shear}});
    for (std::size_t a = 0; a <= D; ++a)
      largest =
          std::max(largest, diagonal[to_size(mesh.cell(c)[a])] += (compress + (D - 1) * shear) / D * mesh.gradients(c)[a].squaredNorm());
  }
  largest = m_.problem.ranks->max(largest);
  for (const Index n : node_) {
    stiffness_.push_back(std::max(diagonal[to_size(n)], least_stiffness * largest));
    beyond_.push_back(stiffness_.back() - diagonal[to_size(n)]);
  }
}

template <int D>
void LoadIncrement<D>::set_jumps(const std::vector<Vec3>& of_cell)
{
  std::vector<Real> filled, stiffness;
  for (const Vec3& one : of_cell) {
    filled.push_back(one[2]);
    stiffness.push_back(stiffness_of_jumps * one[1]);
  }
  jumps_ = GradientJumps<D>(m_.problem.mesh, filled, stiffness);
}

/// The forces of the displacements that averaged gradients do not see, at nodes with a motion of their own.
template <int D>
void LoadIncrement<D>::find_jump_forces()
{
  u_.assign(to_size(m_.problem.mesh.n_nodes()), Vec<D>::Zero());
  nodes().in_use.for_each([&](Index n) { u_[to_size(n)] = dt_ * nodes().motion[to_size(n)].v; });
  copies_.send(u_, Numbers{});
  copies_.take(u_, Numbers{});
  jump_force_.assign(u_.size(), Vec<D>::Zero());
  jumps_.add_forces(m_.problem.mesh, u_, jump_force_);
  m_.work.fields.front().small_mass_nodes.give(
      m_.problem.mesh, m_.problem.own, [](Index, const Vec<D>& force) { return force; }, jump_force_);
}

/// Which changes of displacement the conditions leave free, as they were in the last trial.
template <int D>
void LoadIncrement<D>::set_constraints()
{
  free_.clear();
  for (const Index n : node_)
    free_.push_back(m_.state.boundary.free_changes(nodes().of_field(n), nodes().motion[to_size(n)].v));
}

template <int D>
void LoadIncrement<D>::add_stiffness(const std::function<void(std::int64_t, std::int64_t, Real)>& add) const
{
  const Mesh<D>& mesh = m_.problem.mesh;
  const Real unit = length_ / force_;
  std::vector<Index> row_of(number_.size(), none);
  for (std::size_t k = 0; k < node_.size(); ++k)
    row_of[to_size(node_[k])] = static_cast<Index>(k);
  const auto add_block = [&](std::int64_t i, std::int64_t j, const Mat<D>& block) {
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b)
        add(i * D + a, j * D + b, unit * block(a, b));
  };
  /// The nodes with a motion of their own that move a node, and by what share.
  const auto movers = [&](Index n, std::vector<std::pair<Index, Real>>& all) {
    all.clear();
    if (number_[to_size(n)] > 0)
      all.emplace_back(n, 1);
    else
      m_.work.fields.front().small_mass_nodes.for_each_host(mesh, n, [&](Index host, Real share) {
        if (number_[to_size(host)] > 0)
          all.emplace_back(host, share);
      });
  };
  const auto freedom = [&](Index n) -> Mat<D> {
    if (const Index k = row_of[to_size(n)]; k != none)
      return free_[to_size(k)];
    return m_.state.boundary.free_changes(nodes().of_field(n), Vec<D>::Zero());
  };
  std::array<std::vector<std::pair<Index, Real>>, D + 1> of;
  for (const auto& [c, moduli] : cells_) {
    const auto& [compress, shear] = moduli;
    const auto& g = mesh.gradients(c);
    for (std::size_t a = 0; a <= D; ++a)
      movers(mesh.cell(c)[a], of[a]);
    for (std::size_t a = 0; a <= D; ++a)
      for (std::size_t b = 0; b <= D; ++b) {
        const Mat<D> block =
            (compress - 2 * shear) * g[a] * g[b].transpose() + shear * (g[b] * g[a].transpose() + g[a].dot(g[b]) * Mat<D>::Identity());
        for (const auto& [i, share_i] : of[a])
          for (const auto& [j, share_j] : of[b])
            add_block(static_cast<std::int64_t>(number_[to_size(i)]) - 1, static_cast<std::int64_t>(number_[to_size(j)]) - 1,
                      share_i * share_j * freedom(i) * block);
      }
  }
  for (std::size_t k = 0; k < node_.size(); ++k) {
    const std::int64_t i = static_cast<std::int64_t>(number_[to_size(node_[k])]) - 1;
    // nodes without a filled cell beside them have some stiffness by averaged gradients
    add_block(i, i, stiffness_[k] * (Mat<D>::Identity() - free_[k]) + beyond_[k] * free_[k]);
  }
}

/// Moves the particles from where the increment begins; then finds the forces on the nodes, or stays there.  False where a particle cannot follow.
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
  for (std::size_t k = 0; k < node_.size(); ++k)
    nodes().motion[to_size(node_[k])].v = displacement(x, k) / dt_;
  const Kick kick{time_, time_ + dt_ / 2};
  work.fields.front().small_mass_nodes.extrapolate(m_.problem.mesh, m_.problem.own, kick, m_.state.boundary, nodes(),
                                                   work.sums.beyond_nodes);
  if (then == Then::stay)
    record_work(x);
  else
    find_jump_forces();
  m_.transfer->send_motion(m_);
  clear_particle_sums(m_);
  find_renewed_bodies(m_);
  m_.transfer->nodes_to_particles(m_, kick, dt_, between_parts(m_, dt_));
  m_.state.boundary = before_.boundary;  // without the impulses of masses, which have no inertia here
  work.sums.beyond_nodes.clear();
  work.errors.take(m_.problem.ranks->min(work.errors.word()));
  if (then == Then::stay)
    return true;
  if (work.errors.worst())
    return give_up();
  m_.state.clock.time += dt_;
  work.sums.on_mesh.clear();
  return find_forces(ActiveNodes::as_before) || give_up();
}

/// Stress and loads at a node [N].
template <int D>
Vec<D> LoadIncrement<D>::net_force(Index node) const
{
  const Real end = time_ + dt_;
  const NodeSum<D>& sum = nodes().sum[to_size(node)];
  return sum.force + sum.mass * m_.problem.loads.gravity(end, m_.state.stage.ramp(end));
}

template <int D>
bool LoadIncrement<D>::find_residual(std::span<const Real> x, std::span<Real> f)
{
  if (!move(x, Then::forces))
    return false;
  const Real end = time_ + dt_;
  const Vec<D> gravity = m_.problem.loads.gravity(end, m_.state.stage.ramp(end));
  const Kick kick{time_, time_ + dt_ / 2};
  reaction_.resize(node_.size());
  weight_.resize(node_.size());
  for (std::size_t k = 0; k < node_.size(); ++k) {
    const Index n = node_[k];
    const Vec<D> u = displacement(x, k), r = net_force(n) + jump_force_[to_size(n)];
    const Real s = stiffness_[k];
    NodeMotion<D>& motion = nodes().motion[to_size(n)];
    motion.change = r / (s * dt_);
    motion.v = u / dt_ + motion.change;
    const Vec<D> pushed = motion.v;
    m_.state.boundary.apply(nodes().of_field(n), kick, s * dt_ * dt_, motion, m_.work.sums.at_nodes);
    reaction_[k] = s * dt_ * (motion.v - pushed);
    weight_[k] = nodes().sum[to_size(n)].mass * gravity;
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

template <int D>
std::optional<std::string> LoadIncrement<D>::solve(NonlinearSolver& solver, Real residual)
{
  std::vector<Real> x(node_.size() * D, 0), f(x.size());
  if (!find_residual(x, f)) {
    restore();
    return "the state that it begins with has particles that cannot be placed";
  }
  set_constraints();
  // The size of the loads: weight, reactions and what is out of balance in the beginning.
  std::vector<Real> loads(x.size());
  Real size = norm(f);
  for (const std::vector<Vec<D>>* all : {&reaction_, &weight_}) {
    for (std::size_t k = 0; k < node_.size(); ++k)
      Eigen::Map<Vec<D>>(loads.data() + k * D) = (*all)[k];
    size = std::max(size, norm(loads));
  }
  NonlinearResult result;
  result.converged = true;
  if (size > 0) {
    force_ = size;
    const NonlinearEquations equations{.unknowns = x.size(),
                                       .block = D,
                                       .residual = [this](std::span<const Real> at, std::span<Real> to) { return find_residual(at, to); },
                                       .add_preconditioner = [this](const auto& add) { add_stiffness(add); },
                                       .tolerance = residual};
    result = solver.solve(equations, x);
  }
  if (!result.converged) {
    std::string why = fmt::format("{} after {} iterations, unbalanced force {:.3g} of the loads; {}", result.reason, result.iterations,
                                  result.norm, place_of_largest(x));
    restore();
    return why;
  }
  accept(x);
  SolveLedger& solve = m_.state.solve;
  ++solve.increments;
  solve.last_iterations = result.iterations, solve.last_linear_iterations = result.linear_iterations;
  solve.iterations += result.iterations, solve.linear_iterations += result.linear_iterations, solve.evaluations += evaluations_;
  return std::nullopt;
}

/// What is out of balance at a node in the last trial without the forces of jumps, of which a boundary takes up a part by its reaction [N].
template <int D>
Vec<D> LoadIncrement<D>::left_over(std::span<const Real> f, std::size_t k) const
{
  return -force_ * Eigen::Map<const Vec<D>>(f.data() + k * D) - free_[k] * jump_force_[to_size(node_[k])];
}

/// Half of the work of loads and gravity at the displacements, with forces as they are before these.  What is out of balance before and behind an
/// increment does work that nothing takes up; it counts as damping.
template <int D>
void LoadIncrement<D>::record_work(std::span<const Real> x)
{
  const Real time = loads_from_, ramp = m_.state.stage.ramp(time);
  const Vec<D> gravity = m_.problem.loads.gravity(time, ramp);
  nodes().kick = dt_ / 2;
  add_work(m_.problem.loads, time, ramp, m_.problem.own, nodes(), m_.work.sums.work_on_mesh);
  for (std::size_t k = 0; k < node_.size(); ++k) {
    const auto n = to_size(node_[k]);
    NodeWork<D> of_node;
    const Vec<D> weight = nodes().sum[n].mass * gravity, u = displacement(x, k);
    of_node.gravity = weight.dot(u) / 2;
    of_node.damping = -(free_[k] * (nodes().sum[n].force + weight)).dot(u) / 2;
    m_.work.sums.nodes.add(of_node);
    if (!m_.problem.loads.on_surfaces.empty())
      m_.work.sums.work_on_mesh.add(surface_work(nodes(), node_[k]));
  }
}

/// Loads on particles: their forces at the end, and their work by the mean of those at the beginning and at the end.
template <int D>
void LoadIncrement<D>::record_particle_loads()
{
  const ParticleStrips<D>& strips = *m_.work.strips;
  for (std::size_t key = 0; key < m_.work.load_sums.size(); ++key) {
    ParticleLoadSums<D> at_end;
    for (const Strip& strip : strips.strips(key)) {
      const StripColumns<D> columns = strips.columns(strip);
      at_end.add_forces(columns, to_size(strip.n));
      at_end.add_work(columns, to_size(strip.n));
    }
    at_end.work = (m_.work.load_sums[key].work + at_end.work) / 2;
    m_.work.load_sums[key] = at_end;
  }
}

/// The accelerations that the forces of the last trial would give, without those that move no particle and without the forces of jumps.
template <int D>
void LoadIncrement<D>::find_net_acceleration(std::span<const Real> f)
{
  std::vector<Vec<D>>& felt = nodes().felt;
  felt.assign(nodes().sum.size(), Vec<D>::Zero());
  for (std::size_t k = 0; k < node_.size(); ++k) {
    const auto n = to_size(node_[k]);
    const Vec<D> net = left_over(f, k);
    if (nodes().sum[n].mass > 0)
      felt[n] = net / nodes().sum[n].mass;
  }
  m_.transfer->filter_acceleration(m_);
}

/// Makes a trial the state, with its balances.
template <int D>
void LoadIncrement<D>::accept(std::span<const Real> x)
{
  std::vector<Real> f(x.size());
  force_ = 1;
  find_residual(x, f);
  StepSums<D>& sums = m_.work.sums;
  const ExactSums<BoundaryWork> at_nodes = sums.at_nodes;
  const ExactSums<ForceAndMoment<D>> on_mesh = sums.on_mesh;
  const BoundaryConditions<D> boundary = m_.state.boundary;
  const Real end = time_ + dt_;
  const Vec<D> gravity = m_.problem.loads.gravity(end, m_.state.stage.ramp(end));
  find_net_acceleration(f);
  ExactSums<NodeWork<D>> at_end;
  ExactSums<Balance> balance;
  ExactSums<Real> work_on_mesh;
  for (std::size_t k = 0; k < node_.size(); ++k) {
    const NodeSum<D>& sum = nodes().sum[to_size(node_[k])];
    NodeWork<D> of_node;
    of_node.gravity = sum.mass * gravity.dot(displacement(x, k)) / 2;
    of_node.damping = -left_over(f, k).dot(displacement(x, k)) / 2;
    const Vec<D> held = force_ * Eigen::Map<const Vec<D>>(f.data() + k * D) + jump_force_[to_size(node_[k])];
    of_node.damped = ForceAndMoment<D>::at(m_.problem.mesh.node(node_[k]), dt_ * held);
    of_node.mass = sum.mass;
    of_node.first_moment = sum.mass * m_.problem.mesh.node(node_[k]);
    at_end.add(of_node);
    balance.add({sum.mass * nodes().felt[to_size(node_[k])].norm(), weight_[k].norm(), reaction_[k].norm()});
    nodes().motion[to_size(node_[k])] = {.v = displacement(x, k) / dt_};
  }
  nodes().kick = dt_ / 2;
  add_work(m_.problem.loads, end, m_.state.stage.ramp(end), m_.problem.own, nodes(), work_on_mesh);
  if (!m_.problem.loads.on_surfaces.empty())
    for (const Index n : node_)
      work_on_mesh.add(surface_work(nodes(), n));

  move(x, Then::stay);
  record_particle_loads();
  m_.state.boundary = boundary;
  sums.at_nodes = at_nodes, sums.on_mesh = on_mesh;
  sums.nodes.add(at_end), sums.work_on_mesh.add(work_on_mesh), sums.balance = balance;
  nodes().gravity = gravity, nodes().kick = dt_;
  record_particle_sums(m_);
  update_balances(m_);
  m_.state.energy.internal_ahead = m_.state.energy.loads_ahead = 0;
  {
    const WithoutRemap remap(m_.problem.transfer);
    end_sweeps(m_);
  }
  Particles<D>& particles = m_.state.particles;
  particles.v.assign(particles.v.size(), Vec<D>::Zero());
  for (auto* affine : {&particles.L, &particles.C})
    affine->assign(affine->size(), Mat<D>::Zero());
  m_.state.monitor.speed = 0;
  m_.state.clock = {.step = m_.state.clock.step + 1, .time = end, .dt = dt_, .lag = 0};
}

/// Where the nodes move most, in words: there a mechanism begins.
template <int D>
std::string LoadIncrement<D>::place_of_largest(std::span<const Real> x) const
{
  Real most = 0;
  Vec<D> where = Vec<D>::Zero();
  for (std::size_t k = 0; k < node_.size(); ++k)
    if (const Real u = displacement(x, k).norm(); u > most)
      most = u, where = m_.problem.mesh.node(node_[k]);
  const Real all = m_.problem.ranks->max(most);
  const std::string here = most == all && most > 0 ? fmt::format("what moves most is at ({:.5g}), by {:.3g} m",
                                                                 fmt::join(where.begin(), where.end(), ", "), most)
                                                   : "";
  const std::string text = m_.problem.ranks->first(here);
  return text.empty() ? "nothing moves" : text;
}

template class LoadIncrement<2>;
template class LoadIncrement<3>;

}  // namespace talus
