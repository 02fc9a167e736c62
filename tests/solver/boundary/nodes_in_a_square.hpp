#pragma once
// A small square of nodes, of which single ones take part: shared by the tests of boundary conditions.
#include <stdexcept>

#include "tests/solver/blocks_of_particles.hpp"

namespace talus::testing {

/// Adds a condition on a set of facets of the mesh, such as "y_min", or on its nodes.
template <int D>
void add_on(BoundaryConditions<D>& conditions, const Mesh<D>& mesh, const std::string& set, const AnyCondition<D>& kind)
{
  const bool on_facets = std::visit([]<class C>(const C&) { return is_on_facets<C>; }, kind);
  if (on_facets)
    conditions.add({.name = set, .kind = kind}, mesh, *mesh.facet_set(set));
  else
    conditions.add({.name = set, .kind = kind}, mesh, *mesh.node_set(set));
}

/// Two by two cells; no node is active until a test gives it a mass and a motion.
struct NodesInASquare {
  Mesh<2> mesh;
  BoundaryConditions<2> walls;
  Nodes<2> nodes;
  ExactSums<BoundaryWork> work;

  NodesInASquare(Real side, Real kick) : mesh(box<2>(Vec<2>::Zero(), {side, side}, {2, 2}))
  {
    nodes.sum.resize(static_cast<std::size_t>(mesh.n_nodes()));
    nodes.motion.resize(nodes.sum.size());
    nodes.active.assign(nodes.sum.size(), 0);
    nodes.kick = kick;
  }
  std::size_t node(const Vec<2>& place) const
  {
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      if ((mesh.node(n) - place).norm() < 1e-9)
        return static_cast<std::size_t>(n);
    throw std::logic_error("no node there");
  }
  NodeMotion<2>& set(const Vec<2>& place, Real mass, const NodeMotion<2>& motion)
  {
    const std::size_t n = node(place);
    nodes.active[n] = 1;
    nodes.sum[n].mass = mass;
    return nodes.motion[n] = motion;
  }
};

}  // namespace talus::testing
