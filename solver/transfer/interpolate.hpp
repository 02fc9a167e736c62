#pragma once
// From the nodes of the stencil of a cell to its particles: velocities and gradients through the weights of a kernel.
#include "kernels/kernel.hpp"

namespace talus {

/// Velocities of the nodes, interpolated to four particles.
template <int D>
struct Interpolated {
  Pack v[D], change[D];  ///< sum w v,  sum w change  [m/s]
  Pack L[D][D];          ///< sum v (x) G  [1/s]
};

/// The motion of the nodes of one cell's stencil, one array per component.
template <int D, int N>
struct CellMotion {
  alignas(64) Real v[D][N];
  alignas(64) Real change[D][N];

  template <class Motion>
  void read(const SparseRows<Motion>& motion, std::span<const Index> nodes, int padded_size) noexcept
  {
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const Motion& row = motion[static_cast<std::size_t>(nodes[a])];
      for (int i = 0; i < D; ++i) {
        v[i][a] = row.v[i];
        change[i][a] = row.change[i];
      }
    }
    for (auto a = static_cast<int>(nodes.size()); a < padded_size; ++a)
      for (int i = 0; i < D; ++i)
        v[i][a] = change[i][a] = 0;
  }
};

/// Sums over the stencil for one particle, four nodes per pack.  Without the gradient `v` is sum w v, otherwise sum s v.
template <int D, bool with_change, bool with_gradient>
struct StencilSums {
  Pack v[D];
  Pack change[with_change ? D : 1];   ///< w change
  Pack vy[with_gradient ? D : 1][D];  ///< s v (x) y
};
template <bool with_change, bool with_gradient, int D, int N>
[[gnu::always_inline]] inline void sweep(const CellMotion<D, N>& motion, const Weights<D, N>& weights, int lane,
                                         StencilSums<D, with_change, with_gradient>& total) noexcept
{
  Pack v[D]{}, change[D]{}, vy[D][D]{}, slope[D];
  const Pack value = broadcast(weights.value[lane]);
  for (int j = 0; j < D; ++j)
    slope[j] = broadcast(weights.slope[j][lane]);
  for (int a = 0; a < weights.padded_size[lane]; a += pack_size) {
    const Pack s = load(weights.s[lane] + a);
    Pack y[D], w = value;
    for (int j = 0; j < D; ++j) {
      y[j] = load(weights.y[lane][j] + a);
      w -= slope[j] * y[j];
    }
    w *= s;
    for (int i = 0; i < D; ++i) {
      const Pack share = (with_gradient ? s : w) * load(motion.v[i] + a);
      v[i] += share;
      if constexpr (with_gradient)
        for (int j = 0; j < D; ++j)
          vy[i][j] += share * y[j];
      if constexpr (with_change)
        change[i] += w * load(motion.change[i] + a);
    }
  }
  for (int i = 0; i < D; ++i) {
    total.v[i] = v[i];
    if constexpr (with_change)
      total.change[i] = change[i];
    if constexpr (with_gradient)
      for (int j = 0; j < D; ++j)
        total.vy[i][j] = vy[i][j];
  }
}

/// Interpolates to the particles; `change` and `L` are computed only if needed.
template <bool with_change, bool with_gradient, int D, int N>
Interpolated<D> see(const CellMotion<D, N>& motion, const Weights<D, N>& weights, int count) noexcept
{
  StencilSums<D, with_change, with_gradient> of[pack_size];
  for (int lane = 0; lane < pack_size; ++lane)
    if (lane < count)
      sweep(motion, weights, lane, of[lane]);
    else
      of[lane] = of[count - 1];
  const auto total = [&](auto&& entry) __attribute__((always_inline))
  {
    return sums(entry(of[0]), entry(of[1]), entry(of[2]), entry(of[3]));
  };

  Interpolated<D> seen;
  for (int i = 0; i < D; ++i) {
    seen.v[i] = total([&](const auto& one) { return one.v[i]; });
    if constexpr (with_change)
      seen.change[i] = total([&](const auto& one) { return one.change[i]; });
    if constexpr (with_gradient) {
      const Pack sv = seen.v[i];
      Pack vy[D];
      seen.v[i] *= weights.value;
      for (int j = 0; j < D; ++j) {
        vy[j] = total([&](const auto& one) { return one.vy[i][j]; });
        seen.v[i] -= vy[j] * weights.slope[j];
      }
      for (int j = 0; j < D; ++j) {
        seen.L[i][j] = -sv * weights.shift[j];
        for (int k = 0; k < D; ++k)
          seen.L[i][j] += vy[k] * weights.H(k, j);
      }
    }
  }
  return seen;
}

/// The affine field of APIC, B D^-1 with B = sum w v (x) r, D = sum w r (x) r, r = x_v - x_p.  D may be indefinite near the boundary of a
/// mesh, where weights are negative; there the kernel's gradient L is used instead.
template <int D, int N>
Mat<D> apic_field(const StencilCell<D, N>& cell, const CellMotion<D, N>& motion, const Weights<D, N>& weights, int lane, const Vec<D>& x,
                  const Mat<D>& L) noexcept
{
  NodeWeights<D, N> plain;
  weights.spell_out(lane, plain);
  Mat<D> B = Mat<D>::Zero(), moment = Mat<D>::Zero();
  Real spread = 0;  // sum |w| r^2, the scale of `moment`
  for (int a = 0; a < cell.size; ++a) {
    Vec<D> r, v;
    for (int i = 0; i < D; ++i) {
      r[i] = cell.x[i][a] - (x[i] - cell.origin[i]);
      v[i] = motion.v[i][a];
    }
    B += plain.w[a] * v * r.transpose();
    moment += plain.w[a] * r * r.transpose();
    spread += std::abs(plain.w[a]) * r.squaredNorm();
  }
  constexpr Real least_share = 1e-2;  // limit relative to the mean second moment: below, B D^-1 amplifies round-off and errors of sign
  bool sound = spread > 0;
  for (int k = 1; k <= D; ++k)  // positive definite with a margin: leading minors against powers of the scale
    sound = sound && moment.topLeftCorner(k, k).determinant() > std::pow(least_share * spread / D, k);
  return sound ? Mat<D>(B * moment.inverse()) : L;
}

}  // namespace talus
