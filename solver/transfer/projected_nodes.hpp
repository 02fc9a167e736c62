#pragma once
// Use of node operators by the solver: particles use the linear shape functions of their cell, and operators connect these with the
// unknowns.
#include "kernels/node_operators.hpp"
#include "solver/state/nodes.hpp"
#include "solver/state/owned_nodes.hpp"
#include "solver/transfer/extension.hpp"
#include "solver/transfer/interfaces.hpp"

namespace talus {

template <int D>
struct ProjectedNodes {
  SparseRows<ProjectedNodeSum<D>> sum;
  SparseRows<ProjectedNodeMotion<D>> motion;
  std::vector<std::uint8_t> late;  ///< several ranks: linear shape functions that use nodes of other ranks
  void find_late(const Mesh<D>& mesh, const OwnNodes& own)
  {
    late.resize(sum.size());
    for (Index n = 0; n < mesh.n_nodes(); ++n)
      late[static_cast<std::size_t>(n)] = std::ranges::all_of(mesh.ring_of_node()[n], [&](Index m) { return own.has(m); }) ? 0 : 1;
  }
};

/// Maps sums on linear shape functions to the unknowns, by the transpose of the map of the motion:
///
///     m_v = sum_n S_nv m_n     p_v = sum_n S_nv (p_n + K_n (x_v - c_n))     f_v = sum_n (S_nv f_n - Z_n D_nv)
///
/// with the affine moment K and the tension Z.  p_n refers to c_n = sum_v S_nv x_v, the position at which the row of n reads values: so
/// momentum is conserved and linear fields are passed on exactly, for any S.  Nodes that are not `own` are left out.  The reference for the
/// mass of a node is the mean mass of the linear shape functions around.  At nodes between materials Z_n D_nv is the sum over these.
template <int D>
void project_sums(const NodeOperators<D>& operators, const Interfaces<D>& interfaces, const Mesh<D>& mesh, const OwnNodes& own,
                  const SparseRows<ProjectedNodeSum<D>>& projected, const NodesInUse& in_use, SparseRows<NodeSum<D>>& sum)
{
  in_use.for_each([&](Index v) {
    NodeSum<D>& total = sum[static_cast<std::size_t>(v)] = {};
    if (!own.has(v))
      return;
    Real around = 0;
    int ring = 0;
    operators.for_each_in_column(v, [&](Index n, Real S, const Vec<D>& gradient) {
      const ProjectedNodeSum<D>& projected_node = projected[static_cast<std::size_t>(n)];
      ++ring;
      around += projected_node.mass;
      if (!projected_node.is_seen())
        return;
      total.mass += S * projected_node.mass;
      total.see_particles(projected_node.lightest);
      total.momentum += S * projected_node.momentum_about(mesh.node(v) - operators.centre(n));
      total.force += S * projected_node.force;
      total.force -= interfaces.is_mixed(n) ? interfaces.pull(mesh, n, v) : pull_of<D>(projected_node.tension, gradient);
    });
    total.gross = static_cast<float>(around / ring);
  });
}

/// The force of the stress on node v, -sum_n Z_n D_nv [N].
template <int D>
Vec<D> stress_force(const NodeOperators<D>& operators, const Interfaces<D>& interfaces, const Mesh<D>& mesh,
                    const SparseRows<ProjectedNodeSum<D>>& projected, Index v)
{
  Vec<D> force = Vec<D>::Zero();
  operators.for_each_in_column(v, [&](Index n, Real, const Vec<D>& gradient) {
    const ProjectedNodeSum<D>& projected_node = projected[static_cast<std::size_t>(n)];
    if (projected_node.is_seen())
      force -= interfaces.is_mixed(n) ? interfaces.pull(mesh, n, v) : pull_of<D>(projected_node.tension, gradient);
  });
  return force;
}

/// The momentum only.
template <int D>
void project_momentum(const NodeOperators<D>& operators, const Mesh<D>& mesh, const OwnNodes& own,
                      const SparseRows<ProjectedNodeSum<D>>& projected, const NodesInUse& in_use, SparseRows<NodeSum<D>>& sum)
{
  in_use.for_each([&](Index v) {
    if (!own.has(v))
      return;
    Vec<D> momentum = Vec<D>::Zero();
    operators.for_each_in_column(v, [&](Index n, Real S, const Vec<D>&) {
      const ProjectedNodeSum<D>& projected_node = projected[static_cast<std::size_t>(n)];
      if (projected_node.is_seen())
        momentum += S * projected_node.momentum_about(mesh.node(v) - operators.centre(n));
    });
    sum[static_cast<std::size_t>(v)].momentum = momentum;
  });
}

/// Calls f(n, linear shape function) for the linear shape functions that particles use, in parallel; f writes their values.  Those that use
/// nodes of other ranks wait until arrive() returns.
template <int D, class Arrive, class F>
void for_each_seen_hat(const NodesInUse& in_use, ProjectedNodes<D>& projected, Arrive&& arrive, F&& f)
{
  for (const bool late : {false, true}) {
    if (late)
      arrive();
    if (late && projected.late.empty())
      break;
    in_use.for_each([&](Index n) {
      const auto i = static_cast<std::size_t>(n);
      if (projected.sum[i].is_seen() && (projected.late.empty() || (projected.late[i] != 0) == late))
        f(n, projected.motion[i]);
    });
  }
}

/// The accelerations S a of the linear shape functions that particles use, from those of the unknowns.  arrive() receives accelerations of
/// nodes of other ranks.
template <int D, class Arrive>
void project_acceleration(const NodeOperators<D>& operators, const NodesInUse& in_use, Arrive&& arrive, ProjectedNodes<D>& projected,
                          const std::vector<Vec<D>>& a)
{
  for_each_seen_hat(in_use, projected, arrive, [&](Index n, ProjectedNodeMotion<D>& projected_node) {
    projected_node.change.setZero();
    operators.for_each_in_row(n, [&](Index v, Real S, const Vec<D>&) { projected_node.change += S * a[static_cast<std::size_t>(v)]; });
  });
}

/// Then replaces the accelerations of the unknowns by the part that acts on particles, M^-1 S^T m S a.  S has almost no response to
/// checkerboard modes of the unknowns: what remains of them moves no particle and must not count in the criterion of equilibrium.
/// for_each_part(v, f) calls f for the projected nodes of each field whose mass node v has.
template <int D, class ForEachPart>
void filter_acceleration(const NodeOperators<D>& operators, const OwnNodes& own, const NodesInUse& in_use, ForEachPart&& for_each_part,
                         std::vector<Vec<D>>& a)
{
  in_use.for_each([&](Index v) {
    Real mass = 0;
    Vec<D> sum = Vec<D>::Zero();
    if (!own.has(v)) {
      a[static_cast<std::size_t>(v)] = sum;
      return;
    }
    for_each_part(v, [&](const ProjectedNodes<D>& projected) {
      operators.for_each_in_column(v, [&](Index n, Real S, const Vec<D>&) {
        const Real share = S * projected.sum[static_cast<std::size_t>(n)].mass;
        mass += share;
        sum += share * projected.motion[static_cast<std::size_t>(n)].change;
      });
    });
    a[static_cast<std::size_t>(v)] = mass > 0 ? Vec<D>(sum / mass) : Vec<D>(Vec<D>::Zero());
  });
}

/// From unknowns to the linear shape functions that particles use: v_n = sum_v S_nv v_v, changes likewise, L_n = sum_v v_v (x) D_nv.
/// arrive() receives the motion of nodes of other ranks.
template <int D, class Arrive>
void project_motion(const NodeOperators<D>& operators, const Extension<D>& extension, const NodesInUse& in_use,
                    const SparseRows<NodeMotion<D>>& nodes, Arrive&& arrive, ProjectedNodes<D>& projected)
{
  for_each_seen_hat(in_use, projected, arrive, [&](Index n, ProjectedNodeMotion<D>& row) {
    ProjectedNodeMotion<D> projected_node;
    operators.for_each_in_row(n, [&](Index v, Real S, const Vec<D>& gradient) {
      const NodeMotion<D>& node = nodes[static_cast<std::size_t>(v)];
      projected_node.v += S * node.v;
      projected_node.change += S * node.change;
      projected_node.L += extension.velocity(v, node.v) * gradient.transpose();
    });
    row = projected_node;
  });
}

/// Velocities as they are, for gradients that are not extended at surfaces.
struct NotExtended {
  template <class V>
  const V& velocity(Index, const V& v) const noexcept
  {
    return v;
  }
};

/// Gradients of the remapped velocities on the linear shape functions that particles use; `extension` is Extension or NotExtended.
template <int D, class OfSurfaces, class Arrive>
void project_gradient(const NodeOperators<D>& operators, const OfSurfaces& extension, const NodesInUse& in_use,
                      const SparseRows<NodeMotion<D>>& remapped, Arrive&& arrive, ProjectedNodes<D>& projected,
                      SparseRows<Mat<D>>& gradients)
{
  for_each_seen_hat(in_use, projected, arrive, [&](Index n, ProjectedNodeMotion<D>&) {
    Mat<D> L = Mat<D>::Zero();
    operators.for_each_in_row(n, [&](Index v, Real, const Vec<D>& gradient) {
      L += extension.velocity(v, remapped[static_cast<std::size_t>(v)].v) * gradient.transpose();
    });
    gradients[static_cast<std::size_t>(n)] = L;
  });
}

}  // namespace talus
