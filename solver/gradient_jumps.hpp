#pragma once
// Stiffness of displacements that averaged gradients do not see.
#include <array>
#include <vector>

#include "mesh/mesh.hpp"

namespace talus {

/// Kernels that average gradients over the cells around a node do not see displacements that alternate from node to node: such modes have no
/// stiffness.  This gives them one, by the energy of what the average leaves out,
///
///     W(u) = 1/2 sum_c sum_(n of c) V_c mu_c / (D + 1) |grad u_c - G_n|^2,     G_n = sum_c V_c grad u_c / sum_c V_c over the cells of n,
///
/// with the filled volume V_c [m^D] and the shear modulus mu_c [Pa] of the cells.  It vanishes for linear fields; of smooth ones it is of the
/// order h^2, as the stabilization of Dohrmann & Bochev (Int. J. Numer. Meth. Fluids 46, 2004), which projects in the same way.
template <int D>
class GradientJumps {
 public:
  struct Cell {
    Index cell;
    Real volume;   ///< filled [m^D]
    Real modulus;  ///< volume times shear modulus [N m]
  };
  GradientJumps() = default;
  GradientJumps(const Mesh<D>& mesh, std::vector<Cell> cells) : cells_(std::move(cells)), volume_(to_size(mesh.n_nodes()), 0)
  {
    for (const Cell& one : cells_)
      for (const Index n : mesh.cell(one.cell))
        volume_[to_size(n)] += one.volume;
  }

  /// Adds -dW/du [N] to the forces of the nodes.
  void add_forces(const Mesh<D>& mesh, const std::vector<Vec<D>>& u, std::vector<Vec<D>>& force)
  {
    mean_.assign(volume_.size(), Mat<D>::Zero());
    rest_.assign(volume_.size(), Mat<D>::Zero());
    gradient_.clear();
    for (const Cell& one : cells_) {
      Mat<D> gradient = Mat<D>::Zero();
      for (std::size_t a = 0; a <= D; ++a)
        gradient += u[to_size(mesh.cell(one.cell)[a])] * mesh.gradients(one.cell)[a].transpose();
      gradient_.push_back(gradient);
      for (const Index n : mesh.cell(one.cell))
        mean_[to_size(n)] += one.volume / volume_[to_size(n)] * gradient;
    }
    for (std::size_t k = 0; k < cells_.size(); ++k)
      for (const Index n : mesh.cell(cells_[k].cell))
        rest_[to_size(n)] += cells_[k].modulus / (D + 1) * (gradient_[k] - mean_[to_size(n)]);
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      const Cell& one = cells_[k];
      Mat<D> stress = Mat<D>::Zero();
      for (const Index n : mesh.cell(one.cell))
        stress += one.modulus / (D + 1) * (gradient_[k] - mean_[to_size(n)]) - one.volume / volume_[to_size(n)] * rest_[to_size(n)];
      for (std::size_t a = 0; a <= D; ++a)
        force[to_size(mesh.cell(one.cell)[a])] -= stress * mesh.gradients(one.cell)[a];
    }
  }

 private:
  std::vector<Cell> cells_;
  std::vector<Real> volume_;  ///< by node: of the cells around it
  std::vector<Mat<D>> mean_, rest_, gradient_;
};

}  // namespace talus
