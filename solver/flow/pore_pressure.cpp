#include "solver/flow/pore_pressure.hpp"

#include "solver/state/sums.hpp"

namespace talus {

namespace {

/// Of the projection of pressures, over the compressibility of the skeleton for plane waves.
constexpr Real projection = 2;
constexpr int most_iterations = 2000;
/// A node is at the surface of the bodies if these shares of the cells around, and of one of them, are not exceeded.
constexpr Real full_around = 0.75, full_cell = 0.5;

std::size_t z(Index i) noexcept { return static_cast<std::size_t>(i); }

}  // namespace

template <int D>
PorePressure<D>::PorePressure(const Mesh<D>& mesh) : cells_(mesh), pressure_(z(mesh.n_nodes())), at_(pressure_.size(), At::nothing)
{
  const std::size_t n = pressure_.size(), entries = mesh.ring_of_node().item.size();
  for (auto* all : {&change_, &right_, &given_, &weight_, &inflow_, &squeezed_, &residual_, &direction_, &image_, &conditioned_, &diagonal_,
                    &lightness_})
    all->resize(n);
  free_.assign(n, Mat<D>::Identity());
  force_.assign(n, Vec<D>::Zero()), velocity_.assign(n, Vec<D>::Zero());
  matrix_.resize(entries), darcy_.resize(entries), push_.resize(entries), divergence_.resize(entries);
}

template <int D>
PorePressure<D>::PorePressure(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& subdomain, const OwnNodes& own)
    : PorePressure(mesh)
{
  cells_ = FlowCells<D>(ranks, mesh, subdomain);
  std::vector<std::uint8_t> wanted = spread_by_rings(mesh, own.owned, 1);
  for (Index c = 0; c < mesh.n_cells(); ++c)
    if (subdomain.owns_cell(c))
      for (const Index n : mesh.cell(c))
        wanted[z(n)] = 1;
  copies_ = copies_of_nodes(ranks, subdomain, MessageTag::flow_nodes, wanted);
}

/// The mean of what the particles around say of the pressure at each node, which is exact for linear pressures.
template <int D>
void PorePressure<D>::find_pressures(const Mesh<D>& mesh, const NodesInUse& in_use, const OwnNodes& own)
{
  in_use.for_each([&](Index n) {
    Real weight = 0, sum = 0;
    bool seen = false;
    if (own.has(n))
      for (const Index c : mesh.cells_of_node()[n])
        if (const FlowCell<D>& row = cells_[c]; row.flows()) {
          const auto a = static_cast<std::size_t>(std::ranges::find(mesh.cell(c), n) - mesh.cell(c).begin());
          weight += row.weight[a], sum += row.pressure[a];
          seen = true;
        }
    at_[z(n)] = seen ? At::unknown : At::nothing;
    pressure_[z(n)] = weight > 0 ? sum / weight : 0;
  });
  copies_.send(pressure_, Numbers{});
  copies_.take(pressure_, Numbers{});
}

template <int D>
void PorePressure<D>::find_rows(const Mesh<D>& mesh, const NodesInUse& in_use, const OwnNodes& own, const FlowStep<D>& step)
{
  constexpr Real n_corners = D + 1;
  in_use.for_each([&](Index n) {
    const auto ring = mesh.ring_of_node()[n];
    const auto first = z(mesh.ring_of_node().begin[z(n)]);
    for (std::size_t k = first; k < first + ring.size(); ++k)
      matrix_[k] = darcy_[k] = 0, push_[k].setZero(), divergence_[k].setZero();
    weight_[z(n)] = inflow_[z(n)] = 0;
    if (!own.has(n) || at_[z(n)] == At::nothing)
      return;
    for (const Index c : mesh.cells_of_node()[n]) {
      const FlowCell<D>& row = cells_[c];
      if (!row.flows())
        continue;
      const auto& corners = mesh.cell(c);
      const auto& gradients = mesh.gradients(c);
      const auto a = static_cast<std::size_t>(std::ranges::find(corners, n) - corners.begin());
      for (std::size_t b = 0; b <= D; ++b) {
        const std::size_t k = first + z(static_cast<Index>(std::ranges::lower_bound(ring, corners[b]) - ring.begin()));
        const Real darcy = row.mobility * gradients[a].dot(gradients[b]);
        const Real within = ((a == b ? 2 : 1) / (n_corners * (n_corners + 1)) - 1 / (n_corners * n_corners)) * projection * row.compliance;
        darcy_[k] += darcy;
        matrix_[k] += within + step.dt * darcy + (a == b ? row.storage / n_corners : 0);
        push_[k] += row.biot / n_corners * gradients[a];
        divergence_[k] += row.biot / n_corners * gradients[b];
      }
      weight_[z(n)] += step.dt * row.mobility * step.weight.dot(gradients[a]);
    }
  });
}

/// Which pressures are given, and what flows in.
template <int D>
void PorePressure<D>::find_boundaries(const Mesh<D>& mesh, const Flow& flow, const OwnNodes& own, const FlowStep<D>& step)
{
  const auto give = [&](Index n, Real pressure) {
    if (!own.has(n) || at_[z(n)] == At::nothing)
      return;
    at_[z(n)] = At::given;
    given_[z(n)] = pressure - pressure_[z(n)];
  };
  if (flow.surface_drains)
    parallel_for(mesh.n_nodes(), [&](Index n) {
      if (!is_free(n))
        return;
      Real filled = 0, size = 0, least = 1;
      for (const Index c : mesh.cells_of_node()[n]) {
        filled += cells_[c].filled, size += mesh.volume(c);
        least = std::min(least, cells_[c].filled / mesh.volume(c));
      }
      if (filled < full_around * size && least < full_cell)
        give(n, 0);
    });
  const Real weight = step.weight.norm();
  for (const HeadBoundary& head : flow.heads)
    for (const Index n : head.nodes)
      give(n, head.drained ? 0 : weight * std::max(head.level(step.end) - mesh.node(n)[D - 1], Real{0}));
  for (const InflowBoundary& inflow : flow.inflows)
    for (std::size_t k = 0; k < inflow.nodes.size(); ++k)
      if (const Index n = inflow.nodes[k]; own.has(n) && is_free(n))
        inflow_[z(n)] += step.dt * inflow.rate(step.end) * inflow.area[k];
}

/// How velocities answer to forces.
template <int D>
void PorePressure<D>::find_responses(const Mesh<D>&, const OwnNodes& own, const FlowStep<D>& step, const BoundaryConditions<D>& conditions,
                                     const VelocityField<D>& field)
{
  const Nodes<D>& nodes = field.nodes;
  nodes.in_use.for_each([&](Index n) { lightness_[z(n)] = own.has(n) && nodes.active[z(n)] != 0 ? step.kick / nodes.sum[z(n)].mass : 0; });
  copies_.send(lightness_, Numbers{});
  copies_.take(lightness_, Numbers{});
  conditions.for_each_node([&](Index n) { free_[z(n)] = conditions.free_changes(nodes.of_field(n), nodes.motion[z(n)].v); });
}

template <int D>
Vec<D> PorePressure<D>::force_at(const Mesh<D>& mesh, Index n, const std::vector<Real>& x) const
{
  Vec<D> force = Vec<D>::Zero();
  const Vec<D>* row = push_.data() + mesh.ring_of_node().begin[z(n)];
  for (const Index u : mesh.ring_of_node()[n])
    force += x[z(u)] * *row++;
  return force;
}

template <int D>
void PorePressure<D>::push(const Mesh<D>& mesh, const OwnNodes& own, std::vector<Real>& x, VelocityField<D>& field)
{
  copies_.send(x, Numbers{});
  copies_.take(x, Numbers{});
  const Nodes<D>& nodes = field.nodes;
  nodes.in_use.for_each(
      [&](Index n) { force_[z(n)] = own.has(n) && at_[z(n)] != At::nothing ? force_at(mesh, n, x) : Vec<D>(Vec<D>::Zero()); });
  field.small_mass_nodes.give(
      mesh, own, [&](Index n, const Vec<D>& f) -> Vec<D> { return free_[z(n)] * f; }, force_);
  nodes.in_use.for_each(
      [&](Index n) { velocity_[z(n)] = own.has(n) ? Vec<D>(lightness_[z(n)] * (free_[z(n)] * force_[z(n)])) : Vec<D>(Vec<D>::Zero()); });
  field.small_mass_nodes.take(
      mesh, own, [&](Index n, const Vec<D>& v) -> Vec<D> { return free_[z(n)] * v; }, velocity_);
  copies_.send(velocity_, Numbers{});
  copies_.take(velocity_, Numbers{});
}

template <int D>
void PorePressure<D>::multiply(const Mesh<D>& mesh, const OwnNodes& own, Real dt, std::vector<Real>& x, VelocityField<D>& field,
                               std::vector<Real>& y)
{
  push(mesh, own, x, field);
  field.nodes.in_use.for_each([&](Index u) {
    Real sum = 0;
    if (own.has(u) && at_[z(u)] != At::nothing) {
      auto k = z(mesh.ring_of_node().begin[z(u)]);
      for (const Index n : mesh.ring_of_node()[u]) {
        sum += matrix_[k] * x[z(n)] + dt * divergence_[k].dot(velocity_[z(n)]);
        ++k;
      }
    }
    y[z(u)] = sum;
  });
}

template <int D>
Real PorePressure<D>::dot(Communicator& ranks, const NodesInUse& in_use, const std::vector<Real>& x, const std::vector<Real>& y)
{
  ExactSums<Real> sum;
  add_ranges(in_use.own(), sum, [&](Index n) { return is_free(n) ? x[z(n)] * y[z(n)] : 0; });
  ranks.sum(sum);
  return sum.value();
}

/// Conjugate gradients [Hestenes & Stiefel 1952] from no change but the given ones on.
template <int D>
FlowSolution PorePressure<D>::solve(const Mesh<D>& mesh, const OwnNodes& own, Communicator& ranks, Real dt, VelocityField<D>& field)
{
  const NodesInUse& in_use = field.nodes.in_use;
  in_use.for_each([&](Index n) { change_[z(n)] = own.has(n) && at_[z(n)] == At::given ? given_[z(n)] : 0; });
  multiply(mesh, own, dt, change_, field, image_);
  const auto precondition = [&] {
    in_use.for_each([&](Index n) { conditioned_[z(n)] = is_free(n) ? residual_[z(n)] / diagonal_[z(n)] : 0; });
    return dot(ranks, in_use, residual_, conditioned_);
  };
  in_use.for_each([&](Index n) { residual_[z(n)] = is_free(n) ? right_[z(n)] - image_[z(n)] : 0; });
  Real now = precondition();
  const Real begin = now;
  FlowSolution solution;
  const Real enough = 0.81 * FlowLedger::tolerance * FlowLedger::tolerance * begin;
  in_use.for_each([&](Index n) { direction_[z(n)] = conditioned_[z(n)]; });
  for (; now > enough && solution.iterations < most_iterations; ++solution.iterations) {
    multiply(mesh, own, dt, direction_, field, image_);
    const Real length = now / dot(ranks, in_use, direction_, image_);
    in_use.for_each([&](Index n) {
      if (!is_free(n))
        return;
      change_[z(n)] += length * direction_[z(n)];
      residual_[z(n)] -= length * image_[z(n)];
    });
    const Real next = precondition(), share = next / now;
    now = next;
    in_use.for_each([&](Index n) { direction_[z(n)] = conditioned_[z(n)] + share * direction_[z(n)]; });
  }
  solution.residual = begin > 0 ? std::sqrt(now / begin) : 0;
  return solution;
}

/// Gives the nodes the velocities that the change of pressure makes, and boundaries what they take of its forces.
template <int D>
void PorePressure<D>::change_velocities(const Mesh<D>& mesh, const OwnNodes& own, const FlowStep<D>& step,
                                        BoundaryConditions<D>& conditions, VelocityField<D>& field, ExactSums<Real>& work)
{
  push(mesh, own, change_, field);
  Nodes<D>& nodes = field.nodes;
  nodes.in_use.for_each([&](Index n) {
    if (!own.has(n))
      return;
    nodes.motion[z(n)].v += velocity_[z(n)];
    nodes.motion[z(n)].change += velocity_[z(n)];
    if (nodes.active[z(n)] != 0)
      nodes.sum[z(n)].force += force_[z(n)];
  });
  conditions.for_each_node([&](Index n) {
    if (own.has(n) && at_[z(n)] != At::nothing) {
      const Vec<D> force = nodes.active[z(n)] != 0 ? force_[z(n)] : force_at(mesh, n, change_);
      conditions.react(n, step.kick * (free_[z(n)] * force - force));
    }
  });
  add_ranges(nodes.in_use.own(), work, [&](Index n) {
    const NodeMotion<D>& motion = nodes.motion[z(n)];
    return nodes.active[z(n)] != 0 ? nodes.sum[z(n)].mass * velocity_[z(n)].dot(motion.v - 0.5 * motion.change) : 0;
  });
}

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

/// Adds what has flowed to the balance; the pressures are those of the end, and the velocities too.
template <int D>
void PorePressure<D>::record(const Mesh<D>& mesh, Communicator& ranks, const OwnNodes& own, const FlowStep<D>& step,
                             VelocityField<D>& field, FlowLedger& ledger)
{
  ExactSums<FlowSums> sums;
  add_ranges(field.nodes.in_use.own(), sums, [&](Index u) {
    FlowSums one;
    if (!own.has(u) || at_[z(u)] == At::nothing)
      return one;
    Real lifted = 0;  // dt k/gamma w^2
    for (const Index c : mesh.cells_of_node()[u])
      lifted += step.dt * cells_[c].mobility * step.weight.squaredNorm() / (D + 1);
    auto k = z(mesh.ring_of_node().begin[z(u)]);
    Real changed = 0, darcy = 0;
    for (const Index n : mesh.ring_of_node()[u]) {
      changed += (matrix_[k] - step.dt * darcy_[k]) * change_[z(n)];
      darcy += step.dt * darcy_[k] * pressure_[z(n)];
      one.squeezed += step.dt * divergence_[k].dot(velocity_[z(n)]);
      ++k;
    }
    one.squeezed += squeezed_[z(u)];
    one.stored = changed;
    one.inflow = inflow_[z(u)];
    const Real needed = changed + one.squeezed + darcy - weight_[z(u)];  // to flow in at the node
    one.drained = at_[z(u)] == At::given ? -needed : 0;
    one.seepage = pressure_[z(u)] * (darcy - 2 * weight_[z(u)]) + lifted;
    return one;
  });
  ranks.sum(sums);
  const FlowSums all = sums.value();
  ledger.inflow += all.inflow, ledger.drained += all.drained, ledger.stored += all.stored, ledger.squeezed += all.squeezed,
      ledger.seepage += all.seepage;
}

template <int D>
FlowSolution PorePressure<D>::advance(const Mesh<D>& mesh, const Flow& flow, const std::vector<Material>& materials,
                                      const ParticleStrips<D>& strips, const OwnNodes& own, Communicator& ranks, const FlowStep<D>& step,
                                      BoundaryConditions<D>& conditions, VelocityField<D>& field, FlowLedger& ledger, ExactSums<Real>& work)
{
  const NodesInUse& in_use = field.nodes.in_use;
  cells_.sum(mesh, flow, materials, strips);
  find_pressures(mesh, in_use, own);
  find_rows(mesh, in_use, own, step);
  find_boundaries(mesh, flow, own, step);
  find_responses(mesh, own, step, conditions, field);

  in_use.for_each([&](Index n) { velocity_[z(n)] = own.has(n) ? field.nodes.motion[z(n)].v : Vec<D>(Vec<D>::Zero()); });
  copies_.send(velocity_, Numbers{});
  copies_.take(velocity_, Numbers{});
  in_use.for_each([&](Index u) {
    if (!own.has(u) || at_[z(u)] == At::nothing)
      return;
    Real darcy = 0, diagonal = 0, squeezed = 0;
    auto k = z(mesh.ring_of_node().begin[z(u)]);
    for (const Index n : mesh.ring_of_node()[u]) {
      squeezed += step.dt * divergence_[k].dot(velocity_[z(n)]);
      darcy += step.dt * darcy_[k] * pressure_[z(n)];
      diagonal += step.dt * lightness_[z(n)] * divergence_[k].squaredNorm();
      if (n == u)
        diagonal += matrix_[k];
      ++k;
    }
    squeezed_[z(u)] = squeezed;
    right_[z(u)] = weight_[z(u)] + inflow_[z(u)] - squeezed - darcy;
    diagonal_[z(u)] = diagonal;
  });
  const FlowSolution solution = solve(mesh, own, ranks, step.dt, field);
  change_velocities(mesh, own, step, conditions, field, work);
  in_use.for_each([&](Index n) { pressure_[z(n)] += change_[z(n)]; });
  copies_.send(pressure_, Numbers{});
  copies_.take(pressure_, Numbers{});
  record(mesh, ranks, own, step, field, ledger);
  ledger.begun = true;
  ledger.iterations = solution.iterations, ledger.total_iterations += solution.iterations, ledger.residual = solution.residual;
  return solution;
}

template class PorePressure<2>;
template class PorePressure<3>;

}  // namespace talus
