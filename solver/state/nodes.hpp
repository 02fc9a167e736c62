#pragma once
// Nodal rows: what particles deposit, and what they read back.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "core/types.hpp"
#include "kernels/symmetric.hpp"

namespace talus {

/// What the particles around a node add up to.  One cache line; `lightest` and `gross` are for comparisons only.
template <int D>
struct alignas(64) NodeSum {
  Real mass{};              ///< [kg]
  float lightest = unseen;  ///< mass of the lightest particle whose stencil holds the node [kg]
  float
      gross{};  ///< what `mass` is measured by [kg]: sum over cells of |mass from the cell|, or the mean mass of the linear shape functions around
  Vec<D> momentum = Vec<D>::Zero();  ///< [kg m/s]
  Vec<D> force = Vec<D>::Zero();     ///< internal force and loads, without gravity [N]
  void clear_momentum() noexcept { momentum.setZero(); }
  void add_momentum(const NodeSum& other) noexcept { momentum += other.momentum; }
  bool has_momentum() const noexcept { return !momentum.isZero(0); }
  /// For messages, without padding.
  template <class Self>
  static auto parts(Self& sum) noexcept
  {
    return std::tie(sum.mass, sum.lightest, sum.gross, sum.momentum, sum.force);
  }
  template <class Self>
  static auto momentum_parts(Self& sum) noexcept
  {
    return std::tie(sum.momentum);
  }
  static constexpr float unseen = std::numeric_limits<float>::infinity();
  bool is_seen() const noexcept { return lightest < unseen; }
  NodeSum& operator+=(const NodeSum& other) noexcept
  {
    mass += other.mass;
    lightest = std::min(lightest, other.lightest);
    gross += other.gross;
    momentum += other.momentum;
    force += other.force;
    return *this;
  }
};

/// What particles add up to on a linear shape function: with its share B, momentum sum B m (v + A (c_n - c_p)) with c_p = sum_n B_n c_n, and what the
/// operators need besides.
template <int D>
struct ProjectedNodeSum : NodeSum<D> {
  Mat<D> affine = Mat<D>::Zero();  ///< sum B m A [kg/s]
  Symmetric<D> tension{};          ///< sum B V sigma [N m]
  Vec<D> momentum_about(const Vec<D>& arm) const noexcept { return this->momentum + affine * arm; }
  void clear_momentum() noexcept
  {
    NodeSum<D>::clear_momentum();
    affine.setZero();
  }
  void add_momentum(const ProjectedNodeSum& other) noexcept
  {
    NodeSum<D>::add_momentum(other);
    affine += other.affine;
  }
  bool has_momentum() const noexcept { return NodeSum<D>::has_momentum() || !affine.isZero(0); }
  template <class Self>
  static auto parts(Self& sum) noexcept
  {
    return std::tuple_cat(NodeSum<D>::parts(sum), std::tie(sum.affine, sum.tension));
  }
  template <class Self>
  static auto momentum_parts(Self& sum) noexcept
  {
    return std::tie(sum.momentum, sum.affine);
  }
  ProjectedNodeSum& operator+=(const ProjectedNodeSum& other) noexcept
  {
    NodeSum<D>::operator+=(other);
    affine += other.affine;
    for (int k = 0; k < Symmetric<D>::size; ++k)
      tension.entry[k] += other.tension.entry[k];
    return *this;
  }
};

/// How a node moves.  One cache line in 3-D.
template <int D>
struct alignas(64) NodeMotion {
  Vec<D> v = Vec<D>::Zero();       ///< new velocity, of the middle of the step [m/s]
  Vec<D> change = Vec<D>::Zero();  ///< v minus the old velocity [m/s]
  /// Any bit of it.
  bool is_seen() const noexcept
  {
    const auto all_clear = [](const Vec<D>& a) {
      return std::all_of(a.begin(), a.end(), [](Real x) { return x == 0 && !std::signbit(x); });
    };
    return !all_clear(v) || !all_clear(change);
  }
  template <class Self>
  static auto parts(Self& motion) noexcept
  {
    return std::tie(motion.v, motion.change);
  }
};

/// What particles read on the linear shape function of a node, where the kernel has a set of node operators.
template <int D>
struct alignas(64) ProjectedNodeMotion {
  Vec<D> v = Vec<D>::Zero();       ///< [m/s]
  Vec<D> change = Vec<D>::Zero();  ///< [m/s]
  Mat<D> L = Mat<D>::Zero();       ///< velocity gradient [1/s]
};

/// The times of the old velocities and of the new ones: forces act from the one to the other [s].
struct Kick {
  Real from{}, to{};
  Real length() const noexcept { return to - from; }
};

template <int D>
struct Nodes {
  std::vector<NodeSum<D>> sum;
  std::vector<NodeMotion<D>> motion;
  std::vector<std::uint8_t> active;  ///< takes part with a mass of its own
  std::vector<std::uint8_t> bound;   ///< under a wall condition: no local damping, its net force is known only after the wall's
  std::vector<Vec<D>> felt;          ///< net acceleration as particles feel it [m/s^2], in stages that seek rest
  Vec<D> gravity = Vec<D>::Zero();   ///< of the step at hand [m/s^2]
  Real kick{};                       ///< the time over which its forces act, from the old velocities to the new ones [s]
  Real least_share{};                ///< of the lightest particle around: nodes with less do not take part by themselves
  Real least_share_of_gross{};       ///< the same of `gross`
};

}  // namespace talus
