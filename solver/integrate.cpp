#include "solver/integrate.hpp"

namespace talus {

template <int D>
template <class F>
void Slaves<D>::for_each_master(const Mesh<D>& mesh, const Nodes<D>& nodes, Index slave, F&& f) const
{
  const auto masters_of = [&](auto&& visit) {
    for (const Index n : mesh.ring_of_node()[slave])
      if (nodes.active[static_cast<std::size_t>(n)])
        visit(n, mass_[static_cast<std::size_t>(n)]);
  };
  const auto second_ring = [&](auto&& visit) {  // a node may be met more than once, which only weighs it
    for (const Index between : mesh.ring_of_node()[slave])
      for (const Index n : mesh.ring_of_node()[between])
        if (nodes.active[static_cast<std::size_t>(n)])
          visit(n, mass_[static_cast<std::size_t>(n)]);
  };
  Real total = 0;
  const auto add = [&](Index, Real mass) { total += mass; };
  const auto give = [&](Index n, Real mass) { f(n, mass / total); };
  masters_of(add);
  if (total > 0) {
    masters_of(give);
    return;
  }
  second_ring(add);
  if (total > 0)
    second_ring(give);
}

template <int D>
bool takes_part(const NodeSum<D>& sum, const Nodes<D>& nodes) noexcept
{
  return sum.is_seen() && sum.mass > nodes.least_share * sum.lightest && sum.mass > nodes.least_share_of_gross * sum.gross;
}

template <int D>
void Slaves<D>::lump(const Mesh<D>& mesh, Nodes<D>& nodes)
{
  slaves_.reserve(nodes.sum.size());
  slaves_.clear();
  mass_.resize(nodes.sum.size());
  for (std::size_t n = 0; n < nodes.sum.size(); ++n) {
    mass_[n] = nodes.sum[n].mass;
    nodes.active[n] = takes_part(nodes.sum[n], nodes) ? 1 : 0;
    if (!nodes.active[n] && (nodes.sum[n].is_seen() || !nodes.sum[n].force.isZero(0)))
      slaves_.push_back(static_cast<Index>(n));
  }
  for (const Index slave : slaves_) {
    const NodeSum<D>& from = nodes.sum[static_cast<std::size_t>(slave)];
    for_each_master(mesh, nodes, slave, [&](Index master, Real share) {
      NodeSum<D>& to = nodes.sum[static_cast<std::size_t>(master)];
      to.mass += share * from.mass;
      to.momentum += share * from.momentum;
      to.force += share * from.force;
    });
  }
}

template <int D>
void Slaves<D>::lump_momentum(const Mesh<D>& mesh, Nodes<D>& nodes) const
{
  for (const Index slave : slaves_)
    for_each_master(mesh, nodes, slave, [&](Index master, Real share) {
      nodes.sum[static_cast<std::size_t>(master)].momentum += share * nodes.sum[static_cast<std::size_t>(slave)].momentum;
    });
}

template <int D>
void Slaves<D>::follow(const Mesh<D>& mesh, const Nodes<D>& nodes, Real end, Walls<D>& walls, std::span<NodeMotion<D>> motion,
                       ExactSums<WallWork>& work) const
{
  for (const Index slave : slaves_) {
    NodeMotion<D> mean;
    for_each_master(mesh, nodes, slave, [&](Index master, Real share) {
      mean.v += share * motion[static_cast<std::size_t>(master)].v;
      mean.change += share * motion[static_cast<std::size_t>(master)].change;
    });
    walls.apply(slave, end, mass_[static_cast<std::size_t>(slave)], mean, work);
    motion[static_cast<std::size_t>(slave)] = mean;
  }
}

template <int D>
void Slaves<D>::follow_velocity(const Mesh<D>& mesh, const Nodes<D>& nodes, const Walls<D>& walls, Real time,
                                std::span<NodeMotion<D>> motion) const
{
  for (const Index slave : slaves_) {
    Vec<D> mean = Vec<D>::Zero();
    for_each_master(mesh, nodes, slave, [&](Index master, Real share) { mean += share * motion[static_cast<std::size_t>(master)].v; });
    motion[static_cast<std::size_t>(slave)].v = walls.held(slave, time, mean);
  }
}

template class Slaves<2>;
template class Slaves<3>;

}  // namespace talus
