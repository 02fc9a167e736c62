#pragma once
// MUSL without a second pass over the particles: the momentum that the new velocities of the particles of a cell put on its vertices,
// from moments of their mass.
#include <algorithm>
#include <array>
#include <span>

#include "solver/state/nodes.hpp"

namespace talus {

/// With B_n the barycentric coordinates of particle p in its cell, sums over the particles of a cell for each vertex n:
/// sum m B_n v_p [kg m/s] with the velocity before the step, then sum m B_n B_j B_k [kg] for j <= k.
///
/// The new velocity of a particle and its gradient are linear in nodal data, v = (1 - b) (v_p + sum B dv) + b sum B v and A = sum B L.  So
/// with w = (1 - b) dv + b v, T_njk = sum m B_n B_j B_k, M_nj = sum_k T_njk and the arms c_k of the vertices
///
///     sum_p m B_n (v - A c_p) = (1 - b) sum_p m B_n v_p + sum_j [M_nj w_j - L_j sum_k T_njk c_k]        sum_p m B_n A = sum_j M_nj L_j
///
/// where c_p = sum_k B_k c_k: exact.
template <int D>
struct CellMoments {
  static constexpr int products = (D + 1) * (D + 2) / 2;
  /// The number of the product of coordinates j and k.
  static constexpr int product(int j, int k) noexcept { return j <= k ? j * (2 * D + 3 - j) / 2 + k - j : product(k, j); }

  static constexpr int numbers = D + products;
  Real of[D + 1][numbers];
  Real behind[pack_size];  ///< whole packs are read
};
static_assert(CellMoments<3>::product(0, 3) == 3 && CellMoments<3>::product(1, 1) == 4 && CellMoments<3>::product(3, 3) == 9);
static_assert(CellMoments<2>::product(0, 2) == 2 && CellMoments<2>::product(1, 1) == 3 && CellMoments<2>::product(2, 2) == 5);

/// Adds the momentum of the new velocities of the particles of a cell to the rows of its vertices: `motion` of these with `pic`, the share b
/// above.  Without `affine` A is zero.
template <bool affine, int D, class Motion, class Row>
void add_new_momentum(const CellMoments<D>& moments, const std::array<Vec<D>, D + 1>& arms, const Motion& motion, Real pic,
                      std::span<Row> rows, std::span<const std::uint16_t> slots) noexcept
{
  Pack q[CellMoments<D>::numbers];  // vertex n in lane n
  const auto take = [&](int k, const Pack& of) __attribute__((always_inline)) { q[k] = of; };
  load_rows<CellMoments<D>::numbers>({moments.of[0], moments.of[1], moments.of[2], moments.of[D]}, take);
  const Pack* const T = q + D;
  Pack p[D], K[D][D]{}, arm[D];
  for (int i = 0; i < D; ++i)
    p[i] = (1 - pic) * q[i];
  for (int d = 0; d < D; ++d)
    arm[d] = Pack{arms[0][d], arms[1][d], arms[2][d], D == 3 ? arms[D][d] : 0};
  for (int j = 0; j <= D; ++j) {
    const auto vertex = static_cast<std::size_t>(j);
    const Vec<D>&v = *motion.v[vertex], &change = *motion.change[vertex];
    const Mat<D>& L = *motion.L[vertex];
    Pack M{}, first[D]{};
    for (int k = 0; k <= D; ++k) {
      const Pack& of_pair = T[CellMoments<D>::product(j, k)];
      M += of_pair;
      for (int d = 0; d < D; ++d)
        first[d] += of_pair * arms[static_cast<std::size_t>(k)][d];
    }
    for (int i = 0; i < D; ++i) {
      p[i] += M * ((1 - pic) * change[i] + pic * v[i]);
      for (int d = 0; affine && d < D; ++d) {
        K[i][d] += M * L(i, d);
        p[i] -= first[d] * L(i, d);
      }
    }
  }
  for (int i = 0; affine && i < D; ++i)
    for (int d = 0; d < D; ++d)
      p[i] += K[i][d] * arm[d];
  for (int a = 0; a <= D; ++a) {
    Row& row = rows[slots[static_cast<std::size_t>(a)]];
    for (int i = 0; i < D; ++i) {
      row.momentum[i] += p[i][a];
      if constexpr (affine && std::is_same_v<Row, ProjectedNodeSum<D>>)
        for (int d = 0; d < D; ++d)
          row.affine(i, d) += K[i][d][a];
    }
  }
}

/// Adds T_n = sum_p m B_n tau_p to `affine` of the rows of the vertices of a cell, where tau_p = sum_l B_l [Q_l + s_l (x) (c_l - c_p)] [kg m^2/s],
/// from changes s and their moments Q on the vertices: the transpose of what the affine part of add_new_momentum() makes of gradients.
template <int D, class Row>
void add_moment_of_changes(const CellMoments<D>& moments, const std::array<Vec<D>, D + 1>& arms,
                           const std::array<const ChangeOnHat<D>*, D + 1>& changes, std::span<Row> rows,
                           std::span<const std::uint16_t> slots) noexcept
{
  Pack T[CellMoments<D>::numbers];  // vertex n in lane n
  const auto take = [&](int k, const Pack& of) __attribute__((always_inline)) { T[k] = of; };
  load_rows<CellMoments<D>::numbers>({moments.of[0], moments.of[1], moments.of[2], moments.of[D]}, take);
  Pack tau[D][D]{};
  for (int l = 0; l <= D; ++l) {
    const auto vertex = static_cast<std::size_t>(l);
    const ChangeOnHat<D>& of = *changes[vertex];
    Pack M{}, arm[D]{};  // sum m B_n B_l, and sum m B_n B_l (c_l - c_p)
    for (int j = 0; j <= D; ++j) {
      const Pack& of_pair = T[D + CellMoments<D>::product(l, j)];
      M += of_pair;
      for (int d = 0; d < D; ++d)
        arm[d] += of_pair * (arms[vertex][d] - arms[static_cast<std::size_t>(j)][d]);
    }
    for (int i = 0; i < D; ++i)
      for (int d = 0; d < D; ++d)
        tau[i][d] += M * of.moment(i, d) + arm[d] * of.change[i];
  }
  for (int a = 0; a <= D; ++a)
    for (int i = 0; i < D; ++i)
      for (int d = 0; d < D; ++d)
        rows[slots[static_cast<std::size_t>(a)]].affine(i, d) += tau[i][d][a];
}

}  // namespace talus
