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
  void add_to(std::span<NodeSum<D>> rows, std::span<const std::uint16_t> slots) const noexcept
  {
    for (std::size_t a = 0; a < slots.size(); ++a) {
      NodeSum<D>& row = rows[slots[a]];
      row.mass += mass[a];
      for (int i = 0; i < D; ++i) {
        row.momentum[i] += momentum[i][a];
        row.force[i] += force[i][a];
      }
    }
  }
};

/// m_v += w_v m_p,   (mv)_v += w_v m_p (v_p + A_p (x_v - x_p)),   f_v += w_v f_p - V_p sigma_p G_v.
/// A is the affine field, used if `affine`; f_p the force of loads, used if `loaded`; without `forces` (the second half of
/// MUSL) only momentum is summed.
template <bool affine, bool loaded, bool forces, int D, int N>
void deposit(const Particles<D>& particles, std::size_t p, const Mat<D>& A, const StencilCell<D, N>& cell, const Weights<D, N>& weights, CellSums<D, N>& sums) noexcept
{
  const Real m = particles.mass[p];
  const Vec<D> x = particles.x[p], mv = m * particles.v[p];
  const Mat<D> mA = m * A;
  Mat<D> tension;  // V_p sigma_p [N m]
  if constexpr (forces)
    tension = particles.volume[p] * unpack(particles.stress[p]).template topLeftCorner<D, D>();
  for (int a = 0; a < cell.padded_size; a += pack_size) {
    const Pack w = load(weights.w + a);
    Pack r[D], G[D];
    for (int j = 0; j < D; ++j) {
      if constexpr (affine)
        r[j] = load(cell.x[j] + a) - x[j];
      if constexpr (forces)
        G[j] = load(weights.dw[j] + a);
    }
    if constexpr (forces)
      store(sums.mass + a, load(sums.mass + a) + w * m);
    for (int i = 0; i < D; ++i) {
      Pack momentum = Pack{} + mv[i];
      if constexpr (affine)
        for (int j = 0; j < D; ++j)
          momentum += mA(i, j) * r[j];
      store(sums.momentum[i] + a, load(sums.momentum[i] + a) + w * momentum);
      if constexpr (forces) {
        Pack force = load(sums.force[i] + a);
        if constexpr (loaded)
          force += w * particles.applied[p][i];
        for (int j = 0; j < D; ++j)
          force -= tension(i, j) * G[j];
        store(sums.force[i] + a, force);
      }
    }
  }
}

/// The affine field of a particle under a scheme; zero for flip.
template <int D>
const Mat<D>& affine_field(const Particles<D>& particles, std::size_t p, Scheme scheme) noexcept
{
  return scheme == Scheme::apic ? particles.C[p] : particles.L[p];
}

namespace detail {

template <bool affine, bool loaded, bool forces, int D, Kernel<D> K>
void scatter(const K& kernel, const Mesh<D>& mesh, const Particles<D>& particles, Index n_bodies, const CellOrder& order, Scheme scheme, BlockRows<D>& blocks)
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
        for (const Index row : run) {
          const auto p = static_cast<std::size_t>(row);
          kernel.evaluate(cell, particles.x[p], weights);
          deposit<affine, loaded, forces>(particles, p, affine_field(particles, p, scheme), cell, weights, sums);
        }
        sums.add_to(rows, blocks.slots(c));
      });
    blocks.occupied[static_cast<std::size_t>(b)] = occupied ? 1 : 0;
  });
}

}  // namespace detail

/// Mass, momentum and force of every particle, into the rows of its block.
template <int D, Kernel<D> K>
void scatter(const K& kernel, const Mesh<D>& mesh, const Particles<D>& particles, Index n_bodies, const CellOrder& order, const Transfer& transfer, BlockRows<D>& blocks)
{
  const bool loaded = !particles.applied.empty();
  const auto run = [&]<bool affine, bool with_loads>() { detail::scatter<affine, with_loads, true>(kernel, mesh, particles, n_bodies, order, transfer.scheme, blocks); };
  if (transfer.affine())
    loaded ? run.template operator()<true, true>() : run.template operator()<true, false>();
  else
    loaded ? run.template operator()<false, true>() : run.template operator()<false, false>();
}

}  // namespace talus
