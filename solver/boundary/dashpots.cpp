#include "solver/boundary/dashpots.hpp"

#include <bit>
#include <map>

namespace talus {

template <int D>
void Dashpots<D>::add(const Mesh<D>& mesh, Index condition, DashpotsOfNodes<D> dashpots)
{
  std::map<Index, std::size_t> known;
  for (std::size_t k = 0; k < nodes_.size(); ++k)
    known.emplace(nodes_[k].node, k);
  for (auto& [node, dashpot] : dashpots) {
    dashpot.condition = condition;
    if (const auto at = known.find(node); at != known.end())
      nodes_[at->second].dashpots.push_back(std::move(dashpot));
    else
      nodes_.push_back({.node = node, .row = n_nodes_++, .place = mesh.node(node), .dashpots = {std::move(dashpot)}});
  }
}

template <int D>
void Dashpots<D>::restrict_to(const Subdomain& subdomain)
{
  std::erase_if(nodes_, [&](DashpotNode& at) {
    at.node = subdomain.local_node(at.node);
    at.counted = at.node != none && subdomain.owns_node(at.node);
    return at.node == none;
  });
}

template <int D>
void Dashpots<D>::find_reactions(Communicator& ranks, const Nodes<D>& nodes)
{
  std::vector<std::int64_t> bits(D * n_nodes_, 0);  // the bits of a number come from one rank, the others add zero
  for (const DashpotNode& at : nodes_) {
    const auto n = static_cast<std::size_t>(at.node);
    const Vec<D> reaction = -nodes.sum[n].mass / nodes.kick * nodes.motion[n].change;
    for (int d = 0; d < D && at.counted && nodes.active[n]; ++d)
      bits[D * at.row + static_cast<std::size_t>(d)] = std::bit_cast<std::int64_t>(reaction[d]);
  }
  ranks.sum(bits);
  for (const std::int64_t number : bits)
    reaction_.push_back(std::bit_cast<Real>(number));
  reactions_known_ = true;
}

/// Implicit in the new velocity v, because a dashpot may absorb more momentum in a step than a light node has:
///   m (v - v_free) / kick = F - C v + reaction
/// where C is the resistance of the dashpots and F the force on the node at rest.  Waves and free fields are those of the time of v.
template <int D>
void Dashpots<D>::apply(std::span<const BoundaryCondition<D>> conditions, const DynamicPhase& phase, Real mid, Communicator& ranks,
                        Nodes<D>& nodes)
{
  if (!reactions_known_)
    find_reactions(ranks, nodes);
  for (DashpotNode& at : nodes_) {
    const auto n = static_cast<std::size_t>(at.node);
    at.impulse.setZero();
    at.waves = 0;
    if (!nodes.active[n])
      continue;
    const Real mass = nodes.sum[n].mass;
    NodeMotion<D>& motion = nodes.motion[n];
    Mat<D> inertia = mass * Mat<D>::Identity();
    Vec<D> momentum = mass * motion.v + nodes.kick * Eigen::Map<const Vec<D>>(&reaction_[D * at.row]);
    for (const Dashpot<D>& dashpot : at.dashpots)
      std::visit(
          [&]<class C>(const C& condition) {
            if constexpr (HasDashpots<C>) {
              inertia += nodes.kick * dashpot.resistance;
              const Vec<D> wave = condition.free_velocity(dashpot, at.place, phase, mid);
              momentum += nodes.kick * condition.force_at_rest(dashpot, wave);
              at.waves += nodes.kick * wave.dot(dashpot.resistance * wave);
            }
          },
          conditions[static_cast<std::size_t>(dashpot.condition)].kind);
    const Mat<D> mobility = inertia.inverse();
    const Vec<D> by = mobility * momentum - motion.v;
    at.share = mass * mobility;
    motion.v += by, motion.change += by;
    at.impulse = mass * by;
  }
}

template class Dashpots<2>;
template class Dashpots<3>;

}  // namespace talus
