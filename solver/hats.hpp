#pragma once
// The solver's side of a kernel with a node part: particles see the hats of their cell, operators stand between hats and unknowns.
#include "kernels/node_operators.hpp"
#include "solver/blocks.hpp"

namespace talus {

/// What particles add up to on a hat.
template <int D>
struct alignas(64) HatSum {
  Real mass{};                          ///< sum B m [kg]
  float lightest = NodeSum<D>::unseen;  ///< as in NodeSum
  Vec<D> momentum = Vec<D>::Zero();     ///< sum B m (v + A (x_n - x_p)) [kg m/s]
  Vec<D> force = Vec<D>::Zero();        ///< sum B f of loads on particles [N]
  Mat<D> affine = Mat<D>::Zero();       ///< sum B m A [kg/s]
  Mat<D> tension = Mat<D>::Zero();      ///< sum B V sigma [N m]
  bool is_seen() const noexcept { return lightest < NodeSum<D>::unseen; }
  void clear_momentum() noexcept
  {
    momentum.setZero();
    affine.setZero();
  }
  void add_momentum(const HatSum& other) noexcept
  {
    momentum += other.momentum;
    affine += other.affine;
  }
  HatSum& operator+=(const HatSum& other) noexcept
  {
    mass += other.mass;
    lightest = std::min(lightest, other.lightest);
    momentum += other.momentum;
    force += other.force;
    affine += other.affine;
    tension += other.tension;
    return *this;
  }
};

template <int D>
struct Hats {
  std::vector<HatSum<D>> sum;
  std::vector<HatMotion<D>> motion;
};

/// What the particles of a kernel deposit, and what they read.
template <class K, int D>
using SumRow = std::conditional_t<HasNodePart<K, D>, HatSum<D>, NodeSum<D>>;
template <class K, int D>
using MotionRow = std::conditional_t<HasNodePart<K, D>, HatMotion<D>, NodeMotion<D>>;

/// Hats -> unknowns, the transpose of the way back:
///
///     m_v = sum_n S_nv m_n     p_v = sum_n S_nv (p_n + K_n (x_v - c_n))     f_v = sum_n (S_nv f_n - Z_n D_nv)
///
/// with K the affine moment and Z the tension; c_n = sum_v S_nv x_v keeps the momentum whatever S is.
template <int D>
void collect(const NodeOperators<D>& operators, const Mesh<D>& mesh, const std::vector<HatSum<D>>& hats, std::vector<NodeSum<D>>& sum)
{
  for_each_node(std::span(sum), [&](Index v) {
    NodeSum<D> total;
    const auto ring = operators.ring(v);
    const auto S = operators.S_column(v);
    const auto gradients = operators.D_column(v);
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const HatSum<D>& hat = hats[static_cast<std::size_t>(ring[k])];
      if (!hat.is_seen())
        continue;
      const Real mass = S[k] * hat.mass;
      total.mass += mass;
      total.gross += static_cast<float>(std::abs(mass));
      total.lightest = std::min(total.lightest, hat.lightest);
      total.momentum += S[k] * (hat.momentum + hat.affine * (mesh.node(v) - operators.centre(ring[k])));
      total.force += S[k] * hat.force - hat.tension * gradients[k];
    }
    return total;
  });
}

/// The same for momentum alone.
template <int D>
void collect_momentum(const NodeOperators<D>& operators, const Mesh<D>& mesh, const std::vector<HatSum<D>>& hats,
                      std::vector<NodeSum<D>>& sum)
{
  parallel_for(static_cast<Index>(sum.size()), [&](Index v) {
    Vec<D> momentum = Vec<D>::Zero();
    const auto ring = operators.ring(v);
    const auto S = operators.S_column(v);
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const HatSum<D>& hat = hats[static_cast<std::size_t>(ring[k])];
      if (hat.is_seen())
        momentum += S[k] * (hat.momentum + hat.affine * (mesh.node(v) - operators.centre(ring[k])));
    }
    sum[static_cast<std::size_t>(v)].momentum = momentum;
  });
}

/// Unknowns -> hats that particles see: v_n = sum_v S_nv v_v and the same for changes, L_n = sum_v v_v (x) D_nv; walls hold the rows.
template <int D>
void spread(const NodeOperators<D>& operators, const std::vector<NodeMotion<D>>& nodes, Hats<D>& hats)
{
  parallel_for(operators.n_nodes(), [&](Index n) {
    if (!hats.sum[static_cast<std::size_t>(n)].is_seen())
      return;
    HatMotion<D> hat;
    const auto ring = operators.ring(n);
    const auto S = operators.S_row(n);
    const auto gradients = operators.D_row(n);
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const NodeMotion<D>& node = nodes[static_cast<std::size_t>(ring[k])];
      hat.v += S[k] * node.v;
      hat.change += S[k] * node.change;
      hat.L += node.v * gradients[k].transpose();
    }
    hats.motion[static_cast<std::size_t>(n)] = hat;
  });
}

/// The gradient of remapped velocities; the step's own velocity goes to `change`.
template <int D>
void spread_gradient(const NodeOperators<D>& operators, const std::vector<NodeMotion<D>>& remapped, Hats<D>& hats)
{
  parallel_for(operators.n_nodes(), [&](Index n) {
    if (!hats.sum[static_cast<std::size_t>(n)].is_seen())
      return;
    Mat<D> L = Mat<D>::Zero();
    const auto ring = operators.ring(n);
    const auto gradients = operators.D_row(n);
    for (std::size_t k = 0; k < ring.size(); ++k)
      L += remapped[static_cast<std::size_t>(ring[k])].v * gradients[k].transpose();
    HatMotion<D>& hat = hats.motion[static_cast<std::size_t>(n)];
    hat.change = hat.v;
    hat.L = L;
  });
}

}  // namespace talus
