#pragma once
// Pressures that are constant over blocks of nodes: what a diagonal preconditioner reduces slowest.
#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

#include "core/parallel/communicator.hpp"
#include "core/sparse_rows.hpp"
#include "mesh/mesh.hpp"
#include "mesh/part.hpp"
#include "solver/state/owned_nodes.hpp"
#include "solver/strips/strip.hpp"

namespace talus {

/// What is known of the pressure at a node.
enum class NodePressure : std::uint8_t { nothing, unknown, given };

/// The second part of a preconditioner, R^T (R A R^T)^-1 R, where R sums over the nodes that a block of cells is the first to use
/// [Nicolaides 1987].  All ranks have the whole of the small matrix, which is summed in the order of blocks.
template <int D>
class CoarsePressure {
 public:
  explicit CoarsePressure(const Mesh<D>& mesh);
  /// Takes the numbers of blocks in the whole mesh, on one of several ranks; those of the nodes must be sent to copies afterwards.
  std::vector<Real>& take_numbers(const Subdomain& subdomain);

  /// Adds up the matrix A = matrix + dt kick B^T M^-1 C B between unknown pressures and factorises it; `around` is what is known at the nodes of
  /// this rank and those around.  Collective.
  void prepare(Communicator& ranks, const Mesh<D>& mesh, const OwnNodes& own, const std::vector<NodePressure>& around,
               const SparseRows<Real>& matrix, const SparseRows<Vec<D>>& push, const std::vector<Mat<D>>& free,
               const std::vector<Real>& lightness, Real dt);
  /// Finds y = R^T (R A R^T)^-1 R x for unknown pressures.  Collective.
  void find(Communicator& ranks, const OwnNodes& own, const std::vector<NodePressure>& around, const std::vector<Real>& x);
  /// y at an own node with an unknown pressure.
  Real at(Index n) const noexcept
  {
    const Index row = works_ ? row_of_block_[to_size(block(n))] : none;
    return row == none ? 0 : level_[row];
  }

 private:
  /// What the nodes of one block add to an entry of the matrix.
  struct Part {
    Index row, column, of;  ///< blocks of the whole mesh
    Index padding = 0;      ///< sent to other ranks, so not left undefined
    Real value;
  };
  std::vector<Part> parts_of(const Mesh<D>& mesh, const IndexRange& nodes, const std::vector<NodePressure>& around,
                             const SparseRows<Real>& matrix, const SparseRows<Vec<D>>& push, const std::vector<Mat<D>>& free,
                             const std::vector<Real>& lightness, Real dt) const;
  Index block(Index node) const noexcept { return static_cast<Index>(block_[static_cast<std::size_t>(node)]); }
  std::vector<Real> block_;         ///< in the whole mesh, of each node
  Index n_blocks_;                  ///< of the whole mesh
  std::vector<std::int64_t> sums_;  ///< bits of the sums of blocks
  std::vector<Index> row_of_block_;
  Index n_rows_ = 0;
  Eigen::VectorXd level_;  ///< of the rows
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<Real>> factors_;
  bool works_ = false;
};

extern template class CoarsePressure<2>;
extern template class CoarsePressure<3>;

}  // namespace talus
