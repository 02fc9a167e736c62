#pragma once
// Sums over the node patches by linear shape functions, for scalars that are averaged or conducted: cheap, and apart from the kernel of the momentum.
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "solver/halo/halo.hpp"
#include "solver/strips/strips_in_cells.hpp"

namespace talus {

/// Barycentric coordinates of x in cell c, for a particle that may just have left it: none negative, sum one.
template <int D>
std::array<Real, D + 1> barycentric_inside(const Mesh<D>& mesh, Index c, const Vec<D>& x) noexcept
{
  std::array<Real, D + 1> shape = mesh.barycentric(c, x);
  Real sum = 0;
  for (Real& shape_value : shape)
    sum += shape_value = std::max(shape_value, Real{0});
  for (Real& shape_value : shape)
    shape_value /= sum;
  return shape;
}

/// K sums at a node.
template <int K>
struct NodePatchRow {
  std::array<Real, K> sum{};
  Real& operator[](std::size_t k) noexcept { return sum[k]; }
  const Real& operator[](std::size_t k) const noexcept { return sum[k]; }
  bool is_seen() const noexcept
  {
    return std::any_of(sum.begin(), sum.end(), [](Real entry) { return entry != 0; });
  }
  template <class Self>
  static auto parts(Self& row) noexcept
  {
    return std::tie(row.sum);
  }
  NodePatchRow& operator+=(const NodePatchRow& other) noexcept
  {
    for (std::size_t k = 0; k < K; ++k)
      sum[k] += other.sum[k];
    return *this;
  }
};

/// K sums per node.  Blocks keep rows of their own, which are then added up as those of momentum are: the bits depend neither on threads nor
/// on ranks.
template <int D, int K>
class NodePatchSums {
 public:
  using Row = NodePatchRow<K>;

  /// Of a rank that is alone.
  explicit NodePatchSums(const Mesh<D>& mesh) : NodePatchSums(mesh, all_nodes(mesh)) { halo_ = Halo<Row>(blocks_.size()); }
  NodePatchSums(Communicator& ranks, const Mesh<D>& mesh, const Subdomain& subdomain) : NodePatchSums(mesh, own_nodes(mesh, subdomain))
  {
    halo_ = Halo<Row>(ranks, mesh, subdomain, blocks_);
    copies_ = copies_of_nodes(ranks, subdomain, MessageTag::sums, nodes_read(subdomain, blocks_));
  }

  /// Clears, then add(cell, its particles, rows of its corners) for every cell that holds particles of the bodies, which are treated as
  /// one: `add` is called for each body that has particles in the cell, one after the other, and the corners keep what was added before.
  /// So the sums are bitwise those of one body whose particles have the same order in each cell.
  template <class Add>
  void gather(const ParticleStrips<D>& strips, std::span<const Index> bodies, Add&& add)
  {
    for_each_own_block<Whole>(blocks_, halo_, [&](Index block) {
      const auto rows = blocks_.rows(block);
      std::fill(rows.begin(), rows.end(), Row{});
      bool occupied = false;
      for_each_cell_of(strips, bodies, block, [&](Index c, auto&& runs) {
        std::array<Row, D + 1> corners{};
        runs([&](const ParticlesInCell<D>& run) { add(c, run, corners); });
        for (std::size_t a = 0; a <= D; ++a)
          rows[blocks_.slots(c)[a]] += corners[a];
        occupied = true;
      });
      blocks_.occupied[static_cast<std::size_t>(block)] = occupied ? 1 : 0;
    });
    assemble<Whole>(blocks_, own_, halo_, copies_, in_use_, of_node_, [&] { in_use_.find(blocks_.occupied, false); });
  }

  const Row& operator[](Index node) const noexcept { return of_node_[static_cast<std::size_t>(node)]; }

 private:
  NodePatchSums(const Mesh<D>& mesh, OwnNodes own)
      : blocks_(make_block_rows<Row>(mesh, [&](Index c) { return std::span(mesh.cell(c)); })),
        own_(std::move(own)),
        in_use_(mesh.n_nodes()),
        of_node_(static_cast<std::size_t>(mesh.n_nodes()))
  {
    in_use_.prepare(mesh, own_);
  }

  BlockRows<D, Row> blocks_;
  OwnNodes own_;
  NodesInUse in_use_;
  Halo<Row> halo_;
  HaloExchange copies_;
  std::vector<Row> of_node_;
};

}  // namespace talus
