#pragma once
// Stiffness of displacements that averaged gradients do not see.
#include <span>
#include <vector>

#include "core/particles.hpp"
#include "mesh/mesh.hpp"
#include "solver/strips/strip.hpp"

namespace talus {

/// Kernels that average gradients over the cells around a node do not see displacements that alternate from node to node: such modes have
/// no stiffness.  Nodes beyond a free surface that cuts cells have hardly any.  This gives them one, by the energy of what the average
/// leaves out,
///
///     W(u) = 1/2 sum_c sum_(n of c) |c| mu_c / (D + 1) |grad u_c - G_n|^2,     G_n = sum_c V_c grad u_c / sum_c V_c over the cells of n,
///
/// over all cells with a node that a filled cell has, with the filled volume V_c [m^D] and a shear modulus mu_c [Pa] of the cells.  It
/// vanishes for linear fields; of smooth ones it is of the order h^2, as the stabilization of Dohrmann & Bochev (Int. J. for Numerical
/// Methods in Fluids 46, 2004), which projects in the same way, and the ghost penalty of cut cells (Burman, C. R. Math. 348, 2010).
template <int D>
class GradientJumps {
 public:
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
        cells_.push_back({c, share_of(c) * mesh.volume(c) * shear / volume / (D + 1)});
    }
  }

  /// Calls f(cell, volume times shear modulus [N m]) for the cells that have this stiffness, empty ones as if they were filled.
  template <class F>
  void for_each_cell(F&& f) const
  {
    for (const Cell& one : cells_)
      f(one.cell, (D + 1) * one.stiffness / share_of(one.cell));
  }

  /// Finds the gradients of displacements [m] of the nodes.
  void find_gradients(const Mesh<D>& mesh, const std::vector<Vec<D>>& u)
  {
    mean_.assign(volume_.size(), Mat<D>::Zero());
    gradient_.clear();
    for (const Cell& one : cells_) {
      Mat<D> gradient = Mat<D>::Zero();
      for (std::size_t a = 0; a <= D; ++a)
        gradient += u[to_size(mesh.cell(one.cell)[a])] * mesh.gradients(one.cell)[a].transpose();
      gradient_.push_back(gradient);
      for (const Index n : mesh.cell(one.cell))
        if (is_filled(n))
          mean_[to_size(n)] += share(one.cell, n) * gradient;
    }
  }
  /// The mean of these that the particles of a filled cell see.
  Mat<D> seen_in(const Mesh<D>& mesh, Index cell) const
  {
    Mat<D> sum = Mat<D>::Zero();
    for (const Index n : mesh.cell(cell))
      sum += mean_[to_size(n)] / (D + 1);
    return sum;
  }

  /// Adds -dW/du [N] of these displacements to the forces of the nodes.  `left` is by cell the share of its stiffness that the material has
  /// left where it yields, found for filled cells; empty ones have the mean of those around.
  void add_forces(const Mesh<D>& mesh, const std::vector<Real>& left, std::vector<Vec<D>>& force)
  {
    rest_.assign(volume_.size(), Mat<D>::Zero());
    left_.assign(volume_.size(), 0);
    for (const Cell& one : cells_)
      for (const Index n : mesh.cell(one.cell))
        if (is_filled(n))
          left_[to_size(n)] += share(one.cell, n) * left[to_size(one.cell)];
    stiffness_.clear();
    for (const Cell& one : cells_) {
      Real sum = 0, nodes = 0;
      for (const Index n : mesh.cell(one.cell))
        if (is_filled(n))
          sum += left_[to_size(n)], ++nodes;
      stiffness_.push_back(one.stiffness * sum / nodes);
    }
    for (std::size_t k = 0; k < cells_.size(); ++k)
      for (const Index n : mesh.cell(cells_[k].cell))
        if (is_filled(n))
          rest_[to_size(n)] += stiffness_[k] * (gradient_[k] - mean_[to_size(n)]);
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      const Index c = cells_[k].cell;
      Mat<D> stress = Mat<D>::Zero();
      for (const Index n : mesh.cell(c))
        if (is_filled(n))
          stress += stiffness_[k] * (gradient_[k] - mean_[to_size(n)]) - share(c, n) * rest_[to_size(n)];
      for (std::size_t a = 0; a <= D; ++a)
        force[to_size(mesh.cell(c)[a])] -= stress * mesh.gradients(c)[a];
    }
  }

 private:
  Real share_of(Index c) const noexcept { return filled_[to_size(c)] > 0 ? 1 : 0.1; }
  bool is_filled(Index n) const noexcept { return volume_[to_size(n)] > 0; }
  Real share(Index c, Index n) const noexcept { return filled_[to_size(c)] / volume_[to_size(n)]; }

  struct Cell {
    Index cell;
    Real stiffness;  ///< volume times shear modulus, of each node [N m]
  };
  std::vector<Cell> cells_;
  std::vector<Real> filled_;     ///< by cell: filled volume
  std::vector<Real> volume_;     ///< by node: that of the cells around it
  std::vector<Real> left_;       ///< by node: share of the stiffness
  std::vector<Real> stiffness_;  ///< of `cells_`, that of these shares
  std::vector<Mat<D>> mean_, rest_, gradient_;
};

}  // namespace talus
