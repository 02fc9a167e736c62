#include "solver/flow/flow_system.hpp"

#include <limits>

#include "solver/state/sums.hpp"

namespace talus {

namespace {

/// Of the projection of pressures, over the compressibility of the skeleton for plane waves.
constexpr Real projection = 2;
/// A node is at the surface of the bodies if this share of the cells around is not exceeded, and Rain::full_cell of one of them.
constexpr Real full_around = 0.75;

}  // namespace

template <int D>
FlowSystem<D>::FlowSystem(const Mesh<D>& mesh)
    : at_(to_size(mesh.n_nodes()), NodePressure::nothing), storage_(at_.size(), to_size(mesh.n_cells())), rain_(at_.size()), coarse_(mesh)
{
  const std::size_t n = at_.size(), entries = mesh.ring_of_node().item.size();
  for (auto* all : {&before_, &change_, &right_, &given_, &weight_, &inflow_, &squeezed_, &residual_, &direction_, &image_, &conditioned_,
                    &diagonal_, &lightness_})
    all->resize(n);
  free_.assign(n, Mat<D>::Identity());
  force_.assign(n, Vec<D>::Zero()), velocity_.assign(n, Vec<D>::Zero());
  matrix_.resize(entries), darcy_.resize(entries), push_.resize(entries), divergence_.resize(entries);
}

template <int D>
FlowSystem<D>::FlowSystem(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& subdomain, const OwnNodes& own) : FlowSystem(mesh)
{
  std::vector<std::uint8_t> wanted = spread_by_rings(mesh, own.owned, 1);
  for (Index c = 0; c < mesh.n_cells(); ++c)
    if (subdomain.owns_cell(c))
      for (const Index n : mesh.cell(c))
        wanted[to_size(n)] = 1;
  copies_ = copies_of_nodes(ranks, subdomain, MessageTag::flow_nodes, wanted);
  send(coarse_.take_numbers(subdomain));
}

template <int D>
void FlowSystem<D>::begin_stage()
{
  std::ranges::fill(at_, NodePressure::nothing);
  for (std::vector<Real>* const of_nodes : {&change_, &right_, &given_, &residual_, &direction_, &lightness_})
    std::ranges::fill(*of_nodes, 0);
}

template <int D>
void FlowSystem<D>::find_rows(const FlowModel<D>& m, const FlowCells<D>& cells, const FlowStep<D>& step)
{
  constexpr Real n_corners = D + 1;
  const Mesh<D>& mesh = m.mesh;
  m.field.nodes.in_use.for_each([&](Index n) {
    const auto ring = mesh.ring_of_node()[n];
    const auto first = to_size(mesh.ring_of_node().begin[to_size(n)]);
    for (std::size_t k = first; k < first + ring.size(); ++k)
      matrix_[k] = darcy_[k] = 0, push_[k].setZero(), divergence_[k].setZero();
    weight_[to_size(n)] = inflow_[to_size(n)] = 0;
    at_[to_size(n)] = NodePressure::nothing;
    if (!m.own.has(n))
      return;
    for (const Index c : mesh.cells_of_node()[n]) {
      const FlowCell<D>& row = cells[c];
      if (!row.flows())
        continue;
      at_[to_size(n)] = NodePressure::unknown;
      const auto& corners = mesh.cell(c);
      const auto& gradients = mesh.gradients(c);
      const auto a = static_cast<std::size_t>(std::ranges::find(corners, n) - corners.begin());
      for (std::size_t b = 0; b <= D; ++b) {
        const std::size_t k = first + to_size(static_cast<Index>(std::ranges::lower_bound(ring, corners[b]) - ring.begin()));
        const Real darcy = row.mobility * gradients[a].dot(gradients[b]);
        const Real within = ((a == b ? 2 : 1) / (n_corners * (n_corners + 1)) - 1 / (n_corners * n_corners)) * projection * row.compliance;
        darcy_[k] += darcy;
        matrix_[k] += within + step.dt * darcy + (a == b ? row.storage[a] : 0);
        push_[k] += row.biot / n_corners * gradients[a];
        divergence_[k] += row.biot / n_corners * gradients[b];
      }
      weight_[to_size(n)] += step.dt * row.mobility * step.weight_in(c).dot(gradients[a]);
    }
  });
}

/// Which pressures are given.
template <int D>
void FlowSystem<D>::find_given_pressures(const FlowModel<D>& m, const FlowCells<D>& cells, const FlowStep<D>& step,
                                         const std::vector<Real>& pressure)
{
  const Mesh<D>& mesh = m.mesh;
  const bool retains = m.flow.any_retention();
  const auto give = [&](Index n, Real given) {
    if (!sees_water(n))
      return;
    at_[to_size(n)] = NodePressure::given;
    given_[to_size(n)] = given - pressure[to_size(n)];
  };
  // Where pores may hold less water, a surface lets water out and none in: it drains where the pressure is not below zero and water comes.
  const auto drain = [&](Index n) {
    if (!retains || (pressure[to_size(n)] >= 0 && right_[to_size(n)] >= 0))
      give(n, 0);
  };
  const Real weight = step.weight.norm();
  const auto lie_below = [&](Index n, Real level) {
    if (const Real depth = level - mesh.node(n)[D - 1]; depth > 0)
      give(n, weight * depth);
    else if (at_[to_size(n)] != NodePressure::given)  // by other water at this node
      drain(n);
  };
  constexpr Real dry = -std::numeric_limits<Real>::infinity();
  const Real pond = m.flow.pond ? (*m.flow.pond)(step.end) : dry;
  if (m.flow.surface_drains)
    m.field.nodes.in_use.for_each([&](Index n) {
      if (!is_unknown(n))
        return;
      Real filled = 0, size = 0, least = 1;
      for (const Index c : mesh.cells_of_node()[n]) {
        filled += cells[c].filled, size += mesh.volume(c);
        least = std::min(least, cells[c].filled / mesh.volume(c));
      }
      if (filled < full_around * size && least < Rain<D>::full_cell)
        lie_below(n, pond);
    });
  for (const HeadBoundary& head : m.flow.heads)
    for (const Index n : head.nodes)
      lie_below(n, head.drained ? dry : head.level(step.end));
}

/// How velocities answer to forces.
template <int D>
void FlowSystem<D>::find_responses(const FlowModel<D>& m, const FlowStep<D>& step)
{
  const Nodes<D>& nodes = m.field.nodes;
  nodes.in_use.for_each([&](Index n) {
    free_[to_size(n)].setIdentity();  // conditions of a stage before may have gone
    lightness_[to_size(n)] = m.own.has(n) && nodes.active[to_size(n)] != 0 ? step.kick / nodes.sum[to_size(n)].mass : 0;
  });
  send(lightness_);
  m.conditions.for_each_node(
      [&](Index n) { free_[to_size(n)] = m.conditions.free_changes(nodes.of_field(n), nodes.motion[to_size(n)].v); });
  m.conditions.for_each_dashpot(nodes, [&](Index n, Index, const Mat<D>& share) {
    const Mat<D> free = free_[to_size(n)];
    free_[to_size(n)] = free * share * free;
  });
}

template <int D>
Vec<D> FlowSystem<D>::force_at(const Mesh<D>& mesh, Index n, const std::vector<Real>& x) const
{
  Vec<D> force = Vec<D>::Zero();
  const Vec<D>* row = push_.data() + mesh.ring_of_node().begin[to_size(n)];
  for (const Index u : mesh.ring_of_node()[n])
    force += x[to_size(u)] * *row++;
  return force;
}

template <int D>
void FlowSystem<D>::push(const FlowModel<D>& m, std::vector<Real>& x)
{
  send(x);
  const NodesInUse& in_use = m.field.nodes.in_use;
  in_use.for_each([&](Index n) { force_[to_size(n)] = sees_water(n) ? force_at(m.mesh, n, x) : Vec<D>(Vec<D>::Zero()); });
  m.field.small_mass_nodes.give(
      m.own, [&](Index n, const Vec<D>& f) -> Vec<D> { return free_[to_size(n)] * f; }, force_);
  in_use.for_each([&](Index n) {
    velocity_[to_size(n)] =
        m.own.has(n) ? Vec<D>(lightness_[to_size(n)] * (free_[to_size(n)] * force_[to_size(n)])) : Vec<D>(Vec<D>::Zero());
  });
  m.field.small_mass_nodes.take(
      m.own, [&](Index n, const Vec<D>& v) -> Vec<D> { return free_[to_size(n)] * v; }, velocity_);
  send(velocity_);
}

template <int D>
void FlowSystem<D>::change_velocities(const FlowModel<D>& m, const FlowStep<D>& step, std::vector<Real>& change, ExactSums<Real>& work)
{
  push(m, change);
  Nodes<D>& nodes = m.field.nodes;
  nodes.in_use.for_each([&](Index n) {
    if (!m.own.has(n))
      return;
    nodes.motion[to_size(n)].v += velocity_[to_size(n)];
    nodes.motion[to_size(n)].change += velocity_[to_size(n)];
    if (nodes.active[to_size(n)] != 0)
      nodes.sum[to_size(n)].force += force_[to_size(n)];
  });
  std::vector<Index> with_dashpots;
  m.conditions.for_each_dashpot(nodes, [&](Index n, Index condition, const Mat<D>&) {
    with_dashpots.push_back(n);
    if (sees_water(n) && m.own.has(n))
      m.conditions.dashpots_react(condition, m.mesh.node(n), step.kick * (free_[to_size(n)] * force_[to_size(n)] - force_[to_size(n)]));
  });
  std::ranges::sort(with_dashpots);
  m.conditions.for_each_node([&](Index n) {
    if (sees_water(n) && !std::ranges::binary_search(with_dashpots, n)) {
      const Vec<D> force = nodes.active[to_size(n)] != 0 ? force_[to_size(n)] : force_at(m.mesh, n, change);
      m.conditions.react(n, step.kick * (free_[to_size(n)] * force - force));
    }
  });
  add_ranges(nodes.in_use.own(), work, [&](Index n) {
    const NodeMotion<D>& motion = nodes.motion[to_size(n)];
    return nodes.active[to_size(n)] != 0 ? nodes.sum[to_size(n)].mass * velocity_[to_size(n)].dot(motion.v - 0.5 * motion.change) : 0;
  });
}

/// What flows in, how much the velocities that the step has found squeeze the pores, and what is left to the changes of pressure.
template <int D>
void FlowSystem<D>::find_right_side(const FlowModel<D>& m, const FlowCells<D>& cells, const FlowStep<D>& step,
                                    const std::vector<Real>& pressure)
{
  const NodesInUse& in_use = m.field.nodes.in_use;
  in_use.for_each([&](Index n) { velocity_[to_size(n)] = m.own.has(n) ? m.field.nodes.motion[to_size(n)].v : Vec<D>(Vec<D>::Zero()); });
  send(velocity_);
  for (const InflowBoundary& inflow : m.flow.inflows)
    for (std::size_t k = 0; k < inflow.nodes.size(); ++k)
      if (const Index n = inflow.nodes[k]; sees_water(n))
        inflow_[to_size(n)] += step.dt * m.flow.pace(step.end) * inflow.rate(step.end) * inflow.area[k];
  if (m.flow.rain)
    rain_.add(
        m, cells, step, [&](Index n) { return sees_water(n); }, inflow_, [&](std::vector<std::uint8_t>& open) { send(open); });
  in_use.for_each([&](Index u) {
    if (!sees_water(u))
      return;
    Real darcy = 0, diagonal = 0, squeezed = 0;
    auto k = to_size(m.mesh.ring_of_node().begin[to_size(u)]);
    for (const Index n : m.mesh.ring_of_node()[u]) {
      squeezed += step.dt * divergence_[k].dot(velocity_[to_size(n)]);
      darcy += step.dt * darcy_[k] * pressure[to_size(n)];
      diagonal += step.dt * lightness_[to_size(n)] * divergence_[k].squaredNorm();
      if (n == u)
        diagonal += matrix_[k];
      ++k;
    }
    squeezed_[to_size(u)] = squeezed;
    right_[to_size(u)] = weight_[to_size(u)] + inflow_[to_size(u)] - squeezed - darcy - storage_.surplus(u);
    diagonal_[to_size(u)] = diagonal;
  });
}

template <int D>
void FlowSystem<D>::prepare(const FlowModel<D>& m, const FlowCells<D>& cells, const FlowStep<D>& step, const std::vector<Real>& pressure)
{
  find_rows(m, cells, step);
  storage_.begin(m.mesh, cells);
  m.field.nodes.in_use.for_each([&](Index n) {
    if (m.own.has(n) && sees_water(n))
      storage_.find_surplus(m.mesh, cells, n);
  });
  find_responses(m, step);
  find_right_side(m, cells, step, pressure);
  find_given_pressures(m, cells, step, pressure);
  around_ = at_;
  send(around_);
  prepare_coarse(m, step);
}

template <int D>
void FlowSystem<D>::prepare_coarse(const FlowModel<D>& m, const FlowStep<D>& step)
{
  coarse_.prepare(m.ranks, m.mesh, m.own, around_, matrix_, push_, free_, lightness_, step.dt);
}

template class FlowSystem<2>;
template class FlowSystem<3>;

}  // namespace talus
