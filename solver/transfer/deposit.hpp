#pragma once
// The contributions of the particles of a cell to its stencil: mass, momentum and force through the weights of a kernel.
#include "kernels/kernel.hpp"
#include "solver/halo/block_rows.hpp"
#include "solver/strips/affine_field.hpp"
#include "solver/strips/reference.hpp"

namespace talus {

/// Sums over the stencil of one cell, one array per component so that lanes are nodes.
template <int D, int N>
struct CellSums {
  alignas(64) Real mass[N];
  alignas(64) Real momentum[D][N];
  alignas(64) Real force[D][N];

  void clear(int n) noexcept
  {
    std::fill_n(mass, n, 0.0);
    for (int i = 0; i < D; ++i) {
      std::fill_n(momentum[i], n, 0.0);
      std::fill_n(force[i], n, 0.0);
    }
  }
  /// Adds the sums to the rows; `lightest` [kg] is the mass of the lightest particle summed.
  template <class Sum>
  void add_to(std::span<Sum> rows, std::span<const std::uint16_t> slots, float lightest) const noexcept
  {
    for (std::size_t a = 0; a < slots.size(); ++a) {
      Sum& row = rows[slots[a]];
      row.mass += mass[a];
      row.see_particles(lightest);
      row.gross += static_cast<float>(std::abs(mass[a]));
      for (int i = 0; i < D; ++i) {
        row.momentum[i] += momentum[i][a];
        row.force[i] += force[i][a];
      }
    }
  }
};

/// V sigma G_v = s_v (slope y_v - shift) [N] of four particles: the stress of each, pulled back to its reference, applied to the factors of
/// its weights.
template <int D>
struct Tension {
  Pack slope[D][D], shift[D];
};
template <int D, int N>
Tension<D> tension_of(const StripColumns<D>& columns, std::size_t first, const Weights<D, N>& weights) noexcept
{
  Pack T[D][D];
  if (columns.G) {
    const MatOf<D> pulled = pulled_back_tension(columns, first);
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j)
        T[i][j] = pulled(i, j).of;
  } else {
    const Pack volume = columns.volume.load(first).of;
    const Sym3Of<SimdReal> stress = columns.stress.load(first);
    for (int i = 0; i < D; ++i)
      for (int j = i; j < D; ++j)
        T[i][j] = T[j][i] = volume * stress[Symmetric<3>::place(i, j)].of;
  }
  Tension<D> tension;
  for (int i = 0; i < D; ++i) {
    tension.shift[i] = Pack{};
    for (int j = 0; j < D; ++j) {
      tension.shift[i] += T[i][j] * weights.shift[j];
      tension.slope[i][j] = Pack{};
      for (int k = 0; k < D; ++k)
        tension.slope[i][j] += T[i][k] * weights.H(k, j);
    }
  }
  return tension;
}

/// Adds m_v += w_v m_p,   (mv)_v += w_v m_p (v_p + A_p (x_v - x_p)),   f_v += w_v f_p - V_p sigma_p G_v, with `tension` for V sigma G, of
/// `count` particles from number i on of which `stays` is not zero.  A is the affine field, of particles that have moved for a time dt, if
/// `affine`; f_p is the force of loads if
/// `loaded`; without `forces` (the second half of MUSL) only momentum is summed.  There is one loop per component, so that all data of the
/// particle in a loop stay in registers.
template <bool affine, bool loaded, bool forces, int D, int N>
void deposit(const StripColumns<D>& columns, std::size_t first, int count, const std::uint8_t* stays, const StencilCell<D, N>& cell,
             const Weights<D, N>& weights, const Tension<D>& tension, Real dt, CellSums<D, N>& sums) noexcept
{
  const MatOf<D> field = affine ? affine_field(columns, first, dt) : MatOf<D>();
  alignas(64) Real share[N];  // m_p w_v
  for (int lane = 0; lane < count; ++lane) {
    const std::size_t p = first + static_cast<std::size_t>(lane);
    if (stays[p] == 0)
      continue;
    const int n = weights.padded_size[lane];
    const Real* const s = weights.s[lane];
    const Real* y[D];
    std::copy_n(weights.y[lane], D, y);
    const bool y_is_x = y[0] == cell.x[0];
    const Real m = columns.mass.of(p);
    Pack slope[D];
    for (int j = 0; j < D; ++j)
      slope[j] = broadcast(-m * weights.slope[j][lane]);
    const Pack value = broadcast(m * weights.value[lane]);
    for (int a = 0; a < n; a += pack_size) {
      Pack w = value;
      for (int j = 0; j < D; ++j)
        w += slope[j] * load(y[j] + a);
      w *= load(s + a);
      store(share + a, w);
      if constexpr (forces)
        store(sums.mass + a, load(sums.mass + a) + w);
    }
    Mat<D> A;
    for (int k = 0; k < D * D; ++k)
      A(k) = field(k)[lane];
    const Vec<D> v_p = columns.v.of(p), f_p = loaded ? columns.applied.of(p) : Vec<D>(Vec<D>::Zero());
    for (int i = 0; i < D; ++i) {
      Real v_origin = v_p[i];  // v + A (x_v - x) = (v - A (x - origin)) + A (x_v - origin)
      Pack A_i[D], T_i[D];
      for (int j = 0; j < D; ++j) {
        if constexpr (affine) {
          A_i[j] = broadcast(A(i, j));
          v_origin -= A(i, j) * (columns.places().component(j)[p] - cell.origin[j]);
        }
        if constexpr (forces)
          T_i[j] = broadcast(-tension.slope[i][j][lane]);
      }
      const Pack v = broadcast(v_origin);
      Pack shift, per_mass;
      if constexpr (forces)
        shift = broadcast(tension.shift[i][lane]);
      if constexpr (loaded)
        per_mass = broadcast(f_p[i] / m);
      Real* const to_momentum = sums.momentum[i];
      Real* const to_force = sums.force[i];
      for (int a = 0; a < n; a += pack_size) {
        const Pack w = load(share + a);
        Pack momentum = v, force = shift;  // NOLINT(clang-diagnostic-uninitialized): read with forces alone
        for (int j = 0; j < D; ++j) {
          const Pack y_j = load(y[j] + a);
          if constexpr (forces)
            force += T_i[j] * y_j;
          if constexpr (affine)
            momentum += A_i[j] * (y_is_x ? y_j : load(cell.x[j] + a));
        }
        store(to_momentum + a, load(to_momentum + a) + w * momentum);
        if constexpr (forces) {
          Pack sum = load(to_force + a) + load(s + a) * force;
          if constexpr (loaded)
            sum += w * per_mass;
          store(to_force + a, sum);
        }
      }
    }
  }
}

/// Subtracts V sigma grad w_v of particle p from f_v, for the first n nodes.
template <int D, int N>
void deposit_force(const StripColumns<D>& columns, std::size_t p, const Real (&slopes)[D][N], int n, CellSums<D, N>& sums) noexcept
{
  const Mat<D> tension = tension_of(columns, p);
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) {
      const Pack T = broadcast(tension(i, j));
      for (int a = 0; a < n; a += pack_size)
        store(sums.force[i] + a, load(sums.force[i] + a) - T * load(slopes[j] + a));
    }
}

}  // namespace talus
