#include "solver/boundary/small_mass_nodes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace talus {

template <int D>
SmallMassNodes<D>::SmallMassNodes(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& subdomain, const OwnNodes& own)
    : near_(copies_of_nodes(ranks, subdomain, MessageTag::small_mass_nodes, spread_by_rings(mesh, own.owned, 2)))
{}

namespace {

/// Rows of columns that are sent together.
template <class... Column>
struct Together {
  std::tuple<Column&...> columns;
  auto operator[](std::size_t n) const noexcept
  {
    return std::apply([n](auto&... column) { return std::tie(column[n]...); }, columns);
  }
};

}  // namespace

/// The fit has a slope along the principal axes in which the variance of the places of the hosts is at least this share of their mean
/// squared distance, and a smaller one in proportion below it.
constexpr Real least_spread = 0.05;
/// And none if a host would lose more than this share of its mass; several nodes of small mass may have the same host.
constexpr Real largest_loss = 0.1;

template <int D>
void SmallMassNodes<D>::list_hosts(const Mesh<D>& mesh, std::size_t place)
{
  const Index node = small_[place];
  const auto& ring = mesh.ring_of_node();
  const std::uint64_t beside = fits_[static_cast<std::size_t>(node)].beside;
  const std::size_t begin = hosts_.size();
  // place_ of an active node is 0, but here one more than its place among these hosts.
  std::uint64_t bit = 1;
  for (const Index between : ring[node]) {
    if (beside == 0 || (beside & bit) != 0)
      for (const Index n : ring[between])
        if (std::size_t& at = place_[static_cast<std::size_t>(n)]; weight_[static_cast<std::size_t>(n)] > 0 && at == 0) {
          hosts_.push_back({n, 0});
          at = hosts_.size() - begin;
        }
    bit <<= 1;
  }
  for (const Index between : ring[node])
    for (const Index n : ring[between])
      if (const auto i = static_cast<std::size_t>(n); weight_[i] > 0 && place_[i] > 0)
        hosts_[begin + place_[i] - 1].share += weight_[i];
  for (std::size_t i = begin; i < hosts_.size(); ++i)
    place_[static_cast<std::size_t>(hosts_[i].node)] = 0;
  std::ranges::sort(hosts_.begin() + static_cast<std::ptrdiff_t>(begin), hosts_.end(), {}, &Host::node);
  ranges_[place] = {begin, hosts_.size()};
  place_[static_cast<std::size_t>(node)] = place;
}

template <int D>
auto SmallMassNodes<D>::hosts_of(Index small_mass_node) noexcept -> std::span<Host>
{
  const HostRange& range = ranges_[place_[static_cast<std::size_t>(small_mass_node)]];
  return std::span(hosts_).subspan(range.begin, range.end - range.begin);
}

template <int D>
void SmallMassNodes<D>::fit_to_hosts(const Mesh<D>& mesh, Index small_mass_node)
{
  HostFit& fit = fits_[static_cast<std::size_t>(small_mass_node)];
  const auto apart = [&](const Host& host) { return Vec<D>(mesh.node(host.node) - mesh.node(small_mass_node)); };
  Real total = 0;
  Vec<D> first = Vec<D>::Zero();
  Mat<D> second = Mat<D>::Zero();
  for (const Host& host : hosts_of(small_mass_node)) {
    const Vec<D> r = apart(host);
    total += host.share;
    first += host.share * r;
    second += host.share * r * r.transpose();
  }
  fit.level = total > 0 ? 1 / total : 0;
  fit.slope.setZero();
  if (!(second.trace() > 0))  // no hosts, or its twin across a cut alone
    return;
  const Vec<D> centre = first / total;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<Real, D, D>> spread(second / total - centre * centre.transpose());
  const Real least = least_spread * second.trace() / total;
  Vec<D> along = spread.eigenvectors().transpose() * centre;
  for (int i = 0; i < D; ++i)
    along[i] /= std::max(spread.eigenvalues()[i], least) * total;
  const Vec<D> slope = -(spread.eigenvectors() * along);
  const Real level = fit.level - slope.dot(centre);
  for (const Host& host : hosts_of(small_mass_node))
    if (fit.mass * host.share * (level + slope.dot(apart(host))) < -largest_loss * weight_[static_cast<std::size_t>(host.node)])
      return;
  fit.level = level;
  fit.slope = slope;
}

template <int D>
void SmallMassNodes<D>::set_shares(const Mesh<D>& mesh, Index small_mass_node)
{
  const HostFit& fit = fits_[static_cast<std::size_t>(small_mass_node)];
  for (Host& host : hosts_of(small_mass_node))
    host.share *= fit.level + fit.slope.dot(mesh.node(host.node) - mesh.node(small_mass_node));
}

template <int D>
void SmallMassNodes<D>::set_momentum(Index small_mass_node, const Vec<D>& momentum)
{
  Vec<D> fitted = Vec<D>::Zero();
  for_each_host(small_mass_node, [&](Index host, Real share) { fitted += share * velocity_[static_cast<std::size_t>(host)]; });
  HostFit& fit = fits_[static_cast<std::size_t>(small_mass_node)];
  fit.momentum = momentum - fit.mass * fitted;
}

template <int D>
void SmallMassNodes<D>::exchange_neighbours(const Mesh<D>& mesh, const Nodes<D>& nodes)
{
  near_.send(is_small_, OfMarked{itself, is_small_});
  near_.take(is_small_, OfMarked{itself, is_small_});
  const auto has_small_mass = [&](Index n) { return is_small_[static_cast<std::size_t>(n)] != 0; };
  small_here_.clear(), small_there_.clear();
  may_host_.assign(is_small_.size(), 0);
  for (const NeighbourRank& border : near_.borders()) {
    small_here_.push_back(std::ranges::any_of(border.out, has_small_mass) ? 1 : 0);
    small_there_.push_back(std::ranges::any_of(border.in, has_small_mass) ? 1 : 0);
    for (const Index n : border.in)
      if (has_small_mass(n)) {
        small_.push_back(n);
        for (const Index between : mesh.ring_of_node()[n])
          for (const Index around : mesh.ring_of_node()[between])
            may_host_[static_cast<std::size_t>(around)] = nodes.active[static_cast<std::size_t>(around)];
      }
  }
  send_from_hosts(Together<std::vector<Real>, SparseRows<Vec<D>>>{{weight_, velocity_}},
                  OfMarked{[](const auto& row) { return row; }, may_host_});
}

template <int D>
void SmallMassNodes<D>::lump(const Mesh<D>& mesh, const OwnNodes& own, Nodes<D>& nodes, ActiveNodes which)
{
  for (const Index node : small_)
    place_[static_cast<std::size_t>(node)] = 0;
  small_.reserve(nodes.sum.size());
  small_.clear();
  weight_.resize(nodes.sum.size());
  is_small_.resize(nodes.sum.size());
  velocity_.resize(nodes.sum.size());
  fits_.resize(nodes.sum.size());
  place_.resize(nodes.sum.size());
  for (const NeighbourRank& border : near_.borders())
    for (const Index n : border.in)  // which may be in use on another rank alone
      is_small_[static_cast<std::size_t>(n)] = 0, weight_[static_cast<std::size_t>(n)] = 0;
  nodes.in_use.for_each_ascending([&](Index node) {
    const auto n = static_cast<std::size_t>(node);
    const NodeSum<D>& sum = nodes.sum[n];
    if (which == ActiveNodes::by_mass)
      nodes.active[n] = has_own_motion(sum, nodes) ? 1 : 0;
    weight_[n] = nodes.active[n] ? sum.mass : 0;
    if (weight_[n] > 0)
      velocity_[n] = sum.momentum / sum.mass;
    // In trials also own nodes that particles do not reach any more: forces of the beginning of the increment are still given to them.
    const bool is_of_trial = which == ActiveNodes::as_before && own.has(node);
    is_small_[n] = !nodes.active[n] && (sum.is_seen() || !sum.force.isZero(0) || is_of_trial) ? 1 : 0;
    if (is_small_[n] != 0)
      small_.push_back(node);
  });
  if (!near_.borders().empty()) {
    exchange_neighbours(mesh, nodes);
    std::ranges::sort(small_);
  }
  hosts_.clear();
  ranges_.resize(small_.size());
  for (std::size_t place = 0; place < small_.size(); ++place)
    if (const Index node = small_[place]; own.has(node)) {
      const NodeSum<D>& sum = nodes.sum[static_cast<std::size_t>(node)];
      HostFit& fit = fits_[static_cast<std::size_t>(node)];
      fit.mass = sum.mass;
      fit.beside = 0;
      std::uint64_t bit = 1;
      for (const Index near : mesh.ring_of_node()[node])
        fit.beside |= weight_[static_cast<std::size_t>(near)] > 0 ? bit : 0, bit <<= 1;
      list_hosts(mesh, place);
      fit_to_hosts(mesh, node);
      set_shares(mesh, node);
      set_momentum(node, sum.momentum);
    }
  using Rows = Together<SparseRows<NodeSum<D>>, SparseRows<HostFit>>;
  const auto parts = [](const std::tuple<NodeSum<D>&, HostFit&>& row) {
    const auto& [sum, fit] = row;
    return std::tie(sum.force, fit.level, fit.slope, fit.beside, fit.mass, fit.momentum);
  };
  send_to_hosts(Rows{{nodes.sum, fits_}}, OfMarked{parts, is_small_});
  for (std::size_t place = 0; place < small_.size(); ++place)
    if (!own.has(small_[place])) {
      list_hosts(mesh, place);
      set_shares(mesh, small_[place]);
    }
  give_to_hosts(own, nodes, [](NodeSum<D>& to, Real share, const HostFit& fit, const Vec<D>& velocity, const NodeSum<D>& from) {
    to.mass += share * fit.mass;
    to.momentum += share * (fit.momentum + fit.mass * velocity);
    to.force += share * from.force;
  });
}

template <int D>
void SmallMassNodes<D>::lump_momentum(const OwnNodes& own, Nodes<D>& nodes)
{
  nodes.in_use.for_each([&](Index node) {
    const auto n = static_cast<std::size_t>(node);
    if (weight_[n] > 0)
      velocity_[n] = nodes.sum[n].momentum / weight_[n];
  });
  send_from_hosts(velocity_, OfMarked{itself, may_host_});
  for (const Index n : small_)
    if (own.has(n))
      set_momentum(n, nodes.sum[static_cast<std::size_t>(n)].momentum);
  send_to_hosts(fits_, OfMarked{[](auto& fit) { return std::tie(fit.momentum); }, is_small_});
  give_to_hosts(own, nodes, [](NodeSum<D>& to, Real share, const HostFit& fit, const Vec<D>& velocity, const NodeSum<D>&) {
    to.momentum += share * (fit.momentum + fit.mass * velocity);
  });
}

template <int D>
template <class F>
void SmallMassNodes<D>::give_to_hosts(const OwnNodes& own, Nodes<D>& nodes, F&& f) const
{
  for (const Index node : small_) {
    const auto n = static_cast<std::size_t>(node);
    for_each_host(node, [&](Index host, Real share) {
      const auto h = static_cast<std::size_t>(host);
      if (own.has(host))
        f(nodes.sum[h], share, fits_[n], velocity_[h], nodes.sum[n]);
    });
  }
}

template <int D>
void SmallMassNodes<D>::extrapolate(const OwnNodes& own, const Kick& kick, BoundaryConditions<D>& conditions, Nodes<D>& nodes,
                                    ExactSums<BoundaryWork>& work)
{
  SparseRows<NodeMotion<D>>& motion = nodes.motion;
  send_from_hosts(motion, OfMarked{[](auto& row) { return NodeMotion<D>::parts(row); }, may_host_});
  for (const Index n : small_) {
    if (!own.has(n))
      continue;
    NodeMotion<D> fitted;
    for_each_host(n, [&](Index host, Real share) {
      fitted.v += share * motion[static_cast<std::size_t>(host)].v;
      fitted.change += share * motion[static_cast<std::size_t>(host)].change;
    });
    conditions.apply(nodes.of_field(n), kick, fits_[static_cast<std::size_t>(n)].mass, fitted, work);
    motion[static_cast<std::size_t>(n)] = fitted;
  }
}

template <int D>
void SmallMassNodes<D>::extrapolate_velocity(const OwnNodes& own, const BoundaryConditions<D>& conditions, Real mid, Nodes<D>& nodes)
{
  SparseRows<NodeMotion<D>>& motion = nodes.remapped;
  send_from_hosts(motion, OfMarked{[](auto& row) { return std::tie(row.v); }, may_host_});
  for (const Index n : small_) {
    if (!own.has(n))
      continue;
    Vec<D> fitted = Vec<D>::Zero();
    for_each_host(n, [&](Index host, Real share) { fitted += share * motion[static_cast<std::size_t>(host)].v; });
    motion[static_cast<std::size_t>(n)].v = conditions.held(nodes.of_field(n), mid, fitted);
  }
}

template class SmallMassNodes<2>;
template class SmallMassNodes<3>;

}  // namespace talus
