#pragma once
// Nodal rows: sums over particles, and the motion that particles read.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "core/sparse_rows.hpp"
#include "core/types.hpp"
#include "solver/state/nodes_in_use.hpp"

namespace talus {

/// Sums over the particles around a node.  One cache line; `lightest` and `gross` are for comparisons only.
template <int D>
struct alignas(64) NodeSum {
  Real mass{};              ///< [kg]
  float lightest = unseen;  ///< mass of the lightest particle whose stencil contains the node [kg]; 0 without particles
  /// Reference for `mass` [kg]: sum over cells of |mass from the cell|, or the mean mass of the linear shape functions around.
  float gross{};
  Vec<D> force = Vec<D>::Zero();     ///< internal force and loads, without gravity [N]
  Vec<D> momentum = Vec<D>::Zero();  ///< [kg m/s]
  void clear_momentum() noexcept { momentum.setZero(); }
  void add_momentum(const NodeSum& other) noexcept { momentum += other.momentum; }
  bool has_momentum() const noexcept { return !momentum.isZero(0); }
  /// The members for messages, without padding.
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
  static constexpr float unseen = 0;  // all of an empty sum is zero, as in rows that have never been written (SparseRows)
  bool is_seen() const noexcept { return lightest != unseen; }
  /// Counts the lightest of other particles; there may be none, `unseen`.
  void see_particles(float lightest_of_them) noexcept
  {
    if (lightest_of_them != unseen && (lightest == unseen || lightest_of_them < lightest))
      lightest = lightest_of_them;
  }
  NodeSum& operator+=(const NodeSum& other) noexcept
  {
    mass += other.mass;
    see_particles(other.lightest);
    gross += other.gross;
    momentum += other.momentum;
    force += other.force;
    return *this;
  }
};

/// Sums over particles on a linear shape function: with its values B, momentum sum B m (v + A (c_n - c_p)) with c_p = sum_n B_n c_n, and
/// further sums for the operators.
template <int D>
struct ProjectedNodeSum : NodeSum<D> {
  Mat<D> affine = Mat<D>::Zero();   ///< sum B m A [kg/s]
  Real volume{};                    ///< sum B V [m^D], where surfaces are extended
  Mat<D> tension = Mat<D>::Zero();  ///< sum B V sigma, of reference configurations sum B V sigma G^-T [N m]
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
    return std::tuple_cat(NodeSum<D>::parts(sum), std::tie(sum.affine, sum.volume, sum.tension));
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
    volume += other.volume;
    tension += other.tension;
    return *this;
  }
};

/// Z g, entry by entry from the left: one order of the sums wherever a tension pulls.
template <int D>
Vec<D> pull_of(const Mat<D>& tension, const Vec<D>& gradient) noexcept
{
  Vec<D> force;
  for (int i = 0; i < D; ++i) {
    force[i] = tension(i, 0) * gradient[0];
    for (int j = 1; j < D; ++j)
      force[i] += tension(i, j) * gradient[j];
  }
  return force;
}

/// The motion of a node.  One cache line in 3-D.
template <int D>
struct alignas(64) NodeMotion {
  Vec<D> v = Vec<D>::Zero();       ///< new velocity, of the middle of the step [m/s]
  Vec<D> change = Vec<D>::Zero();  ///< v minus the old velocity [m/s]
  /// Whether any value differs from zero.
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

/// The motion that particles read on a linear shape function, for kernels with node operators.
template <int D>
struct alignas(64) ProjectedNodeMotion {
  Vec<D> v = Vec<D>::Zero();       ///< [m/s]
  Vec<D> change = Vec<D>::Zero();  ///< [m/s]
  Mat<D> L = Mat<D>::Zero();       ///< velocity gradient [1/s]
};

/// Changes of velocity b on a linear shape function n, for symmetric affine FLIP.
template <int D>
struct ChangeOnHat {
  Vec<D> change = Vec<D>::Zero();  ///< sum_v S_nv b_v [m/s]
  Mat<D> moment = Mat<D>::Zero();  ///< sum_v S_nv b_v (x) (x_v - c_n) [m^2/s]
};

/// A node of a velocity field as boundary conditions see it.
struct NodeOfField {
  Index node = none;
  std::uint8_t open = 0;  ///< see Nodes
};

/// The times of the old and the new velocities [s], between which forces act.
struct Kick {
  Real from{}, to{};
  Real length() const noexcept { return to - from; }
};

template <int D>
struct Nodes {
  SparseRows<NodeSum<D>> sum;
  SparseRows<NodeMotion<D>> motion;
  SparseRows<NodeMotion<D>> remapped;  ///< MUSL: remapped velocity in `v`, velocity of the step in `change`
  std::vector<std::uint8_t> active;    ///< nodes with enough mass for a motion of their own
  /// Nodes with a boundary condition: no local damping, and the net force is known only after the condition has acted.
  std::vector<std::uint8_t> bound;
  /// Planes of walls that no material touches in this step, one bit for each one-sided plane of the node; empty without walls with gaps.
  std::vector<std::uint8_t> open;
  std::vector<std::uint8_t> slides;  ///< nodes that boundary conditions press against a wall with friction, and that slide
  std::vector<Vec<D>> felt;          ///< net acceleration that acts on particles [m/s^2], in stages that seek equilibrium
  SparseRows<Vec<D>> surface_loads;  ///< forces of loads on surfaces that cut cells [N]; empty without such loads
  Vec<D> gravity = Vec<D>::Zero();   ///< gravity in the present step [m/s^2]
  Real kick{};                       ///< time over which forces act, from the old velocities to the new ones [s]
  NodesInUse in_use;
  Real least_share{};           ///< limit of mass relative to the lightest particle around: nodes with less are nodes of small mass
  Real least_share_of_gross{};  ///< limit of mass relative to `gross`

  explicit Nodes(Index n_nodes = 0) : sum(static_cast<std::size_t>(n_nodes)), motion(sum.size()), active(sum.size()), in_use(n_nodes) {}
  NodeOfField of_field(Index node) const noexcept { return {node, open.empty() ? std::uint8_t{0} : open[static_cast<std::size_t>(node)]}; }
};

}  // namespace talus
