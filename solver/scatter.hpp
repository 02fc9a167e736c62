#pragma once
// Particles -> rows of their block of cells (P2G).
#include <utility>

#include "solver/blocks.hpp"
#include "solver/transfer.hpp"

namespace talus {

/// Sums over the stencil of one cell, one array per component so that lanes run over nodes.
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
  /// `lightest` [kg] of the particles summed.
  void add_to(std::span<NodeSum<D>> rows, std::span<const std::uint16_t> slots, float lightest) const noexcept
  {
    for (std::size_t a = 0; a < slots.size(); ++a) {
      NodeSum<D>& row = rows[slots[a]];
      row.mass += mass[a];
      row.lightest = std::min(row.lightest, lightest);
      row.gross += static_cast<float>(std::abs(mass[a]));
      for (int i = 0; i < D; ++i) {
        row.momentum[i] += momentum[i][a];
        row.force[i] += force[i][a];
      }
    }
  }
};

/// Up to four particles of one cell.
struct Bunch {
  std::size_t p[pack_size];  ///< rows; the last one repeated where there are fewer than four
  int count;

  /// f(p) of every lane.
  template <class F>
  Pack lanes(F&& f) const noexcept
  {
    return Pack{f(p[0]), f(p[1]), f(p[2]), f(p[3])};
  }
};

/// f(bunch, x) for the particles of a run, four at a time.
template <int D, class F>
void for_each_bunch(std::span<const Index> run, const std::vector<Vec<D>>& places, F&& f)
{
  for (std::size_t begin = 0; begin < run.size(); begin += pack_size) {
    Bunch bunch;
    bunch.count = static_cast<int>(std::min<std::size_t>(pack_size, run.size() - begin));
    for (std::size_t lane = 0; lane < pack_size; ++lane)
      bunch.p[lane] = static_cast<std::size_t>(run[std::min(begin + lane, run.size() - 1)]);
    Pack x[D];
    for (int d = 0; d < D; ++d)
      x[d] = bunch.lanes([&](std::size_t p) { return places[p][d]; });
    f(std::as_const(bunch), std::as_const(x));
  }
}

/// The affine field of a particle under a scheme; zero for flip.
template <int D>
const Mat<D>& affine_field(const Particles<D>& particles, std::size_t p, Scheme scheme) noexcept
{
  return scheme == Scheme::apic ? particles.C[p] : particles.L[p];
}

/// V sigma G_v = s_v (slope y_v - shift) [N] of four particles: the stress of each applied to the factors of its weights.
template <int D>
struct Tension {
  Pack slope[D][D], shift[D];
};
template <int D, int N>
Tension<D> tension_of(const Particles<D>& particles, const Bunch& bunch, const Weights<D, N>& weights) noexcept
{
  const Pack volume = bunch.lanes([&](std::size_t p) { return particles.volume[p]; });
  Pack T[D][D];
  for (int i = 0; i < D; ++i)
    for (int j = i; j < D; ++j)
      T[i][j] = T[j][i] = volume * bunch.lanes([&](std::size_t p) { return particles.stress[p][Symmetric<3>::place(i, j)]; });
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

/// m_v += w_v m_p,   (mv)_v += w_v m_p (v_p + A_p (x_v - x_p)),   f_v += w_v f_p - V_p sigma_p G_v.
/// A is the affine field, used if `affine`; f_p the force of loads, used if `loaded`; without `forces` (the second half of
/// MUSL) only momentum is summed.  A sweep per component: all that a sweep needs of the particle stays in registers.
template <bool affine, bool loaded, bool forces, int D, int N>
void deposit(const Particles<D>& particles, const Bunch& bunch, Scheme scheme, const StencilCell<D, N>& cell, const Weights<D, N>& weights,
             CellSums<D, N>& sums) noexcept
{
  Tension<D> tension;
  if constexpr (forces)
    tension = tension_of(particles, bunch, weights);
  alignas(64) Real share[N];  // m_p w_v
  for (int lane = 0; lane < bunch.count; ++lane) {
    const std::size_t p = bunch.p[lane];
    const int n = weights.padded_size[lane];
    const Real* const s = weights.s[lane];
    const Real* y[D];
    std::copy_n(weights.y[lane], D, y);
    const bool y_is_x = y[0] == cell.x[0];
    const Real m = particles.mass[p];
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
    const Mat<D>& A = affine_field(particles, p, scheme);
    for (int i = 0; i < D; ++i) {
      Real v_origin = particles.v[p][i];  // v + A (x_v - x) = (v - A (x - origin)) + A (x_v - origin)
      Pack A_i[D], T_i[D];
      for (int j = 0; j < D; ++j) {
        if constexpr (affine) {
          A_i[j] = broadcast(A(i, j));
          v_origin -= A(i, j) * (particles.x[p][j] - cell.origin[j]);
        }
        if constexpr (forces)
          T_i[j] = broadcast(-tension.slope[i][j][lane]);
      }
      const Pack v = broadcast(v_origin);
      Pack shift, per_mass;
      if constexpr (forces)
        shift = broadcast(tension.shift[i][lane]);
      if constexpr (loaded)
        per_mass = broadcast(particles.applied[p][i] / m);
      Real* const to_momentum = sums.momentum[i];
      Real* const to_force = sums.force[i];
      for (int a = 0; a < n; a += pack_size) {
        const Pack w = load(share + a);
        Pack momentum = v, force = shift;
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

namespace detail {

template <bool affine, bool loaded, bool forces, int D, Kernel<D> K>
void scatter(const K& kernel, const Mesh<D>& mesh, const Particles<D>& particles, Index n_bodies, const CellOrder& order, Scheme scheme,
             BlockRows<D>& blocks)
{
  parallel_for_uneven(blocks.size(), [&](Index b) {
    const auto rows = blocks.rows(b);
    typename K::Cell cell;
    Weights<D, K::max_nodes> weights;
    CellSums<D, K::max_nodes> sums;
    bool occupied = false;
    for (Index body = 0; body < n_bodies; ++body)
      for_each_run(order.rows(body, b), particles.cell, [&](Index c, std::span<const Index> run) {
        if (!std::exchange(occupied, true))
          std::fill(rows.begin(), rows.end(), NodeSum<D>{});
        kernel.open(mesh, c, cell);
        sums.clear(cell.padded_size);
        for_each_bunch<D>(run, particles.x, [&](const Bunch& bunch, const Pack(&x)[D]) {
          kernel.evaluate(cell, x, bunch.count, weights);
          deposit<affine, loaded, forces>(particles, bunch, scheme, cell, weights, sums);
        });
        float lightest = NodeSum<D>::unseen;
        for (const Index p : run)
          lightest = std::min(lightest, static_cast<float>(particles.mass[static_cast<std::size_t>(p)]));
        sums.add_to(rows, blocks.slots(c), lightest);
      });
    blocks.occupied[static_cast<std::size_t>(b)] = occupied ? 1 : 0;
  });
}

}  // namespace detail

/// Mass, momentum and force of every particle, into the rows of its block.
template <int D, Kernel<D> K>
void scatter(const K& kernel, const Mesh<D>& mesh, const Particles<D>& particles, Index n_bodies, const CellOrder& order,
             const Transfer& transfer, BlockRows<D>& blocks)
{
  const bool loaded = !particles.applied.empty();
  const auto run = [&]<bool affine, bool with_loads>() {
    detail::scatter<affine, with_loads, true>(kernel, mesh, particles, n_bodies, order, transfer.scheme, blocks);
  };
  if (transfer.affine())
    loaded ? run.template operator()<true, true>() : run.template operator()<true, false>();
  else
    loaded ? run.template operator()<false, true>() : run.template operator()<false, false>();
}

}  // namespace talus
