#pragma once
// What the particles of a cell read at its vertices.
#include "solver/model/model.hpp"
#include "solver/transfer/kernel_rows.hpp"

namespace talus {

/// The centres of the linear shape functions of a cell relative to its origin [m].
template <int D, Kernel<D> K>
std::array<Vec<D>, D + 1> arms_of(const Mesh<D>& mesh, const KernelRows<D, K>& of, Index cell, const Vec<D>& origin) noexcept
{
  std::array<Vec<D>, D + 1> arms;
  for (std::size_t a = 0; a <= D; ++a) {
    const Index node = mesh.cell(cell)[a];
    if constexpr (KernelRows<D, K>::projects)
      arms[a] = of.kernel.node_operators().centre(node) - origin;
    else
      arms[a] = mesh.node(node) - origin;
  }
  return arms;
}

/// What the particles of a cell read at its vertices.
template <int D, Kernel<D> K>
class VertexMotion {
 public:
  /// `body` is that of the particles, `none` if their strain is not asked for.
  VertexMotion(const Model<D>& m, const KernelRows<D, K>& of, Index body, Index cell) noexcept
  {
    const auto nodes = m.problem.mesh.cell(cell);
    const bool musl = m.problem.transfer.uses_musl();
    if constexpr (KernelRows<D, K>::projects) {
      for (std::size_t a = 0; a <= D; ++a) {
        const auto n = static_cast<std::size_t>(nodes[a]);
        const ProjectedNodeMotion<D>& motion = of.projected.motion[n];
        v[a] = &motion.v, change[a] = &motion.change, L[a] = &motion.L;
        strain[a] = musl ? &of.gradient_of_remapped[n] : L[a];
        if (body != none && of.interfaces.is_mixed(nodes[a]))
          strain[a] = &of.interfaces.gradient(nodes[a], body);
      }
    } else {
      const auto& gradients = m.problem.mesh.gradients(cell);
      for (Mat<D>& gradient : of_cell_)
        gradient.setZero();
      for (std::size_t a = 0; a <= D; ++a) {
        const auto n = static_cast<std::size_t>(nodes[a]);
        const NodeMotion<D>& motion = nodes_of(m, of).motion[n];
        v[a] = &motion.v, change[a] = &motion.change, L[a] = &of_cell_[0], strain[a] = &of_cell_[musl ? 1 : 0];
        of_cell_[0] += motion.v * gradients[a].transpose();
        if (musl)
          of_cell_[1] += nodes_of(m, of).remapped[n].v * gradients[a].transpose();
      }
    }
  }
  VertexMotion(const VertexMotion&) = delete;
  VertexMotion& operator=(const VertexMotion&) = delete;

  std::array<const Vec<D>*, D + 1> v, change;  ///< [m/s]
  /// Velocity gradients, and those that strain the particles: of the remapped velocities under MUSL, and of their group [1/s].
  std::array<const Mat<D>*, D + 1> L, strain;

 private:
  Mat<D> of_cell_[2];
};

/// Clears the momentum in the rows of a block with particles and calls f(cell, moments, arms, rows, slots) for its cells with particles.
template <int D, Kernel<D> K, class F>
void for_each_cell_with_moments(const Model<D>& m, KernelRows<D, K>& of, Index block, F&& f)
{
  if (!of.blocks.occupied[static_cast<std::size_t>(block)])
    return;
  const auto rows = of.blocks.rows(block);
  for (auto& row : rows)
    row.clear_momentum();
  const Index last = std::min((block + 1) * block_cells, m.problem.mesh.n_cells());
  for (Index c = block * block_cells; c < last; ++c) {
    const CellMoments<D>& moments = of.moments[static_cast<std::size_t>(c)];
    Real mass = 0;
    for (int a = 0; a <= D; ++a)
      mass += moments.of[a][D + CellMoments<D>::product(a, a)];
    if (mass > 0)  // without particles all is zero: not all coordinates of one are
      f(c, moments, arms_of(m.problem.mesh, of, c, centroid(m.problem.mesh, c)), rows, of.blocks.slots(c));
  }
}

}  // namespace talus
