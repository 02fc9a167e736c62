#pragma once
// Sums over the node patches by linear shape functions, for scalars that are averaged or conducted: cheap, and apart from the kernel of the momentum.
#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "solver/halo/halo.hpp"
#include "solver/strips/strips_in_cells.hpp"

namespace talus {

/// Barycentric coordinates in cell c of particles i to i + 3, one vertex per pack, for particles that may just have left it: none negative,
/// sum one.  In 2-D the last pack is zero.
template <int D>
[[gnu::always_inline]] inline std::array<Pack, pack_size> barycentric_inside(const Mesh<D>& mesh, Index c, const StripColumn<Vec<D>>& x,
                                                                             std::size_t i) noexcept
{
  const auto& gradients = mesh.gradients(c);
  const Vec<D>& first = mesh.node(mesh.cell(c)[0]);
  std::array<Pack, pack_size> shape{};
  Pack sum{};
  for (std::size_t a = 0; a <= D; ++a) {
    shape[a] += a == 0 ? 1.0 : 0.0;
    for (int d = 0; d < D; ++d)
      shape[a] += gradients[a][d] * (load_loose(x.component(d) + i) - first[d]);
    shape[a] = shape[a] > 0 ? shape[a] : Pack{};
    sum += shape[a];
  }
  const Pack scale = 1 / sum;
  for (Pack& share : shape)
    share *= scale;
  return shape;
}
/// Calls f(p, coordinates) for the particles of a cell, one after the other; lanes are vertices.
template <int D, class F>
void for_each_shape(const Mesh<D>& mesh, Index c, const ParticlesInCell<D>& run, F&& f) noexcept
{
  for (std::size_t i = run.begin; i < run.end; i += pack_size) {
    auto shape = barycentric_inside(mesh, c, run.columns.places(), i);
    transpose(shape[0], shape[1], shape[2], shape[3]);
    for (std::size_t lane = 0; lane < pack_size && i + lane < run.end; ++lane)
      f(i + lane, std::as_const(shape[lane]));
  }
}
/// The same for functions on a cell that are linear, with these values at its vertices: f(p, value).
template <int D, class F>
void for_each_linear_value(const Mesh<D>& mesh, Index c, const std::array<Real, D + 1>& values, const ParticlesInCell<D>& run,
                           F&& f) noexcept
{
  for (std::size_t i = run.begin; i < run.end; i += pack_size) {
    const auto shape = barycentric_inside(mesh, c, run.columns.places(), i);
    Pack value{};
    for (std::size_t a = 0; a <= D; ++a)
      value += shape[a] * values[a];
    for (std::size_t lane = 0; lane < pack_size && i + lane < run.end; ++lane)
      f(i + lane, value[lane]);
  }
}

/// Sums at the vertices of a cell, one per lane.
template <int K>
using CornerPacks = std::array<Pack, K>;

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

  /// Clears the rows of a block, then add(cell, its particles, CornerPacks<K>) for every cell that holds particles of the groups, which are
  /// treated as one: `add` is called for each body that has particles in the cell, one after the other, and the corners keep what was added
  /// before.  So the sums are bitwise those of one body whose particles have the same order in each cell.
  template <class Add>
  void sum_block(const ParticleStrips<D>& strips, std::span<const Index> groups, Index block, Add&& add)
  {
    const auto rows = blocks_.rows(block);
    if (blocks_.occupied[static_cast<std::size_t>(block)] != 0)  // those of other blocks are clear
      std::fill(rows.begin(), rows.end(), Row{});
    bool occupied = false;
    for_each_cell_of(strips, groups, block, [&](Index c, auto&& runs) {
      CornerPacks<K> corners{};
      runs([&](const ParticlesInCell<D>& run) { add(c, run, corners); });
      for (std::size_t a = 0; a <= D; ++a)
        for (std::size_t k = 0; k < K; ++k)
          rows[blocks_.slots(c)[a]][k] += corners[k][static_cast<int>(a)];
      occupied = true;
    });
    blocks_.occupied[static_cast<std::size_t>(block)] = occupied ? 1 : 0;
  }
  /// Adds the rows of all blocks and ranks.  Collective.
  void assemble()
  {
    halo_.template send_rows<Whole>(blocks_);
    add_rows();
  }
  /// All of it.
  template <class Add>
  void gather(const ParticleStrips<D>& strips, std::span<const Index> groups, Add&& add)
  {
    for_each_own_block(
        halo_, [&](Index block) { sum_block(strips, groups, block, add); }, [&] { halo_.template send_rows<Whole>(blocks_); });
    add_rows();
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

  void add_rows()
  {
    talus::assemble<Whole>(blocks_, own_, halo_, copies_, in_use_, of_node_, [&] { in_use_.find(blocks_.occupied, false); });
  }

  BlockRows<D, Row> blocks_;
  OwnNodes own_;
  NodesInUse in_use_;
  Halo<Row> halo_;
  HaloExchange copies_;
  SparseRows<Row> of_node_;
};

/// The gradient in a cell of a mean whose weight and weighted sum are the first two sums at nodes.  None where a corner has no weight: particles on
/// a facet leave the corner opposite it empty.
template <int D, int K>
std::optional<Vec<D>> gradient_of_mean(const Mesh<D>& mesh, Index c, const NodePatchSums<D, K>& sums) noexcept
{
  Vec<D> gradient = Vec<D>::Zero();
  for (std::size_t a = 0; a <= D; ++a) {
    const auto& row = sums[mesh.cell(c)[a]];
    if (!(row[0] > 0))
      return std::nullopt;
    gradient += row[1] / row[0] * mesh.gradients(c)[a];
  }
  return gradient;
}

}  // namespace talus
