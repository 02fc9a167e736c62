#pragma once
// Stiffness of displacements that averaged gradients do not see.
#include <algorithm>
#include <span>
#include <vector>

#include "core/particles.hpp"
#include "mesh/mesh.hpp"
#include "solver/strips/strip.hpp"

namespace talus {

/// Kernels that average gradients over the cells around a node do not see displacements that alternate from node to node: such modes have
/// no stiffness.  Nodes beyond a free surface that cuts cells have hardly any.  What the average leaves out is the jump of a cell,
///
///     J_c(u) = grad u_c - mean of G_n over the nodes n of c,     G_n = sum_c V_c grad u_c / sum_c V_c over the cells of n,
///
/// with the filled volume V_c [m^D].  It vanishes for linear fields; of smooth ones it is of the order h^2.  A stress T_c [N m, over the
/// volume of the cell] that acts on it has forces at the nodes, by the transpose of J_c.  Dohrmann & Bochev (Int. J. for Numerical Methods in
/// Fluids 46, 2004) stabilize pressures by what a projection leaves out, Burman (C. R. Math. 348, 2010) cut cells.
template <int D>
class GradientJumps {
 public:
  /// A cell with a node that a filled cell has.
  struct Cell {
    Index cell;
    Real modulus;                                             ///< shear modulus of the filled cells around its nodes [Pa]
    Mat<D> gradient = Mat<D>::Zero(), jump = Mat<D>::Zero();  ///< of the last displacements
  };

  GradientJumps() = default;
  /// Of each cell of the mesh the filled volume, and this volume times the shear modulus.
  GradientJumps(const Mesh<D>& mesh, std::span<const Real> filled, std::span<const Real> stiffness)
      : filled_(filled.begin(), filled.end()), volume_(to_size(mesh.n_nodes()), 0)
  {
    std::vector<Real> modulus(volume_.size(), 0);
    for (Index c = 0; c < mesh.n_cells(); ++c)
      for (const Index n : mesh.cell(c))
        volume_[to_size(n)] += filled[to_size(c)], modulus[to_size(n)] += stiffness[to_size(c)];
    for (Index c = 0; c < mesh.n_cells(); ++c) {
      Real volume = 0, shear = 0;
      for (const Index n : mesh.cell(c))
        volume += volume_[to_size(n)], shear += modulus[to_size(n)];
      if (volume > 0)
        cells_.push_back({c, shear / volume});
    }
  }

  std::span<const Cell> cells() const noexcept { return cells_; }

  /// Finds gradients and jumps of displacements [m] of the nodes.
  void find(const Mesh<D>& mesh, const std::vector<Vec<D>>& u)
  {
    mean_.assign(volume_.size(), Mat<D>::Zero());
    for (Cell& one : cells_) {
      one.gradient.setZero();
      for (std::size_t a = 0; a <= D; ++a)
        one.gradient += u[to_size(mesh.cell(one.cell)[a])] * mesh.gradients(one.cell)[a].transpose();
      for (const Index n : mesh.cell(one.cell))
        if (is_filled(n))
          mean_[to_size(n)] += share(one.cell, n) * one.gradient;
    }
    for (Cell& one : cells_) {
      one.jump = one.gradient;
      for_each_filled(mesh, one.cell, [&](Index n, Real weight) { one.jump -= weight * mean_[to_size(n)]; });
    }
  }

  /// Adds the forces [N] of stress by cell [N m] to those of the nodes: the work that they do is minus that of the stress on the jumps.
  void add_forces(const Mesh<D>& mesh, const std::vector<Mat<D>>& stress, std::vector<Vec<D>>& force)
  {
    rest_.assign(volume_.size(), Mat<D>::Zero());
    for (const Cell& one : cells_)
      for_each_filled(mesh, one.cell, [&](Index n, Real weight) { rest_[to_size(n)] += weight * stress[to_size(one.cell)]; });
    for (const Cell& one : cells_) {
      Mat<D> left = stress[to_size(one.cell)];
      for (const Index n : mesh.cell(one.cell))
        if (is_filled(n))
          left -= share(one.cell, n) * rest_[to_size(n)];
      for (std::size_t a = 0; a <= D; ++a)
        force[to_size(mesh.cell(one.cell)[a])] -= left * mesh.gradients(one.cell)[a];
    }
  }

 private:
  bool is_filled(Index n) const noexcept { return volume_[to_size(n)] > 0; }
  Real share(Index c, Index n) const noexcept { return filled_[to_size(c)] / volume_[to_size(n)]; }
  /// Calls f(node, weight) for the nodes of a cell that a filled cell has; the weights are equal, their sum is one.
  template <class F>
  void for_each_filled(const Mesh<D>& mesh, Index c, F&& f) const
  {
    const auto count = std::ranges::count_if(mesh.cell(c), [&](Index n) { return is_filled(n); });
    for (const Index n : mesh.cell(c))
      if (is_filled(n))
        f(n, Real{1} / static_cast<Real>(count));
  }

  std::vector<Cell> cells_;
  std::vector<Real> filled_;         ///< by cell: filled volume
  std::vector<Real> volume_;         ///< by node: that of the cells around it
  std::vector<Mat<D>> mean_, rest_;  ///< by node
};

}  // namespace talus
